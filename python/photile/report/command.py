"""The command line: reads a record, makes the kinds of files that the names of the outputs ask for."""

from __future__ import annotations

import argparse
import importlib
import json
import os
import pathlib
import re
import stat
import sys
import tempfile
from collections.abc import Sequence
from typing import Any

# Exit codes are those of the command photile.
USAGE, INPUT, OUTPUT = 2, 3, 1
_packages = {"jinja2": "python3-jinja2", "numpy": "python3-numpy", "contourpy": "python3-contourpy",
             "weasyprint": "weasyprint", "ezdxf": "python3-ezdxf"}
_not_in_xml = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


class Failure(Exception):
    """A message for the user, and the exit code."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


def _require(what: str, remedy: str, *modules: str) -> None:
    missing = []
    for module in modules:
        try:
            importlib.import_module(module)
        except ImportError:
            missing.append(_packages[module])
    if missing:
        raise Failure(OUTPUT, f"{what} {' and '.join(missing)}, which this Python lacks: "
                              f"apt-get install {' '.join(missing)}{remedy}")


def _clean(value: Any) -> Any:
    """The value without characters that XML cannot hold."""
    if isinstance(value, str):
        return _not_in_xml.sub("?", value)
    if isinstance(value, list):
        return [_clean(one) for one in value]
    if isinstance(value, dict):
        return {_clean(key): _clean(one) for key, one in value.items()}
    return value


def _read(file: str) -> Any:
    try:
        with open(file, encoding="utf-8") as stream:
            return _clean(json.load(stream))
    except (OSError, ValueError, RecursionError) as error:
        raise Failure(INPUT, f"{file}: {getattr(error, 'strerror', None) or error}") from None


def _lux(option: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < 1e6:
        raise Failure(USAGE, f"{option} {text}: give lux above 0, such as 13900")
    return value


def permissions(file: pathlib.Path) -> int:
    """Of what takes a file's place: those of the file, or those of a new one."""
    try:
        return stat.S_IMODE(file.stat().st_mode)
    except OSError:
        mask = os.umask(0o077)
        os.umask(mask)
        return 0o666 & ~mask


def write(file: pathlib.Path, content: bytes, make_folder: bool = False) -> None:
    """Writes a file, which gets its name when it is complete."""
    try:
        if make_folder:
            file.parent.mkdir(parents=True, exist_ok=True)
        descriptor, temporary = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}.")
        try:
            with os.fdopen(descriptor, "wb") as stream:
                stream.write(content)
            os.chmod(temporary, permissions(file))
            os.replace(temporary, file)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise Failure(OUTPUT, f"{file}: cannot be written: {error.strerror}") from None


def _draw(record: dict[str, Any], outputs: Sequence[str], template: str | None) -> None:
    from . import pages
    report = pages.Report(record, template)
    page = ""
    for output in outputs:
        file, ending = pathlib.Path(output), pathlib.Path(output).suffix.lower()
        if ending in (".html", ".pdf"):
            page = page or report.page()
        if ending == ".html":
            write(file, page.encode())
        elif ending == ".pdf":
            write(file, pages.printed(page))
        else:
            plans = report.drawings() if ending == ".dxf" else [plan.encode() for plan in report.plans()]
            for number, plan in enumerate(plans, 1):
                name = file.name if len(plans) == 1 else f"{file.stem}-{number}{file.suffix}"
                write(file.with_name(name), plan)


def _make_honeybee(options: argparse.Namespace) -> None:
    _require("Honeybee's files need", "", "numpy")
    from . import honeybee
    if options.check:
        return
    record = pathlib.Path(options.record)
    for name, content in honeybee.files(_read(options.record), record.parent):
        write(pathlib.Path(options.honeybee, name), content, make_folder=True)


def _make_ugr_table(options: argparse.Namespace) -> None:
    _require("a UGR table needs", "", "numpy")
    from . import ugr
    texts = ugr.written(_read(options.record))
    for output in options.output:
        file = pathlib.Path(output)
        if file.suffix.lower() not in texts:
            raise Failure(USAGE, "-o: name a .csv, .json or .txt file")
        write(file, texts[file.suffix.lower()].encode())


def _run(arguments: Sequence[str] | None) -> None:
    parser = argparse.ArgumentParser(prog="photile.report", allow_abbrev=False, description=__doc__)
    parser.add_argument("record", metavar="RESULTS.json", help="results of photile measure -o")
    parser.add_argument("-o", "--output", action="append", default=[], metavar="FILE",
                        help="report (.html, .pdf) or plan (.svg, .dxf) to write; repeatable")
    parser.add_argument("--template", metavar="FOLDER", help="folder of templates that replace photile's")
    parser.add_argument("--language", help="language of the report: en, de, or NAME of FOLDER/words/NAME.json")
    parser.add_argument("--include", action="append", default=[], metavar="FILE.json",
                        help="other results to show: of photile glare, daylight, measure --daylight-factor, or "
                             "rooms.json of photile import; repeatable")
    parser.add_argument("--outdoor-lux", metavar="LUX",
                        help="median diffuse illuminance outdoors (EN 17037, table A.3), which gives daylight factors "
                             "their levels")
    parser.add_argument("--check", action="store_true",
                        help="check that all that the outputs need is installed; write nothing")
    parser.add_argument("--ugr-table", action="store_true",
                        help="write the UGR table of a luminaire (.csv, .json, .txt)")
    parser.add_argument("--honeybee", metavar="FOLDER", help="folder for the files that Honeybee reads")
    options = parser.parse_args(arguments)
    if options.honeybee:
        return _make_honeybee(options)
    if options.ugr_table:
        return _make_ugr_table(options)
    endings = {pathlib.Path(output).suffix.lower() for output in options.output}
    if not endings or not endings <= {".html", ".pdf", ".svg", ".dxf"}:
        raise Failure(USAGE, "-o: name an .html, .pdf, .svg or .dxf file")
    _require("reports need", "; or write .csv or .json", "jinja2", "numpy", "contourpy",
             *(["weasyprint"] if ".pdf" in endings else []), *(["ezdxf"] if ".dxf" in endings else []))
    from . import pages
    record = _read(options.record)
    if not isinstance(record, dict):
        record = {"report": {"included": [{"file": options.record, "content": record}]}}
    about = record.setdefault("report", {})
    if options.language:
        about["language"] = options.language
    if options.outdoor_lux:
        about["outdoor_lux"] = _lux("--outdoor-lux", options.outdoor_lux)
    if options.include:
        included = [{"file": file, "content": _read(file)} for file in options.include]
        about["included"] = [*about.get("included", []), *included]
    try:
        if options.check:
            pages.Report(record, options.template).check()
        else:
            _draw(record, options.output, options.template)
    except pages.UnknownLanguage as error:
        raise Failure(USAGE, str(error)) from None
    except pages.BadInput as error:
        raise Failure(INPUT, str(error)) from None
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise Failure(INPUT, f"{options.record}: these are not results of photile measure -o: "
                             f"{type(error).__name__} {error}") from error


def main(arguments: Sequence[str] | None = None) -> int:
    try:
        _run(arguments)
    except Failure as failure:
        print(f"photile.report: error: {failure}".replace("\n", " "), file=sys.stderr)
        return failure.code
    except KeyboardInterrupt:
        return 130
    return 0
