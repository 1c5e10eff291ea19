"""Buildings of IFC as scenes that photile reads: ``photile import``.

Needs ifcopenshell of PyPI, 0.8 or 0.9.
"""

from __future__ import annotations

import csv
import fnmatch
import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .command_line import one_line
from .converters import Conversion, in_scene, json_lines, luminaire_rotation, unique, write_files
from .errors import InputError, UsageError
from .ifc_building import Building, Fixture, Room, number_of, read, wall_bands, working_plane

__all__ = ["convert"]

_most_photometry = 64 << 20  # bytes of a photometric file, as in limits.hpp
_view = 60.0  # degrees from the top to the bottom of a room's picture
_most_lights = 8  # that tables of all rooms show apart; more are one group in the command


def _fits(text: str, pattern: str) -> bool:
    return text == pattern or fnmatch.fnmatchcase(text, pattern)


class _Photometry:
    """The photometric files of fixtures, by their names beside the scene."""

    def __init__(self, scene: Path, warnings: list[str]) -> None:
        self.contents: dict[Path, bytes] = {}  # to write
        self.without_opening: set[str] = set()  # files that state no luminous opening
        self._scene, self._warnings = scene, warnings
        self._names: dict[str, int] = {}
        self._found: dict[Any, str] = {}  # names by file, or by content

    def of_file(self, file: Path) -> str:
        """The name of a file; one of another folder is copied. Errors: InputError."""
        file = file.resolve()
        if file not in self._found:
            try:
                with open(file, "rb") as stream:
                    content = stream.read(_most_photometry + 1)
            except OSError as error:
                raise InputError(f"{file}: {error.strerror}; give an .ies or .ldt file") from None
            if file.suffix.lower() not in (".ies", ".ldt") or len(content) > _most_photometry:
                raise InputError(f"{file}: this is not a photometric file; give an .ies or .ldt file")
            copied = file.parent != self._scene.parent.resolve()
            self._found[file] = self._keep(file.name, content, copied)
        return self._found[file]

    def of_source(self, fixture: Fixture) -> str:
        """The file that a fixture's light source names or states, or "" with a warning."""
        data = fixture.source.LightDistributionDataSource
        try:
            if data.is_a("IfcExternalReference"):
                # A stranger's file may name files of its own folder alone.
                name = Path(str(data.Location or data.Name).replace("\\", "/")).name
                if Path(name).suffix.lower() not in (".ies", ".ldt"):
                    raise ValueError(f"{name} is not a photometric file")
                return self.of_file(fixture.folder / name)
            content = _lm63(fixture)
            if content not in self._found:
                name = re.sub(r"\W+", "_", fixture.kind) + ".ies"
                self._found[content] = self._keep(name, content, copied=True)
            return self._found[content]
        except (ValueError, TypeError, AttributeError) as error:
            self._warnings.append(f"fixture '{fixture.kind}': its light distribution is left out: "
                                  f"{one_line(error)}")
            return ""

    def _keep(self, file: str, content: bytes, copied: bool) -> str:
        path = Path(f"{self._scene.stem}.{file}" if copied else file)
        name = unique(path.stem, self._names) + path.suffix
        if copied:
            self.contents[self._scene.with_name(name)] = content
        # LM-63: lamps, lumens, multiplier, angles, planes, type, unit, width, length, height.
        numbers = content.partition(b"TILT=NONE")[2].split()[:10]
        if len(numbers) == 10 and all(number_of(number.decode("latin-1")) == 0 for number in numbers[7:9]):
            self.without_opening.add(name)
        return name


def _lm63(fixture: Fixture) -> bytes:
    """An IfcLightIntensityDistribution, in candela per lumen, as LM-63-2002.

    Errors: ValueError where it is not of type C, or not a distribution.
    """
    source = fixture.source
    if source.LightDistributionDataSource.LightDistributionCurve != "TYPE_C":
        raise ValueError("it is not of type C")
    planes = {plane.MainPlaneAngle * fixture.degrees: sorted(zip(plane.SecondaryPlaneAngle,
                                                                 plane.LuminousIntensity))
              for plane in source.LightDistributionDataSource.DistributionData}
    angles = np.unique([angle for plane in planes.values() for angle, _ in plane])
    rows = [np.interp(angles, *np.transpose(planes[main])) * source.LuminousFlux for main in sorted(planes)]
    if not (source.LuminousFlux > 0 and np.isfinite(rows).all() and np.min(rows) >= 0):
        raise ValueError("its flux or an intensity is not a number above 0")
    numbers = [[1, source.LuminousFlux, 1, len(angles), len(planes), 1, 2, 0, 0, 0],
               [1, 1, fixture.watts or 0], angles * fixture.degrees, sorted(planes), *rows]
    lines = [" ".join(f"{float(number):.7g}" for number in row) for row in numbers]
    heading = ["IESNA:LM-63-2002", f"[LUMINAIRE] {fixture.kind}", "TILT=NONE"]
    return "\n".join([*heading, *lines, ""]).encode("ascii", "replace")


