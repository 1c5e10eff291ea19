"""Models of other programs as scenes that photile reads, and luminaires of their makers: ``photile import``."""

from __future__ import annotations

import argparse
import importlib
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from .command_line import Parser, exit_code
from .converters import Conversion
from .errors import UsageError

__all__ = ["main"]

_readers = {".ifc": "ifc", ".ifcxml": "ifc", ".ifczip": "ifc", ".hbjson": "honeybee", ".json": "honeybee",
            ".gldf": "gldf"}
_of_ifc = ("rooms", "ies", "target", "observers")


def _profile(text: str) -> tuple[str, Path]:
    pattern, _, file = text.partition("=")
    if not pattern or not file:
        raise argparse.ArgumentTypeError(f"'{text}': use TYPE=FILE, fixtures and an .ies or .ldt file")
    return pattern, Path(file)


def _target(text: str) -> tuple[str, str]:
    pattern, _, target = text.partition("=")
    if not pattern or not target:
        raise argparse.ArgumentTypeError(f"'{text}': use GLOB=TARGET, rooms and what photile measure --target takes")
    return pattern, target


def _parser() -> Parser:
    parser = Parser("photile import", "INPUT... -o FILE.glb [OPTIONS]",
                    "Import a building of IFC or a model of Honeybee as a scene, and print the command that measures "
                    "it; or import luminaires of GLDF")
    parser.add_argument("input", type=Path, nargs="+", metavar="INPUT",
                        help=".ifc: several may share their coordinates, such as those of architecture and "
                             "electrical engineering; .hbjson, .json: Honeybee; .gldf")
    options = parser.add_argument_group("Output")
    options.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.glb",
                         help="scene to write; files of rooms and luminaires lie beside it; of .gldf a new folder")
    options = parser.add_argument_group("Buildings")
    options.add_argument("--rooms", action="append", default=[], metavar="GLOB",
                         help="rooms of IFC by number or name; repeatable; default: all but those without a ceiling "
                              "and those below 1.2 m")
    options.add_argument("--ies", action="append", default=[], type=_profile, metavar="TYPE=FILE",
                         help="photometric file (.ies, .ldt) of the fixtures of IFC whose type fits a pattern; "
                              "repeatable")
    options.add_argument("--target", action="append", default=[], type=_target, metavar="GLOB=TARGET",
                         help="target of rooms of IFC by number or name, such as Office*=office-desk; repeatable, the "
                              "last that fits counts")
    options.add_argument("--observers", action="store_true",
                         help="write four observers of each room of IFC, too, whose glare the printed command rates")
    return parser


def _convert(options: argparse.Namespace, reader: str) -> Conversion:
    module = importlib.import_module(f".from_{reader}", __package__)
    if reader == "ifc":
        done = module.convert(options.input, options.output, options.rooms, options.ies, options.observers,
                              options.target)
    else:
        done = module.convert(options.input[0], options.output)
    assert isinstance(done, Conversion)
    return done


def main(arguments: Sequence[str]) -> int:
    """Errors: UsageError, InputError, OutputError, ImportError."""
    options = _parser().parse_args(arguments)
    readers = {_readers.get(file.suffix.lower(), "") for file in options.input}
    if "" in readers:
        file = next(file for file in options.input if file.suffix.lower() not in _readers)
        raise UsageError(f"{file}: unknown format '{file.suffix}'; give .ifc, .hbjson, .json or .gldf; other commands "
                         "read .gltf, .glb and .obj")
    if len(options.input) > 1 and readers != {"ifc"}:
        raise UsageError(f"{options.input[1]}: only files of IFC are imported together; give one file")
    given = [name for name in _of_ifc if getattr(options, name)]
    if given and readers != {"ifc"}:
        raise UsageError(f"--{given[0]} is for files of IFC; leave it out for {options.input[0]}")

    def work() -> None:
        done = _convert(options, *readers)
        for line in [*(f"warning: {line}" for line in dict.fromkeys(done.warnings)), *done.summary]:
            print(line, file=sys.stderr)
        print("\n".join(map(shlex.join, done.commands)))

    if readers == {"ifc"}:
        code: int = importlib.import_module("photile.ifc_building").in_ifc_child(options.input,
                                                                                 lambda: exit_code(work))
        return code
    work()
    return 0
