"""The rooms of a building, which ``photile import`` writes as ``rooms.json``, and what a record has of them."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import texts
from .luminaires import Luminaires
from .tables import Table, table, targets_of

Floats = NDArray[np.float64]

farthest = 1e6  # metres of a corner from the origin, below which sums have no rounding to see


class Room:
    """A room by its outline, which is level, metres in the coordinates of the scene.

    Raises the exceptions of indexing and arithmetic for what is not a room.
    """

    def __init__(self, entry: dict[str, Any]) -> None:
        self.name, self.storey = str(entry["name"]), str(entry.get("storey") or "")
        self.area, self.height, self.floor = (float(entry[key]) for key in ("area", "height", "floor"))
        self.outline, *holes = (np.array(ring, float).reshape(-1, 3)
                                for ring in (entry["outline"], *entry.get("holes", [])))
        self.rings = [self.outline, *holes]
        self.up = int(np.argmin(np.ptp(self.outline, axis=0)))  # y or z of a scene
        if len(self.outline) < 3 or not self.area > 0 or not (np.abs(np.vstack(self.rings)) < farthest).all():
            raise ValueError("a room has no area")

    def holds(self, places: Floats) -> NDArray[np.bool_]:
        """Whether each of several places is in the room, or in the void above its ceiling."""
        above = places[:, self.up] - self.floor
        x, y = np.delete(places, self.up, axis=1).T
        inside = np.zeros(len(places), bool)
        for ring in (np.delete(ring, self.up, axis=1) for ring in self.rings):
            for (a, b), (c, d) in zip(ring, np.roll(ring, -1, axis=0)):
                if b != d:  # each side of the outline that a ray along x crosses
                    crosses = (b > y) != (d > y)
                    inside ^= crosses & (x < a + (y - b) / (d - b) * (c - a))
        held: NDArray[np.bool_] = inside & (above > -0.1) & (above < self.height + 0.5)
        return held

    def on(self, plane: dict[str, Any]) -> list[Floats]:
        """The outline and the holes in metres along the sides of a plane from its corner."""
        sides = [np.array(plane[side], float) / np.linalg.norm(plane[side]) for side in "uv"]
        return [np.column_stack([(ring - np.array(plane["origin"], float)) @ side for side in sides])
                for ring in self.rings]


@dataclasses.dataclass
class RoomResults:
    """What a record has of a room.

    targets      those by which its grids are judged
    judgements   of its grids: what is required beside what is measured
    lamps        the luminaires in it, as the record has them
    watts        of these; 0 = not known of all
    """

    room: Room
    grids: list[dict[str, Any]]
    targets: list[dict[str, Any]]
    judgements: list[dict[str, Any]]
    lamps: list[dict[str, Any]]
    watts: float

    @property
    def met(self) -> bool | None:
        """Whether its grids have all that is required; None where nothing is."""
        return all(each["met"] for each in self.judgements) if self.judgements else None

    def facts(self) -> list[tuple[str, str]]:
        density = self.watts / self.room.area
        mean = self.grids[0]["statistics"]["Em"]["value"] if self.grids else None
        per_lux = f", {100 * density / mean:.2f} W/m\u00b2 / 100 lx" if mean else ""
        return [("storey", self.room.storey), ("floor area", f"{self.room.area:.1f} m\u00b2"),
                ("height", f"{self.room.height:.2f} m"),
                ("installed power", f"{texts.grouped(self.watts, 4)} W" if self.watts else ""),
                ("power density", f"{density:.2f} W/m\u00b2{per_lux}" if self.watts else "")]

    def parts(self, luminaires: Luminaires) -> Table:
        """Its luminaires by type."""
        of_type: dict[str, list[dict[str, Any]]] = {}
        for lamp in self.lamps:
            of_type.setdefault(luminaires.of_number[int(lamp["number"])].tag, []).append(lamp)
        types = {one.tag: one for one in luminaires.types}
        rows = []
        for tag in sorted(of_type, key=lambda tag: (len(tag), tag)):
            lumens = sum(lamp["lumens"] for lamp in of_type[tag])
            watts = sum(map(luminaires.watts, of_type[tag]))
            rows.append([tag, str(len(of_type[tag])), " \u00b7 ".join(types[tag].lines()),
                         f"{texts.grouped(lumens, 4)} lm", f"{texts.grouped(watts, 4)} W" if watts else ""])
        return table("Luminaires", ["type", "pieces", "luminaire", "luminous flux", "power"], rows, names=(0, 2))


class Building:
    """The rooms of a building, and the grids that are in none of them.

    Raises the exceptions of indexing and arithmetic for what is not a record.
    """

    def __init__(self, rooms: list[Room], record: dict[str, Any], luminaires: Luminaires) -> None:
        grids = record.get("grids", [])
        points = [np.array([sensor["position"] for sensor in grid["sensors"]], float).reshape(-1, 3) for grid in grids]
        places = np.array([lamp["position"] for lamp in luminaires.rows], float).reshape(-1, 3)
        targets = targets_of(record)
        judgements = [each for target in targets for each in target["judgements"]]
        self._named = {"Em": "mean, %"} if record.get("unit") == "DF %" else {"Em": "Em, lux", "Emin": "Emin, lux"}
        self.rooms: list[RoomResults] = []
        named = {room.name: room for room in rooms}
        room_of = [named.get(grid["name"].rsplit(": ", 1)[0]) or
                   next((room for room in rooms if 2 * np.count_nonzero(room.holds(some)) > len(some)), None)
                   for grid, some in zip(grids, points)]
        self.others = [grid for grid, room in zip(grids, room_of) if room is None]
        for room in rooms:
            own = [grid for grid, one in zip(grids, room_of) if one is room]
            names = {grid["name"] for grid in own}
            lamps = [lamp for lamp, held in zip(luminaires.rows, room.holds(places)) if held]
            watts = [luminaires.watts(lamp) for lamp in lamps]
            self.rooms.append(RoomResults(
                room, own, [one for one in targets if any(each["grid"] in names for each in one["judgements"])],
                [each for each in judgements if each["grid"] in names], lamps, sum(watts) if all(watts) else 0.0))

    @property
    def area(self) -> float:
        """Of all rooms, square metres."""
        return sum(one.room.area for one in self.rooms)

    def table(self) -> Table:
        """The first grid of each room, and whether the room has all that is required of it."""
        required: dict[str, dict[int, float]] = {"Em": {}, "Uo": {}}  # of each figure, by room
        for one in self.rooms:
            for each in one.judgements:
                if each["grid"] == one.grids[0]["name"] and each["figure"] in ("Em", "Emin", "Uo", "Ud"):
                    required.setdefault(each["figure"], {})[id(one)] = each["required"]
        differ = {figure for figure, of_room in required.items() if len(set(of_room.values())) > 1}

        def heading(figure: str) -> str:
            name = self._named.get(figure, figure)
            if figure in differ:
                return f"{name} (at least)"
            return f"{name}, at least {min(required[figure].values()):g}" if required[figure] else name

        def cell(one: RoomResults, figure: str) -> str:
            value = one.grids[0]["statistics"][figure]["value"] if one.grids else None
            if value is None:
                return ""
            text = texts.number(value, 3) if figure.startswith("E") else f"{value:.2f}"
            least = required[figure].get(id(one)) if figure in differ else None
            return text if least is None else f"{text} ({least:g})"

        use = [" / ".join(target["what"] or target["name"] for target in one.targets) for one in self.rooms]
        several = len(set(use)) > 1
        rows = [[one.room.name, one.room.storey, f"{one.room.area:.1f}", *([text] if several else []),
                 *(cell(one, figure) for figure in required),
                 "" if one.met is None else "met" if one.met else "not met"] for one, text in zip(self.rooms, use)]
        columns = ["room", "storey", "floor area, m²", *(["use"] if several else []), *map(heading, required), "target"]
        return table("Rooms", columns, rows, words=(0, 3, len(columns) - 1) if several else (0, len(columns) - 1),
                     names=(1,), kind="rooms")

    def facts(self) -> list[tuple[str, str]]:
        """Of all rooms together."""
        met = [one.met for one in self.rooms if one.met is not None]
        return [("rooms", str(len(self.rooms))), ("floor area", f"{self.area:.1f} m\u00b2"),
                ("target met", f"{sum(met)} / {len(met)}" if met else "")] if self.rooms else []
