"""Arrangements of luminaires in a room, as entries of the list that ``--luminaires`` takes.

Positions on the plan are metres along the sides of the rectangle around the floor. A field has its
own axes, along and across the longest wall.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import UsageError

__all__ = ["Arrangement", "Designer", "Room", "most_luminaires"]

Floats = NDArray[np.float64]

most_luminaires = 1000
_most_unequal = 2.0  # the greater spacing over the smaller one
_least_floor = 0.75  # of the cell of a field around a luminaire
_to_border = 0.3  # metres from a luminaire to the border of the floor: half of one of 0.6 m


def _turn(angle: float) -> Floats:
    """Rows times this matrix are turned by the angle, in radians."""
    cosine, sine = round(math.cos(angle), 12), round(math.sin(angle), 12)
    return np.array([[cosine, sine], [-sine, cosine]])


def _cells(columns: int, rows: int) -> Floats:
    """The middles of cells of unit size, (rows, columns, 2)."""
    middles: Floats = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1) + 0.5
    return middles


def _cells_of(plane: dict[str, Any]) -> NDArray[np.bool_]:
    """Which cells of a plane have a point, (rows, columns)."""
    cells = np.zeros((plane["rows"], plane["columns"]), bool)
    cells.flat[plane["cells"]] = True
    return cells


def _at(cells: NDArray[np.bool_], plan: Floats) -> NDArray[np.bool_]:
    """What cells have at positions (..., 2), counted in cells; nothing beyond them."""
    rows, columns = cells.shape
    x, y = np.moveaxis(np.floor(plan).astype(int), -1, 0)
    inside = (x >= 0) & (y >= 0) & (x < columns) & (y < rows)
    held: NDArray[np.bool_] = inside & cells[y.clip(0, rows - 1), x.clip(0, columns - 1)]
    return held


@dataclass(frozen=True)
class Room:
    """A room as ``photile measure`` finds it.

    Attributes
    ----------
    origin : (3,) array
        Corner of the rectangle around the floor, at the height of the working plane, in the
        coordinates of the scene's file.
    axes : (3, 3) array
        Unit vectors along the sides of the rectangle, and upwards.
    floor_height, ceiling_height : float
        Above the working plane, metres.
    area : float
        m2.
    cell : (2,) array
        Sides of a cell of the floor, metres.
    floor : (rows, columns) array
        Whether a cell is floor, with furniture on it or not.
    clear : sequence of planes
        At the heights of luminaires, where nothing is in their way: no tall furniture, beam or slope.
    walls : (k, 2, 2) array
        Both ends of the walls at the height of the working plane, on the plan.
    """

    origin: Floats
    axes: Floats
    floor_height: float
    ceiling_height: float
    area: float
    cell: Floats
    floor: NDArray[np.bool_]
    walls: Floats
    clear: Sequence[dict[str, Any]] = ()

    @classmethod
    def of(cls, record: dict[str, Any]) -> Room:
        """The room of the results of a working plane without a wall band and of cylinders 1 m above
        the floor."""
        grids = {grid["name"]: grid for grid in record["grids"]}
        working, metre = grids["working plane"], grids["cylindrical"]["plane"]
        plane = working["plane"]
        origin, u, v = (np.array(plane[name]) for name in ("origin", "u", "v"))
        sides = np.array([np.linalg.norm(u), np.linalg.norm(v)])
        axes = np.array([u / sides[0], v / sides[1], np.cross(u, v) / sides.prod()])
        floor_height = float(axes[2] @ (np.array(metre["origin"]) - origin)) - 1.0
        floor = _cells_of(plane)
        cell = sides / floor.shape[::-1]
        for blank in working.get("blank", ()):  # there is furniture on them
            x, y = np.floor(axes[:2] @ (np.array(blank["position"]) - origin) / cell).astype(int)
            floor[y, x] = True
        walls: list[Any] = []
        for line in working["plan"]["walls"].split("M")[1:]:  # an SVG path
            corners = [[float(x) for x in corner.split()] for corner in line.split("L")]
            walls += zip(corners, corners[1:])
        return cls(origin, axes, floor_height, floor_height + record["room"]["height"],
                   record["room"]["area"], cell, floor, np.array(walls, float).reshape(-1, 2, 2))

    def with_obstacles(self, record: dict[str, Any]) -> Room:
        """With what is in the way at the heights of the planes of these results."""
        return replace(self, clear=[grid["plane"] for grid in record["grids"]])

    def spacing(self, cells: int) -> float:
        """Metres that make so many cells along the longer side."""
        return float(max(self.cell * self.floor.shape[::-1])) / cells

    def in_file(self, plan: Floats, height: float) -> list[float]:
        """Coordinates in the scene's file of a position at a height above the working plane."""
        point = self.origin + np.array([*plan, height]) @ self.axes
        return [round(float(x), 4) for x in point]

    def holds(self, plan: Floats) -> NDArray[np.bool_]:
        """Whether there is floor at positions (..., 2) on the plan."""
        return _at(self.floor, plan / self.cell)

    def is_clear(self, plan: Floats) -> NDArray[np.bool_]:
        """Whether there is floor, and a luminaire is free of furniture and below the roof."""
        clear = self.holds(plan)
        for plane in self.clear:
            cells = _cells_of(plane)
            corner = self.axes[:2] @ (np.array(plane["origin"]) - self.origin)
            sides = np.linalg.norm([plane["u"], plane["v"]], axis=1) / cells.shape[::-1]
            clear &= _at(cells, (plan - corner) / sides)
        return clear

    def wall_angle(self) -> float:
        """Radians, -pi/4 to pi/4, that the longest of the walls is turned on the plan, or a wall
        across it. Only walls count that lie along or across the direction that most have."""
        if not len(self.walls):
            return 0.0
        ways = self.walls[:, 1] - self.walls[:, 0]
        lengths = np.hypot(*ways.T)
        angles = (np.arctan2(ways[:, 1], ways[:, 0]) + math.pi / 4) % (math.pi / 2) - math.pi / 4
        degrees = np.round(np.degrees(angles)).astype(int) % 90
        most = np.argmax(np.bincount(degrees, weights=lengths))
        angle = float(angles[np.argmax(np.where(degrees == most, lengths, 0))])
        return angle if abs(angle) > 1e-3 else 0.0  # corners of the plan are whole millimetres

    def extent(self, angle: float) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates of the floor along axes that are turned on the plan."""
        turn = _turn(angle)
        rows, columns = np.nonzero(self.floor)
        middles = (np.stack([columns, rows], axis=-1) + 0.5) * self.cell @ turn.T
        low, high = middles.min(axis=0), middles.max(axis=0)
        if abs(math.sin(2 * angle)) < 1e-9:  # along the cells
            half = np.abs(turn @ self.cell) / 2
            return low - half, high + half
        # The walls beside the outermost cells, because cells at an angle end before them.
        ends = self.walls @ turn.T
        ways = np.abs(ends[:, 1] - ends[:, 0])
        reach = float(np.hypot(*self.cell))
        for axis in range(2):
            walls = ends[ways[:, axis] < 0.01 * ways[:, 1 - axis], 0, axis]
            lower, higher = walls[walls <= low[axis]], walls[walls >= high[axis]]
            low[axis] = max(lower[lower >= low[axis] - reach], default=low[axis])
            high[axis] = min(higher[higher <= high[axis] + reach], default=high[axis])
        return low, high


@dataclass(frozen=True)
class Arrangement:
    """Luminaires in words, how many they are, and their entries of the list."""

    text: str
    count: int
    entries: list[dict[str, Any]]


def _blocks(kept: NDArray[np.bool_]) -> list[list[int]]:
    """Rectangles that together are what is kept: first row, first column, rows, columns."""
    blocks: list[list[int]] = []
    for row, line in enumerate(kept):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], line, [0]])))
        for begin, end in edges.reshape(-1, 2).tolist():
            for block in blocks:
                if block[0] + block[2] == row and block[1::2] == [begin, end - begin]:
                    block[2] += 1
                    break
            else:
                blocks.append([row, begin, 1, end - begin])
    return blocks


class Designer:
    """Arranges luminaires of one kind at one height of a room.

    Parameters
    ----------
    room : Room
    height : float
        Of the luminaires above the working plane, metres.
    luminaire : dict
        Members that all entries have; several entries get numbers after their ``name``.
    across : bool
        Whether C0 lies across the longest wall in place of along it.
    aim : (3,) floats or None
        Where luminaires point, in the coordinates of the scene's file; None is down.

    Attributes
    ----------
    size : (2,) array
        Of the rectangle around the floor along the longest wall and across, metres.
    """

    def __init__(self, room: Room, height: float, luminaire: dict[str, Any], across: bool = False,
                 aim: Sequence[float] | None = None) -> None:
        self._room, self._height, self._luminaire = room, height, luminaire
        self._across, self._aim = across, aim
        self._angle = room.wall_angle()
        low, high = room.extent(self._angle)
        if high[0] - low[0] < high[1] - low[1] - 1e-6:
            self._angle += math.pi / 2
            low, high = room.extent(self._angle)
        self._low: Floats = low
        self.size: Floats = high - low

    def _on_plan(self, places: Floats) -> Floats:
        return places @ _turn(self._angle)

    def _entry(self, plan: Floats, angle: float) -> dict[str, Any]:
        position = self._room.in_file(plan, self._height)
        entry: dict[str, Any] = {**self._luminaire, "position": position}
        if self._aim is not None:
            entry["aim"] = [round(a - p, 4) for a, p in zip(self._aim, position)]
            if not any(entry["aim"]):
                raise UsageError("a luminaire is at the point at which it aims; give another point")
        elif degrees := round(math.degrees(angle) + 90 * self._across, 3):
            entry["rotation"] = degrees
        return entry

    def _arrangement(self, text: str, count: int, entries: list[dict[str, Any]]) -> Arrangement:
        for number, entry in enumerate(entries if len(entries) > 1 else (), 1):
            entry["name"] += f"_{number}"
        number_of = f"{count} luminaire{'s' if count > 1 else ''}"
        return Arrangement(f"{number_of}, {text}", count, entries)

    def _kept(self, columns: int, rows: int) -> NDArray[np.bool_]:
        """Which luminaires of a field, (rows, columns), are over the floor: all floor near them, with
        nothing in their way, and most of the field's cell around them."""
        spacing = self.size / (columns, rows)
        middles = (self._low + _cells(columns, rows) * spacing)[:, :, None]
        cell = (_cells(6, 6).reshape(-1, 2) / 6 - 0.5) * spacing
        near = (_cells(3, 3).reshape(-1, 2) - 1.5) * np.minimum(spacing / 4, _to_border)
        clear = self._room.is_clear(self._on_plan(middles + near)).all(axis=-1)
        share = self._room.holds(self._on_plan(middles + cell)).mean(axis=-1)
        kept: NDArray[np.bool_] = clear & (share >= _least_floor)
        return kept

    def field(self, columns: int, rows: int) -> Arrangement:
        """Columns along the longest wall and rows across, half a spacing from the sides of the
        rectangle around the floor. A luminaire is left out that is beyond the floor or at its
        border, in furniture or right above it, or with less floor than three quarters of the
        spacing squared around it.

        Errors: UsageError where none is left.
        """
        kept, spacing = self._kept(columns, rows), self.size / (columns, rows)
        count = int(kept.sum())
        if not count:
            raise UsageError(f"no luminaire of a field of {columns} x {rows} is over the floor "
                             "and free of furniture; give more columns or rows")
        singly = [[row, column, 1, 1] for row, column in np.argwhere(kept).tolist()]
        entries = []
        for row, column, down, along in _blocks(kept) if self._aim is None else singly:
            middle = self._low + np.array([column + along / 2, row + down / 2]) * spacing
            entry = self._entry(self._on_plan(middle), self._angle)
            if along * down > 1:
                order = -1 if self._across else 1
                entry["count"] = [along, down][::order]
                entry["spacing"] = [round(float(x), 4) for x in spacing][::order]
            entries.append(entry)
        left_out = f" ({kept.size - count} left out)" if count < kept.size else ""
        apart = " x ".join(f"{x:.2f}" for x in spacing)
        return self._arrangement(f"{columns} x {rows}{left_out}, {apart} m apart", count, entries)

    def circle(self, count: int, radius: float) -> Arrangement:
        """Around the middle of the rectangle around the floor; C0 is along the radius or across.

        Errors: UsageError where a luminaire is not over the floor, or has furniture in its way.
        """
        middle = self._on_plan(self._low + self.size / 2)
        entries = []
        for angle in self._angle + 2 * math.pi * np.arange(count) / count:
            plan = middle + radius * np.array([math.cos(angle), math.sin(angle)])
            if not self._room.is_clear(plan):
                raise UsageError(f"a circle of {radius:g} m reaches beyond the floor or into furniture; "
                                 "make its radius smaller")
            entries.append(self._entry(plan, (angle + math.pi) % (2 * math.pi) - math.pi))
        return self._arrangement(f"on a circle of {radius:g} m", count, entries)

    def fields(self, spacing: float) -> list[tuple[int, int, int]]:
        """Fields whose spacings are at most so many metres: of each number of luminaires,
        ascending, the one whose spacings along and across are most equal, as number, columns, rows.

        Errors: UsageError where that takes more than most_luminaires.
        """
        least = np.maximum(1, np.ceil(self.size / spacing - 1e-9)).astype(int).tolist()

        def inequality(columns: int, rows: int) -> float:
            ratio = float(self.size[0] * rows / (self.size[1] * columns))
            return max(ratio, 1 / ratio)

        most = max(_most_unequal, inequality(*least))
        best: dict[int, tuple[float, int, int]] = {}
        for rows in range(least[1], most_luminaires // least[0] + 1):
            for columns in range(least[0], most_luminaires // rows + 1):
                unequal = inequality(columns, rows)
                if unequal <= most and (count := int(self._kept(columns, rows).sum())):
                    best[count] = min(best.get(count, (math.inf, 0, 0)), (unequal, columns, rows))
        if not best:
            raise UsageError(f"fields with a spacing of at most {spacing:.3g} m have more than "
                             f"{most_luminaires} luminaires; give a greater one")
        return [(count, *best[count][1:]) for count in sorted(best)]
