"""Reports of what was measured, rated and assessed."""

from __future__ import annotations

import base64
import json
import os
import pathlib
import tempfile
from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np

from . import _photile
from .errors import InputError, OutputError, UsageError
from .glare_ratings import Glare
from .grids import rooms
from .measuring import Illuminance
from .outlooks import SunHours, ViewOut
from .report import command
from .scenes import File
from .years import Daylight

__all__ = ["write_report"]

Results = Union[Illuminance, Glare, Daylight, SunHours, ViewOut]


def write_report(
    file: File,
    *results: Union[Results, Sequence[Results]],
    target: str = "",
    project: str = "",
    client: str = "",
    designer: str = "",
    logo: Optional[File] = None,
    language: str = "en",
    template: Optional[File] = None,
) -> None:
    """Write a report (.html, .pdf) or plans (.svg, .dxf), as `photile measure -o` does.

    It needs jinja2 and contourpy, for PDF weasyprint, for DXF ezdxf.

    Parameters
    ----------
    file : path
        Ends in .html, .pdf, .svg or .dxf.
    *results : Illuminance, Glare, Daylight, ViewOut, SunHours, or sequences of these
        Illuminances are those of one call of `measure`; daylight factors may stand beside them. A year, or
        glare, may stand alone.
    target : str
        Requirements of grids that have none, from their file or `measure`, by name, such as "office-desk", or
        values, such as "Em=500,Uo=0.6"; UGR is that of the nearest observers of the results. `measure` has to
        be given those of EN 1838.
    project, client, designer : str
        At the head of the report; with a client it ends with lines for signatures.
    logo : path, optional
        A PNG or a JPEG.
    language : str
        "en", "de", or one whose words the template has.
    template : path, optional
        A folder of templates that replace photile's.

    Raises
    ------
    InputError
        The logo is no picture, or the template has an error.
    OutputError
        The file cannot be written, or a package is missing.
    UsageError
        There is no such target or language, nothing that it is about, or the file has another ending.
    """
    listed: list[Results] = []
    for each in results:
        listed.extend(each if isinstance(each, Sequence) else [each])
    if not all(isinstance(each, (Illuminance, Glare, Daylight, SunHours, ViewOut)) for each in listed):
        raise UsageError("results: give what photile.measure, glare, daylight, sun_hours or view_out returned")
    record, beside = _record(listed, target)
    about = {"project": project, "client": client, "designer": designer, "language": language,
             "logo": "" if logo is None else _logo(os.fspath(logo)),
             "included": [*_rooms_of(listed), *_included(beside)]}
    record["report"] = {**record.get("report", {}), **about}
    with tempfile.TemporaryDirectory() as folder:
        content = pathlib.Path(folder, "results.json")
        content.write_text(json.dumps(record), encoding="utf-8")
        arguments = [] if template is None else ["--template", os.fspath(template)]
        try:
            command._run([*arguments, "-o", os.fspath(file), str(content)])
        except command.Failure as failure:
            kinds = {command.USAGE: UsageError, command.INPUT: InputError, command.OUTPUT: OutputError}
            raise kinds[failure.code](str(failure).replace("\n", " ")) from None


def _record(results: list[Results], target: str) -> tuple[dict[str, Any], list[Results]]:
    """What the report is of, and the results that it includes."""
    measured = [each for each in results if isinstance(each, Illuminance)]
    lux = [each for each in measured if each.unit == "lx"]
    main = lux or measured
    if not main:
        return _record_alone([each for each in results if isinstance(each, (Glare, Daylight))], target), results
    return _record_of(main, results, target), [each for each in results if not any(each is one for one in main)]


def _record_alone(results: list[Union[Glare, Daylight]], target: str) -> dict[str, Any]:
    """Of a year, or else of glare."""
    if not results or target:
        raise UsageError("results: a target needs what photile.measure returned" if results else
                         "results: there are none; give what photile.measure, glare or daylight returned")
    first = next((each for each in results if isinstance(each, Daylight)), results[0])
    subject = "A year of daylight" if isinstance(first, Daylight) else "Glare"
    return {**first._facts, "report": {"subject": subject, "colours": _photile.colours()}}


def _record_of(measured: list[Illuminance], results: list[Results], target: str) -> dict[str, Any]:
    run = measured[0]._run
    if any(each._run is not run for each in measured):
        raise UsageError("results: these illuminances are of several calls; measure a list of grids")
    scene = run.scene
    observers = [(name, tuple(map(float, position)), float(rating), float(error))
                 for each in results if isinstance(each, Glare)
                 for name, position, rating, error in zip(each.names, each.positions, each.ugr, each.ugr_error)
                 if np.isfinite(rating)]
    ground, sky = scene._sky
    stated = scene._north != 0 or ground is not None or any(each.grid.role == "wall" for each in measured)
    record = run.core.record({
        "target": target,
        "observers": observers,
        "ground": ground,
        "sky": list(sky),
        "north": scene._north if stated else None,
    })
    # Photometric files of a list have absolute names, which tell a reader nothing.
    for entry, name in [*((lamp, "file") for lamp in record["luminaires"]),
                        *((lamp, "name") for lamp in record["photometry"])]:
        if os.path.isabs(entry[name]):
            entry[name] = os.path.basename(entry[name])
    return record


def _rooms_of(results: list[Results]) -> list[dict[str, Any]]:
    """The rooms that grids are named after."""
    measured = [each for each in results if isinstance(each, Illuminance) and each.grid._of_room]
    names = {part for each in measured for part in (each.grid.name, each.grid.name.rsplit(": ", 1)[0])}
    found = rooms(measured[0]._run.scene) if measured else []
    own = [room for room in found if room["name"] in names]
    return [{"file": "rooms", "content": own}] if own else []


def _included(results: list[Results]) -> list[dict[str, Any]]:
    contents: list[Any] = [each._content for each in results if isinstance(each, (Glare, SunHours, ViewOut))]
    factors = [each for each in results if isinstance(each, Illuminance)]
    years = [each.figures for each in results if isinstance(each, Daylight)]
    contents += [_record_of(factors, [], "")] if factors else []
    contents += [years] if years else []
    return [{"file": "results", "content": content} for content in contents]


def _logo(file: str) -> str:
    try:
        picture = pathlib.Path(file).read_bytes()
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    kinds = {b"\x89PNG": "png", b"\xff\xd8": "jpeg"}
    kind = next((kind for head, kind in kinds.items() if picture.startswith(head)), None)
    if kind is None:
        raise InputError(f"{file}: a logo is a PNG or a JPEG; save it as one")
    return f"data:image/{kind};base64,{base64.b64encode(picture).decode()}"