def _add_photometry(building: Building, ies: list[tuple[str, Path]], photometry: _Photometry) -> None:
    """Errors: UsageError where no fixture is of a type of --ies, InputError."""
    kinds = sorted({fixture.kind for fixture in building.fixtures})
    for pattern, _ in ies:
        if not any(_fits(kind, pattern) for kind in kinds):
            there = ", ".join(kinds) or "none"
            raise UsageError(f"--ies {pattern}: no fixture is of this type; there are: {there}")
    for fixture in building.fixtures:
        given = [file for pattern, file in ies if _fits(fixture.kind, pattern)]
        if given:
            fixture.file = photometry.of_file(given[-1])
        elif fixture.source is not None:
            fixture.file = photometry.of_source(fixture)


def _luminaires(fixtures: list[Fixture], photometry: _Photometry) -> list[dict[str, Any]]:
    """The list of ``--luminaires``: fixtures with photometry."""
    names: dict[str, int] = {}
    entries = []
    for fixture in fixtures:
        if not fixture.file:
            continue
        number = fixture.room.number if fixture.room else ""
        words = re.sub(r"\W+", "_", f"{number} {fixture.tag} {fixture.kind}").strip("_")
        c0, _, aim = map(in_scene, fixture.axes.T)
        entry = {"name": unique(words, names), "file": fixture.file, "aim": aim,
                 "position": in_scene(fixture.position),
                 "rotation": round(luminaire_rotation(c0, aim, (0, 1, 0)), 4)}
        if fixture.file in photometry.without_opening:
            entry["size"] = fixture.size
        entries.append(entry)
    return entries


def _schedule(fixtures: list[Fixture]) -> bytes:
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["type", "tag", "room", "x", "y", "z", "lumens", "watts", "file"])
    for one in fixtures:
        known = ("" if value is None else f"{value:g}" for value in (one.lumens, one.watts))
        room = one.room.name if one.room else ""
        table.writerow([one.kind, one.tag, room, *in_scene(one.position), *known, one.file])
    return text.getvalue().encode()


def _is_named(room: Room, pattern: str) -> bool:
    return any(_fits(text, pattern) for text in (room.name, room.number, room.long_name))


def _check_patterns(option: str, patterns: list[str], rooms: list[Room]) -> None:
    """Errors: UsageError where no room fits a pattern."""
    for pattern in patterns:
        if not any(_is_named(room, pattern) for room in rooms):
            there = ", ".join(room.name for room in rooms) or "none"
            raise UsageError(f"{option} {pattern}: no room has this name; there are: {there}")


def _chosen(rooms: list[Room], patterns: list[str]) -> list[Room]:
    """Rooms of these numbers or names; without patterns those without doubts. Errors: UsageError."""
    _check_patterns("--rooms", patterns, rooms)
    if not patterns:
        return [room for room in rooms if not room.doubt]
    return [room for room in rooms if any(_is_named(room, pattern) for pattern in patterns)]


def _grid(room: Room, targets: Sequence[tuple[str, str]]) -> dict[str, Any]:
    """The room's working plane, with the last target whose pattern it fits."""
    own = [target for pattern, target in targets if _is_named(room, pattern)]
    return room.grid() | ({"target": own[-1]} if own else {})


