"""Layouts of luminaires that meet a target: ``photile layout``.

The number of luminaires is estimated by the lumen method (CIE 52:1982), n = E A / (Phi U MF), with
the utilance U of the coarsest field as ``photile measure`` finds it. Fields near that number are
measured until the smallest that meets the target is found.
"""

from __future__ import annotations

import argparse
import bisect
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .arrangements import Arrangement, Designer, Room, most_luminaires
from .command_line import Parser, of_form, three
from .report import command as report
from .report.tables import targets_of

__all__ = ["main"]

_below_ceiling = 0.005  # metres, as of "position": "ceiling"
_spacing_criterion = 1.5  # greatest spacing over the height above the plane
_most_measurements = 10
_survey_cells = 80  # along the longer side of a floor that is no rectangle, and of furniture
_free_below = 0.3  # metres that luminaires are free of furniture below
_off = 0.02  # metres below luminaires that touch the ceiling, where points do not


def _verdict(met: bool) -> str:
    return "met" if met else "NOT MET"


class _Measured:
    """An arrangement and the results of ``photile measure`` as JSON."""

    def __init__(self, arrangement: Arrangement, record: dict[str, Any]) -> None:
        self.arrangement, self.record = arrangement, record
        self._grid = next(grid for grid in record["grids"] if grid["name"] == "working plane")
        self._judgements = [one for target in targets_of(record) for one in target["judgements"]]

    @property
    def met(self) -> bool:
        return all(one["met"] for one in self._judgements)

    @property
    def shortfall(self) -> float:
        """The greatest of required over measured value, by which the lumen method multiplies the
        number of luminaires: illuminance is in proportion to it."""
        ratios = (one["required"] / max(one["value"], 1e-9) for one in self._judgements)
        return max(ratios, default=0.0)

    @property
    def mean(self) -> float:
        """Lux, with the maintenance factor."""
        return float(self._grid["statistics"]["Em"]["value"])

    @property
    def utilance(self) -> float:
        """The flux onto the part of the plane that is measured over that of the luminaires."""
        plane = self._grid["plane"]
        cells = len(plane["cells"]) / (plane["columns"] * plane["rows"])
        area = cells * np.linalg.norm(plane["u"]) * np.linalg.norm(plane["v"])
        flux = sum(lamp["lumens"] for lamp in self.record["photometry"])
        return float(self.mean / self.record["maintenance_factor"] * area / flux)

    def line(self) -> str:
        mean, uniformity = (self._grid["statistics"][name] for name in ("Em", "Uo"))
        verdict = f": {_verdict(self.met)}" if self._judgements else ""
        return (f"{self.arrangement.text}: "
                f"Em {mean['value']:.4g} +-{mean['standard_error']:.2g} lx, "
                f"Uo {uniformity['value']:.3f} +-{uniformity['standard_error']:.2g}{verdict}")

    def summary(self) -> list[str]:
        """Lines about the power, where the photometric file states watts, and the target."""
        lines = []
        watts = sum(lamp["watts"] for lamp in self.record["photometry"])
        density = watts / self.record["room"]["area"]
        if watts > 0:
            lines.append(f"power: {watts:.4g} W, {density:.3g} W/m2, "
                         f"{100 * density / self.mean:.3g} W/m2 per 100 lx")
        for target in targets_of(self.record):
            reference = f" ({target['reference']})" if target["reference"] else ""
            lines.append(f"target {target['name']}{reference}: {_verdict(self.met)}")
            lines += [f"  {one['grid']}: {one['figure']} {one['value']:.4g}, at least "
                      f"{one['required']:g}: {_verdict(one['met'])}"
                      f"{', within two standard errors' if one['doubtful'] else ''}"
                      for one in self._judgements if one["doubtful"] or not one["met"]]
            if target["ugr_limit"] > 0:
                lines.append(f"  UGR at most {target['ugr_limit']:g}: see photile glare")
        return lines


def _photile(*arguments: str) -> str:
    """Standard output of the command. Errors: Failure with the line that it prints."""
    program = os.environ.get("PHOTILE_COMMAND", "photile")  # the command that started this names itself
    try:
        run = subprocess.run([program, *arguments], stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, encoding="utf-8", errors="replace")
    except FileNotFoundError:
        raise report.Failure(report.OUTPUT,
                             "the command photile is missing; add its folder to PATH") from None
    if run.returncode:
        mark = "photile: error: "
        lines = run.stderr.splitlines() or [f"photile ended with code {run.returncode}"]
        told = next((line for line in lines if line.startswith(mark)), lines[-1])
        code = run.returncode if run.returncode > 0 else report.OUTPUT
        raise report.Failure(code, told.replace(mark, "", 1))
    return run.stdout


