"""What the commands that are programs of Python share: options as the command photile has them, and errors of
one line with its exit codes."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterable
from typing import Any, NoReturn, Optional

from .errors import InputError, UsageError
from .report.command import Failure

__all__ = ["Parser", "exit_code", "of_form", "one_line", "three"]

_column = 30  # of the help, where what an option does begins
_of_debian = {"numpy": "python3-numpy", "photile": "python3-photile", "shapely": "python3-shapely"}
_of_pypi = {"honeybee": "honeybee-radiance", "honeybee_radiance": "honeybee-radiance",
            "photile": ". in the folder of photile's source"}


def one_line(text: Any) -> str:
    """A text of a stranger's file without line breaks and control characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in str(text)).split())


class _Help(argparse.HelpFormatter):
    """As the command prints its own: names and value of an option, and what it does on one line."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=_column, width=10_000)
        self._action_max_length = _column  # also where no option is as long

    def add_usage(self, usage: Optional[str], actions: Iterable[argparse.Action], groups: Any,
                  prefix: Optional[str] = None) -> None:
        super().add_usage(usage, actions, groups, prefix or "Usage: ")

    def _format_action_invocation(self, action: argparse.Action) -> str:
        if not action.option_strings:
            return super()._format_action_invocation(action)
        parts = [",".join(action.option_strings)]
        if action.metavar:
            parts.append(str(action.metavar))
        if isinstance(action.default, list):
            parts.append("...")
        return " ".join([*parts, *(["REQUIRED"] if action.required else [])])


class Parser(argparse.ArgumentParser):
    """Refuses options in one line.

    command   "photile import"
    usage     what follows it
    """

    def __init__(self, command: str, usage: str, description: str, epilog: str = "") -> None:
        super().__init__(prog=command, usage=f"{command} {usage}", description=description, epilog=epilog,
                         formatter_class=_Help, allow_abbrev=False, add_help=False)
        self._positionals.title = "Positionals"
        self._optionals.title = "Options"
        self.add_argument("-h", "--help", action="help", help="Print this help message and exit")

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; see {self.prog} --help")


def of_form(form: str, read: Callable[[str], Any]) -> Callable[[str], Any]:
    """A type for argparse, whose errors name the form of the value."""
    def value(text: str) -> Any:
        try:
            return read(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is not {form}") from None
    return value


def three(text: str) -> list[float]:
    """Numbers with commas between: a point, or a site."""
    a, b, c = map(float, text.split(","))
    if not all(map(math.isfinite, (a, b, c))):
        raise ValueError
    return [a, b, c]


def _missing(module: str) -> str:
    if module in _of_debian and sys.prefix == "/usr":
        return f"apt-get install {_of_debian[module]}"
    pip = f"pip install {_of_pypi.get(module, module)}"
    return pip if sys.prefix != sys.base_prefix else f"activate a virtual environment (python3 -m venv) and {pip}"


def exit_code(work: Callable[[], Optional[int]]) -> int:
    """Do the work of a command, which returns an exit code or None. Returns photile's exit code, and prints an
    error as one line."""
    try:
        return work() or 0
    except Failure as error:
        found, code = str(error), error.code
    except UsageError as error:
        found, code = str(error), 2
    except InputError as error:
        found, code = str(error), 3
    except MemoryError:
        found, code = "not enough memory; give a part of the file", 1
    except ModuleNotFoundError as error:
        found, code = f"{error} in {sys.executable}; {_missing(str(error.name).partition('.')[0])}", 1
    except OSError as error:
        found, code = f"{error.filename}: {error.strerror}" if error.filename else str(error), 1
    except ImportError as error:
        found, code = f"{error}; install it again", 1
    except KeyboardInterrupt:
        found, code = "interrupted", 130
    print(f"photile: error: {one_line(found)}", file=sys.stderr)
    return code