def _summary(building: Building, chosen: list[Room], lit: int) -> list[str]:
    lines = [f"rooms: {len(chosen)} of {len(building.rooms)}"]
    doubtful = [f"{room.name} ({room.doubt})" for room in building.rooms if room.doubt and room not in chosen]
    if doubtful:
        lines.append(f"rooms that only --rooms chooses: {', '.join(doubtful)}")
    narrow = [room.name for room in chosen if room.wall_band < wall_bands[0]]
    if narrow:
        lines.append(f"rooms with a wall band below {wall_bands[0]} m: {', '.join(narrow)}")
    if building.site:
        latitude, longitude = building.site
        lines.append(f"site: {latitude:g} degrees north, {longitude:g} east; "
                     f"--site {latitude:g},{longitude:g},TZ with the hours ahead of UTC")
    kinds = {fixture.kind for fixture in building.fixtures}
    return [*lines, f"triangles: {building.triangles} of {building.elements} elements, in the colours of "
            "drawings; --reflectance MATERIAL=VALUE sets what you know",
            f"glass, and the transmittance of a pane: {', '.join(building.glass) or 'none'}; "
            "--set glass=MATERIAL=VALUE sets another",
            f"fixtures: {len(building.fixtures)} of {len(kinds)} types, {lit} with photometry"]


def convert(files: list[Path], scene: Path, rooms: list[str], ies: list[tuple[str, Path]],
            observers: bool = False, targets: Sequence[tuple[str, str]] = ()) -> Conversion:
    """Write buildings as a scene, its rooms and its fixtures.

    Parameters
    ----------
    files : list of paths
        IFC files that share their coordinates.
    scene : path
        ``.glb`` to write. ``.rooms.json``, ``.grids.json``, ``.luminaires.json`` and
        ``.luminaires.csv`` of the same name lie beside it where there are rooms and fixtures, and
        photometric files of other folders.
    rooms : list of str
        Patterns of numbers and names of rooms; none for all.
    ies : list of pairs
        Pattern of types of fixtures, and their photometric file.
    observers : bool
        Whether to write observers of each room into the folder ``.observers``.
    targets : list of pairs
        Pattern of rooms, as of `rooms`, and what their light is compared with: "office-desk".

    Errors: InputError, UsageError, OutputError, ImportError.
    """
    if scene.suffix.lower() != ".glb":
        raise UsageError(f"{scene}: name a .glb file to write")
    building = read(files)
    chosen = _chosen(building.rooms, rooms)
    _check_patterns("--target", [pattern for pattern, _ in targets], building.rooms)
    photometry = _Photometry(scene, building.warnings)
    _add_photometry(building, ies, photometry)
    luminaires = _luminaires(building.fixtures, photometry)

    camera = building.gltf.camera(_view)
    # Without --camera the first one is used.
    for room in sorted(chosen, key=lambda room: -float(room.outline.area)):
        building.gltf.node(name=room.name, camera=camera, matrix=room.camera())
    outputs = {**photometry.contents, scene: building.gltf.glb()}

    def beside(ending: str, content: bytes) -> str:
        path = scene.parent / (scene.stem + ending)
        outputs[path] = content
        return str(path)

    places, report = ["--plane", f"floor+{working_plane}"], []
    if chosen:
        places = ["--grid", beside(".grids.json", json_lines([_grid(room, targets) for room in chosen]))]
        report = ["--include", beside(".rooms.json", json_lines([room.record() for room in chosen]))]
    if building.fixtures:
        beside(".luminaires.csv", _schedule(building.fixtures))
    light = (["--luminaires", beside(".luminaires.json", json_lines(luminaires))] if luminaires
             else ["--sky", "overcast=10000"])
    if building.north:
        light += ["--set", f"north={building.north:g}"]
    groups = ["--light-group", "*=luminaires"] if len(luminaires) > _most_lights else []
    views = [f"--observers={beside(f'.observers/{room.file}.pts', room.observers().encode())}"
             for room in chosen if observers]
    ugr = views if luminaires else []
    commands = [["photile", "measure", str(scene), *places, *ugr, *light, *groups, *report, "-o",
                 str(scene.with_suffix(".html"))]]
    if views and not luminaires:
        commands.append(["photile", "glare", str(scene), *views, "--ratings", "dgp", *light, "-o",
                         str(scene.with_suffix(".glare.json"))])
    inputs = {path.resolve() for path in (*files, *(file for _, file in ies))}
    for path in outputs:
        if path.resolve() in inputs:
            raise UsageError(f"{path}: this file is read; name another one to write")
    write_files(outputs)
    return Conversion(commands, _summary(building, chosen, len(luminaires)), building.warnings)