def _list_of(arrangement: Arrangement) -> str:
    """The list that ``--luminaires`` takes, an entry a line."""
    return "[" + ",\n ".join(map(json.dumps, arrangement.entries)) + "]\n"


class _Command:
    """``photile measure`` in a scene whose own lights are off.

    Parameters
    ----------
    options : argparse.Namespace
    results : path
        File for results.
    trial : path
        File for luminaires to measure, in the folder of the list.
    """

    def __init__(self, options: argparse.Namespace, results: Path, trial: Path) -> None:
        self._options, self.results, self._trial = options, results, trial
        self._settings: list[str] = []
        for option, value in zip(options.measure, [*options.measure[1:], ""]):
            if option == "--set":
                self._settings += [option, value]
            elif option.startswith("--set="):
                self._settings.append(option)
        info = json.loads(_photile("info", "--json", options.scene, *self._settings))
        self.lights = {light["name"] for light in info["lights"] + info["groups"]}
        layers = {light.get("group") or light["name"] for light in info["lights"]}
        self._off = [word for name in sorted(layers) for word in ("--light", f"{name}=off")]

    def _record(self, *arguments: str, **others: str) -> dict[str, Any]:
        values = {name: getattr(self._options, name)
                  for name in ("plane", "inside", "target", "maintenance")} | others
        given = [f"--{name}={value}" for name, value in values.items() if value is not None]
        _photile("measure", self._options.scene, "-q", "-o", str(self.results), *given,
                 *arguments)
        record: dict[str, Any] = json.loads(self.results.read_text(encoding="utf-8"))
        return record

    def _survey(self, *arguments: str, **others: str) -> dict[str, Any]:
        """Of the floor; the light, that of a sky, does not matter."""
        return self._record("--wall-band", "0", "--sky", "uniform=1000", "--rays", "1", "--repeats",
                            "2", "--photons", "1000", *self._settings, *arguments, **others)

    def survey(self) -> Room:
        """The room. Errors: Failure where there is none."""
        metre = ["--cylindrical-at", "floor+1"]
        record = self._survey(*metre)
        if "room" not in record:
            raise report.Failure(report.INPUT, f"{self._options.scene}: no room with a ceiling is at "
                                               "the camera; give a point in a room by --inside")
        room = Room.of(record)
        if room.floor.all() and not room.wall_angle():
            return room
        return Room.of(self._survey(*metre, "--spacing", f"{room.spacing(_survey_cells):.4g}"))

    def with_obstacles(self, room: Room, height: float) -> Room:
        """With what is in the way of luminaires at a height above the plane, and just below them."""
        above_floor = height - room.floor_height
        low, high = (f"floor+{max(above_floor - below, 0.1):.4g}" for below in (_free_below, _off))
        return room.with_obstacles(self._survey("--cylindrical-at", low, "--spacing",
                                                f"{room.spacing(_survey_cells):.4g}", plane=high))

    def measure(self, arrangement: Arrangement) -> _Measured:
        self._trial.write_text(_list_of(arrangement), encoding="utf-8")
        try:
            record = self._record("--luminaires", str(self._trial), *self._off,
                                  *self._options.measure)
        except report.Failure as failure:
            told = str(failure).replace(str(self._trial), str(self._options.output))
            raise report.Failure(failure.code, told) from None
        measured = _Measured(arrangement, record)
        if not measured.mean > 0:
            raise report.Failure(report.INPUT, f"{self._options.luminaire}: no light of the "
                                               "luminaires reaches the working plane")
        print(measured.line(), flush=True)
        return measured


