"""View out and exposure to sunlight by EN 17037 of a room, or of all rooms: ``photile outlook``."""

from __future__ import annotations

import argparse
import importlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

from .command_line import Parser, of_form, three
from .converters import write_files
from .errors import UsageError

__all__ = ["main"]


def _parser() -> Parser:
    parser = Parser("photile outlook", "SCENE [OPTIONS]",
                    "Rate the view out and the hours of sun by EN 17037, with what stands outside in the scene")
    parser.add_argument("scene", metavar="SCENE", help="scene file: .gltf, .glb or .obj")
    add = parser.add_argument_group("Output").add_argument
    add("-o", "--output", type=Path, metavar="FILE.json", help="results to write; --include shows them in a report")
    add = parser.add_argument_group("Places").add_argument
    add("--plane", default="floor+1.2", metavar="HEIGHT", help="eyes; default: floor+1.2, of people who sit")
    add("--inside", type=of_form("X,Y,Z, three numbers", three), metavar="X,Y,Z",
        help="point in the room; default: the first camera's room")
    add("--rooms", default="", metavar="GLOB", help="rooms by name, as photile info lists them; * = all")
    add("--windows", action="append", default=[], metavar="GLOB",
        help="material of the panes; repeatable; default: all glass")
    add = parser.add_argument_group("Sun").add_argument
    add("--date", metavar="YYYY-MM-DD", help="day of the sun, from 1 February to 21 March")
    add("--site", type=of_form("LAT,LON,TZ, three numbers", three), metavar="LAT,LON,TZ",
        help="degrees north and east, hours ahead of UTC")
    add("--weather", type=Path, metavar="FILE", help="weather file (.epw) whose site is taken")
    add("--north", type=float, default=0.0, metavar="DEGREES", help="north clockwise from -z; default: 0")
    add("--lowest-sun", type=float, default=11.0, metavar="DEGREES",
        help="height from which on the sun counts; default: 11, of Germany")
    return parser


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.output and options.output.suffix.lower() != ".json":
        parser.error(f"-o {options.output}: name a .json file")
    if options.rooms and options.inside:
        parser.error("give either --rooms or --inside")
    if bool(options.date) != bool(options.site or options.weather):
        parser.error("the hours of sun need --date, and --site or --weather")
    return options


def _metres(value: Optional[float]) -> str:
    return "no end" if value is None else f"{value:.0f} m"


def _lines(result: dict[str, Any]) -> list[str]:
    lines = [f"{view['grid']}: view out {view['level']}: {view['angle']:.0f} degrees, {_metres(view['distance'])} "
             f"(medians of {view['points']} points)" for view in result["view_out"]]
    if sun := result.get("sunlight"):
        level = f": {sun['level']}" if sun["level"] else ""
        most = max((place["hours"] for place in sun["places"]), default=0.0)
        lines.append(f"sun on {sun['date']}{level}: {most:.1f} h at the best of {len(sun['places'])} windows")
    return lines


def main(arguments: Sequence[str]) -> None:
    """The command."""
    options = _options(arguments)
    importlib.import_module("photile._photile")  # whose absence is told by what to install
    from .grids import grids
    from .outlooks import sun_hours, view_out
    from .scenes import load

    scene = load(options.scene, north=options.north, sky=("uniform", 1))  # rooms need not have lights
    eyes = grids(scene, options.plane, inside=options.inside, rooms=options.rooms)
    result: dict[str, Any] = {"view_out": []}
    for grid in eyes:
        result["view_out"] += view_out(scene, grid, windows=options.windows)._content["view_out"]
    if options.date:
        result |= sun_hours(scene, options.date, site=options.site, weather=options.weather,
                            lowest_sun=options.lowest_sun, windows=options.windows)._content
    if options.output:
        if options.output.resolve() in (Path(one).resolve() for one in (options.scene, options.weather) if one):
            raise UsageError(f"{options.output}: this file is read; name another one to write")
        write_files({options.output: (json.dumps(result, ensure_ascii=False, indent=1) + "\n").encode()})
    print("\n".join(_lines(result)))