def _search(fields: Sequence[tuple[int, int, int]],
            measure: Callable[[int, int], _Measured]) -> _Measured:
    """The smallest field that meets the target, or the one that comes nearest to it.

    Measured next is the field with as many luminaires as the lumen method makes of the last
    measurement, between the greatest field that failed and the smallest that met the target. Fields
    larger than one that meets the target are taken to meet it, too.
    """
    counts = [count for count, _, _ in fields]
    measured: dict[int, _Measured] = {}
    failed, met, index = -1, len(fields), 0
    while met - failed > 1 and len(measured) < _most_measurements:
        trial = measured[index] = measure(*fields[index][1:])
        needed = trial.arrangement.count * trial.shortfall
        if trial.met:
            met = index
        else:
            failed = index
            if len(measured) == 1:
                print(f"lumen method: utilance {trial.utilance:.3g}, {needed:.1f} luminaires",
                      flush=True)
        index = min(max(bisect.bisect_left(counts, needed), failed + 1), met - 1)
    if met in measured:
        return measured[met]
    best = min(measured.values(), key=lambda trial: trial.shortfall)
    print(f"none of {len(measured)} fields meets the target; the best is {best.line()}")
    return best


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < math.inf:
        raise ValueError
    return value


def _count(text: str) -> int:
    value = int(text)
    if not 1 <= value <= most_luminaires:
        raise ValueError
    return value


def _columns_and_rows(text: str) -> tuple[int, int]:
    columns, rows = map(_count, text.split("x"))
    _count(str(columns * rows))
    return columns, rows


def _count_and_radius(text: str) -> tuple[int, float]:
    count, radius = text.split(",")
    return _count(count), _positive(radius)


def _length_and_width(text: str) -> list[float]:
    length, width = map(_positive, text.split("x"))
    return [length, width]


def _parser() -> Parser:
    positive = of_form("a number above 0", _positive)
    parser = Parser(
        "photile layout", "SCENE --luminaire FILE --target NAME -o FILE.json [OPTIONS] [-- OPTIONS]",
        "Place luminaires in a room: the smallest field that meets a target, or a given arrangement. "
        "The scene's own lights are off.",
        "Options of photile measure follow after --, such as -- --reflectance wall=0.7. "
        "A point with a negative x is written --inside=-1,1.6,4.")
    parser.add_argument("scene", metavar="SCENE", help="scene file: .gltf, .glb or .obj")
    add = parser.add_argument_group("Layout").add_argument
    add("--luminaire", type=Path, required=True, metavar="FILE",
        help="photometric file (.ies, .ldt), in the folder of -o or below")
    add("-o", "--output", type=Path, required=True, metavar="FILE.json",
        help="list to write, which --luminaires of photile takes")
    add("--plan", metavar="FILE", help="plan (.svg) or report (.html, .pdf) to write")
    add("--target", metavar="NAME|VALUES",
        help="as of photile measure: office-desk, or Em=500,Uo=0.6")
    add("--maintenance", metavar="X|PARTS", help="maintenance factor; default: 1")
    add("--plane", default="floor+0.75", metavar="HEIGHT",
        help="working plane; default: floor+0.75")
    add("--inside", metavar="X,Y,Z", help="point in the room; default: the first camera's room")
    group = parser.add_argument_group("Arrangement")
    add = group.add_mutually_exclusive_group().add_argument
    most = f"at most {most_luminaires} luminaires"
    add("--field", type=of_form(f"NxM of {most}", _columns_and_rows), metavar="NxM",
        help="N along the longest wall and M across; default: the smallest that meets the target")
    add("--line", type=of_form(f"a number of {most}", _count), metavar="N",
        help="N along the longest wall, in the middle of the room")
    add("--circle", type=of_form(f"N,RADIUS of {most}", _count_and_radius), metavar="N,RADIUS",
        help="around the middle of the room, radius in m")
    group.add_argument(
        "--max-spacing", type=positive, metavar="M",
        help="greatest spacing of a field that is searched for, m; default: "
             f"{_spacing_criterion:g} times the height above the plane, a usual spacing criterion "
             "(as ANSI/IES LS-1 defines it); the data sheet may have the luminaire's own")
    group.add_argument("--aim", type=of_form("X,Y,Z, three numbers", three), metavar="X,Y,Z",
                       help="point at which all luminaires aim; default: down")
    group.add_argument("--across", action="store_true",
                       help="C0 across the longest wall, or the radius, in place of along it")
    add = parser.add_argument_group("Height").add_mutually_exclusive_group().add_argument
    add("--mounting-height", type=positive, metavar="M", help="above the floor, m; default: at the ceiling")
    add("--suspension", type=positive, metavar="M", help="below the ceiling, m")
    add = parser.add_argument_group("Luminaire").add_argument
    add("--lumens", type=positive, metavar="LM", help="flux of each; default: as in its file")
    add("--size", type=of_form("LxW, two numbers above 0", _length_and_width), metavar="LxW",
        help="luminous opening along C0 and across, m; default: as in its file")
    add("--name", metavar="NAME", help="name of the light; default: that of its file")
    return parser


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    own, measure = list(arguments), []
    if "--" in own:
        own, measure = own[:own.index("--")], own[own.index("--") + 1:]
    parser = _parser()
    options = parser.parse_args(own)
    options.measure = measure
    if not (options.target or options.field or options.line or options.circle):
        parser.error("give --target, or an arrangement by --field, --line or --circle")
    if options.output.suffix.lower() != ".json":
        parser.error(f"-o {options.output}: name a .json file")
    if any(word.startswith(("-o", "--output")) for word in measure):
        parser.error("-o after -- would write each trial; give --plan, or measure the new list")
    return options


def _luminaire(options: argparse.Namespace) -> dict[str, Any]:
    """The members that all entries of the list have. Errors: Failure where the photometric file is
    not in the folder of the list or below."""
    folder = options.output.resolve().parent
    try:
        file = options.luminaire.resolve(strict=True).relative_to(folder)
    except OSError as error:
        raise report.Failure(report.INPUT, f"{options.luminaire}: {error.strerror}") from None
    except ValueError:
        raise report.Failure(report.USAGE,
                             f"{options.luminaire}: a list reads photometric files in its own "
                             f"folder or below; copy it into {folder}") from None
    members = {"name": options.name or file.stem, "file": str(file), "lumens": options.lumens,
               "size": options.size}
    return {key: value for key, value in members.items() if value}


def _height(options: argparse.Namespace, room: Room) -> float:
    """Of the luminaires above the working plane, metres."""
    highest = height = room.ceiling_height - _below_ceiling
    if options.suspension:
        height = room.ceiling_height - options.suspension
    if options.mounting_height:
        height = room.floor_height + options.mounting_height
    if not 0 < height < room.ceiling_height + 1e-3:
        raise report.Failure(report.USAGE,
                             f"luminaires would be {height:.2f} m above the plane, the ceiling is "
                             f"{room.ceiling_height:.2f} m above it; give another height")
    return min(height, highest)


def _lay_out(options: argparse.Namespace, luminaire: dict[str, Any],
             command: _Command) -> _Measured:
    """The arrangement, measured. Errors: Failure, UsageError."""
    room = command.survey()
    # What drawing needs is found to be missing before anything is measured.
    check = [str(command.results), "--check", "-o", options.plan]
    if options.plan and (code := report.main(check)):
        raise SystemExit(code)
    while luminaire["name"] in command.lights:
        luminaire["name"] += "_new"
    height = _height(options, room)
    room = command.with_obstacles(room, height)
    designer = Designer(room, height, luminaire, options.across, options.aim)
    length, width = designer.size
    index = length * width / (height * (length + width))  # CIE 52:1982
    print(f"room: {room.area:.1f} m2, {length:.2f} x {width:.2f} m; luminaires {height:.2f} m "
          f"above the plane; room index {index:.3g}", flush=True)
    if options.circle:
        return command.measure(designer.circle(*options.circle))
    if options.field or options.line:
        return command.measure(designer.field(*(options.field or (options.line, 1))))
    return _search(designer.fields(options.max_spacing or _spacing_criterion * height),
                   lambda columns, rows: command.measure(designer.field(columns, rows)))


def _run(options: argparse.Namespace) -> int:
    luminaire = _luminaire(options)
    with tempfile.TemporaryDirectory() as folder, tempfile.NamedTemporaryFile(
            dir=options.output.parent, prefix=".layout-", suffix=".json") as trial:
        results = Path(folder, "results.json")
        found = _lay_out(options, luminaire, _Command(options, results, Path(trial.name)))
        for line in found.record.get("warnings", ()):
            print(f"warning: {line}", file=sys.stderr)
        for line in found.summary():
            print(line)
        report.write(options.output, _list_of(found.arrangement).encode())
        print(f"--luminaires {options.output}")
        if not options.plan:
            return 0
        results.write_text(json.dumps(found.record), encoding="utf-8")
        return report.main([str(results), "-o", options.plan])


def main(arguments: Sequence[str]) -> int:
    """Errors: Failure, UsageError, OSError."""
    return _run(_options(arguments))
