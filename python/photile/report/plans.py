"""Geometry of drawings: planes of values in false colour at a scale, and polar curves of luminaires.

Templates draw them (``plan.svg``, ``curve.svg``); positions here are in pixels from the top left corner.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .isolines import Contours, Writing, on_cells, place_numbers
from .luminaires import Luminaires, outline_of
from .scale import Scale, fitted, illuminance_steps
from .texts import Words, number, rounded_up

Floats = NDArray[np.float64]

# Pixels.
pixels_per_millimetre = 4
margin, title_height, legend_height = 20, 34, 40
ruler_height, north_height = 26, 52
# Beside and below a whole plan: two lines of dimensions.
dimension_step = 16
dimensions_room = 2 * dimension_step + 14
# A whole plan has the largest drawing scale at which it fits below the figures of its grid on a page of A4,
# upright or lying, millimetres.
sheets = {"portrait": (180, 226), "landscape": (267, 143)}
drawing_scales = (1, 2, 5, 10, 20, 25, 50, 100, 200, 500)  # of ISO 5455, and 1:25
least_drawing = 60  # of which there is always one, millimetres
shown_wall = 0.2  # metres beyond the outline of a room
letter_width = 0.6  # the mean in common fonts without serifs, of their height
most_written_isolines = 300


def drawing_scale(least: float) -> float:
    """The denominator of the largest usual scale that is not larger than 1 to `least`."""
    return next((each for each in drawing_scales if each >= least), rounded_up(least, (1, 2, 5)))


@dataclasses.dataclass
class Label:
    """A text around a position; turned counts clockwise from the horizontal, degrees."""

    x: float
    y: float
    size: int
    weight: str
    text: str
    turned: float = 0.0

    @property
    def width(self) -> float:
        return letter_width * self.size * len(self.text)


@dataclasses.dataclass
class Dimension:
    """Metres between two corners, below the plan and left of it."""

    path: str
    across: tuple[float, float, str]
    upright: tuple[float, float, str]


@dataclasses.dataclass
class Legend:
    """Bars of colours (x, width, colour) and the values below them (x, text)."""

    label: str
    at_label: float
    x: float
    y: float
    height: int
    bars: list[tuple[float, float, str]]
    values: list[tuple[float, str]]


def _path(points: Floats, close: bool = False) -> str:
    return "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points) + ("Z" if close else "")


class Plan:
    """A plane seen against the direction that it faces, `u` to the right.

    A small plan is one of several: without texts on it, and not to scale. One without any values shows
    the room and its luminaires alone.

    luminaires   whose tags it has
    pages        of the sheets, to choose from
    outline      rings around a room, metres along u and v, to show as a whole in place of the plan's own room
    taken        height of the sheets that other things take, millimetres
    """

    def __init__(self, grid: dict[str, Any], values: list[float | None], title: str, colours: dict[str, Any],
                 words: Words | None = None, luminaires: Luminaires | None = None, small: bool = False,
                 pages: Iterable[str] = tuple(sheets), outline: Sequence[Floats] = (), taken: float = 0) -> None:
        plane = grid["plane"]
        plan = grid.get("plan") or {}
        self._words, self._luminaires = words or Words(), luminaires or Luminaires({})
        self.small = small
        self._on_cells = on_cells(plane, values)
        self._rows, self._columns = self._on_cells.shape
        self._values = self._on_cells.ravel()
        self._bare = bool(np.isnan(self._values).all())
        self._size = np.array([np.linalg.norm(plane["u"]), np.linalg.norm(plane["v"])])
        self._low = np.full(2, float(plan.get("reach", 0)))  # metres that are shown before the plane
        beyond = self._low
        if outline:
            low, high = np.vstack(outline).min(axis=0), np.vstack(outline).max(axis=0)
            plan = {**plan, "room": [low, high]}
            beyond = np.maximum(beyond, high - self._size + shown_wall)
            self._low = np.maximum(self._low, shown_wall - low)
        self._scale = Scale(fitted(colours, [self._values]))
        self._north = None if small else self._direction_of_north(plan)
        self._left, around = (margin, 0) if small else (dimensions_room, dimensions_room)
        metres = self._size + self._low + beyond
        self.page, self.scale, self._per_metre = "portrait", "", 200 / max(metres)
        if not small:
            scales = {page: drawing_scale(1000 * max(metres / self._room(page, taken))) for page in pages}
            self.page = min(scales, key=lambda page: scales[page])
            self._per_metre = 1000 * pixels_per_millimetre / scales[self.page]
            self.scale = f"1:{scales[self.page]:.0f}"
        self._inner = self._per_metre * metres
        self.title = ", ".join(filter(None, (title, self.scale)))
        self._foot = title_height + self._inner[1] + around
        self.width = round(max(self._left + self._inner[0] + margin,
                               letter_width * 14 * len(self.title) + 2 * margin, 240 if small else 400))
        self.height = round(self._foot + sum(self._foot_rows(self.page)))
        self.unit, self.per_unit = ("", 1) if small else ("mm", pixels_per_millimetre)
        self._writing = Writing()
        self.labels: list[Label] = []
        self._draw(grid, plane, plan)
        self.outline = "".join(_path(self._at(ring), True) for ring in outline)

    def _draw(self, grid: dict[str, Any], plane: dict[str, Any], plan: dict[str, Any]) -> None:
        scale, cells = self._scale, np.flatnonzero(~np.isnan(self._values))
        self.cell = self._per_metre * self._size / (self._columns, self._rows)
        self.cells = [] if scale.contours in ("isolines", "bands") else [
            (x - self.cell[0] / 2, y - self.cell[1] / 2, scale.colour(self._values[cell]))
            for cell, (x, y) in zip(cells, self._middles(cells))]
        (x, y), (right, top) = self._at([[0, 0], self._size])
        self.frame = None if self._bare else (x, top, right - x, y - top)
        self.corners = [] if self.small or self._bare else self._coordinates(plane)
        self._cross(grid, plane)
        if not self.small:
            self._write_values(cells)
        self._surround(plan)
        self.bands = self._bands() if scale.contours == "bands" else []
        self.isolines = self._isolines() if scale.contours in ("cells", "isolines") else []
        self.dimensions = [] if self.small else self._dimensions(plan)
        self.ruler = self._ruler()
        self.legend = None if self._bare else self._legend()
        self.north = None if self._north is None else {
            "turned": self._north, "x": self._left + max(self._inner[0], 320) - 16, "y": self._foot + 25}

    @staticmethod
    def _direction_of_north(plan: dict[str, Any]) -> float | None:
        """Degrees clockwise from upwards; None where the record does not have it."""
        east, up = plan.get("north") or (0.0, 0.0)
        return math.degrees(math.atan2(east, up)) if math.hypot(east, up) > 0 else None

    def _foot_rows(self, page: str) -> tuple[float, float]:
        """The heights of ruler and legend: on a lying page they are beside each other."""
        row, legend = ruler_height if self._north is None else north_height, 0 if self._bare else legend_height
        return (0, max(row, legend)) if page == "landscape" else (row, legend)

    def _room(self, page: str, taken: float) -> Floats:
        """Millimetres for the drawing itself on a page."""
        beside = (dimensions_room + margin, title_height + dimensions_room + sum(self._foot_rows(page)))
        room: Floats = np.array(sheets[page]) - np.array(beside) / pixels_per_millimetre - (0, taken)
        return np.maximum(room, least_drawing)

    def _at(self, metres: Any) -> Floats:
        """Pixels of positions in metres along u and v from the plane's corner."""
        places = (np.reshape(np.asarray(metres, float), (-1, 2)) + self._low) * self._per_metre
        return np.column_stack([self._left + places[:, 0],
                                title_height + self._inner[1] - places[:, 1]])

    def _middles(self, cells: Any) -> Floats:
        cells = np.asarray(cells, int)
        places = np.column_stack([cells % self._columns, cells // self._columns]) + 0.5
        return self._at(places / (self._columns, self._rows) * self._size)

    def _write(self, label: Label) -> None:
        self.labels.append(label)
        self._writing.add((label.x, label.y), math.radians(label.turned), label.width, label.size)

    def _write_values(self, cells: NDArray[np.intp]) -> None:
        """The numbers of cells: of each, or of every second, third ... where they need the room."""
        size, apart = 9, 9
        texts = [self._words.figure(number(self._values[cell], 3)) for cell in cells]
        room = np.array([letter_width * size * max(map(len, texts), default=0) + apart, size + apart])
        every = np.maximum(np.ceil(room / self.cell), 1).astype(int)
        for cell, text, (x, y) in zip(cells, texts, self._middles(cells)):
            column, row = cell % self._columns, cell // self._columns
            if column % every[0] == every[0] // 2 and row % every[1] == every[1] // 2:
                self._write(Label(x, y, size, "normal", text))

    def _contours(self, smooth: bool) -> Contours | None:
        if min(self._columns, self._rows) < 2 or self._bare:
            return None
        return Contours(self._on_cells, self._size, smooth)

    def _bands(self) -> list[tuple[str, str]]:
        """Colours and paths, with the levels numbered like isolines."""
        found: list[tuple[str, str]] = []
        contours = self._contours(False)
        if contours is None:
            return found
        for (low, high), level in zip(self._scale.bands(), self._scale.levels()):
            outlines = [self._at(loop) for area in contours.areas(low, high) for loop in area]
            if outlines:
                found.append((self._scale.colour(level), "".join(_path(loop, True) for loop in outlines)))
                self._number(outlines, level)
        return found

    def _isolines(self) -> list[tuple[str, str]]:
        """Colours and paths, at the steps of the standard or as in falsecolor."""
        found: list[tuple[str, str]] = []
        contours = self._contours(True)
        if contours is None:
            return found
        for level in self._levels():
            lines = [self._at(line) for line in contours.lines(level)]
            if lines:
                colour = self._scale.colour(level) if self._scale.contours == "isolines" else "#000000"
                found.append((colour, "".join(map(_path, lines))))
                self._number(lines, level)
        return found

    def _levels(self) -> list[float]:
        """Those of isolines."""
        known = self._values[~np.isnan(self._values)]
        if self._scale.chosen:
            return self._scale.chosen
        alone = self._scale.contours == "isolines"
        return self._scale.levels() if alone or not len(known) else illuminance_steps(min(known), max(known))

    def _number(self, lines: list[Floats], level: float) -> None:
        """Writes a level along its lines, where there is room."""
        if self.small:
            return
        text, size = self._words.figure(number(level, 3)), 11
        for line in sorted(lines, key=len, reverse=True):
            if len(self.labels) > most_written_isolines + len(self._values):
                return
            for x, y, angle in place_numbers(line, letter_width * size * len(text), size, self._writing, 600):
                self.labels.append(Label(x, y, size, "bold", text, math.degrees(angle)))

    def _surround(self, plan: dict[str, Any]) -> None:
        """Walls and furniture are paths in metres, which the template moves to their place."""
        (x, y), = self._at([0, 0])
        self.transform = f"matrix({self._per_metre:.6g} 0 0 {-self._per_metre:.6g} {x:.2f} {y:.2f})"
        self.pixel = 1 / self._per_metre
        self.furniture, self.walls = plan.get("furniture", ""), plan.get("walls", "")
        self.lamps: list[str] = []
        for lamp in [] if self.small else plan.get("lamps", []):
            self._add_lamp(lamp)

    def _add_lamp(self, lamp: dict[str, Any]) -> None:
        """The outline of a luminaire, or a circle where it has no size, and its tag at the first place
        that is free: on it, in its corners, beside it."""
        (x, y), = self._at(lamp["position"])
        kind = self._luminaires.of_number.get(int(lamp["number"]))
        corners = np.array(lamp.get("outline") or [], float)
        if len(corners) >= 3:
            outline = self._at(outline_of(corners, kind is not None and kind.round))
        else:
            turns = np.linspace(0, 2 * math.pi, 24, endpoint=False)
            outline = np.column_stack([x + 4 * np.cos(turns), y + 4 * np.sin(turns)])
        outline = np.clip(outline, (self._left, title_height), self._inner + (self._left, title_height))
        self.lamps.append(_path(outline, True))
        label = Label(x, y, 10, "bold", self._luminaires.tag(int(lamp["number"])))
        half = 0.5 * np.ptp(outline, axis=0)
        inside = np.maximum(half - (0.5 * label.width + 3, 0.5 * label.size + 3), 0)
        beside = half + (0.5 * label.width + 3, 0.5 * label.size + 3)
        steps = [(0, 0), *(inside * corner for corner in ((0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1))),
                 *(beside * side for side in ((1, 0), (-1, 0), (0, -1), (0, 1)))]
        places = 0.5 * (outline.min(axis=0) + outline.max(axis=0)) + np.array(steps, float)
        room = self._writing.clearance(places, np.zeros(len(places)), label.width, label.size)
        best = int(np.argmax(room > 1)) if (room > 1).any() else int(np.argmax(room))
        label.x, label.y = float(places[best, 0]), float(places[best, 1])
        self._write(label)

    def _cross(self, grid: dict[str, Any], plane: dict[str, Any]) -> None:
        """Crosses at points that are not measured, or doubtful."""
        origin, u, v = (np.array(plane[key], float) for key in ("origin", "u", "v"))
        blank = [[np.dot(np.subtract(point["position"], origin), side) / np.linalg.norm(side)
                  for side in (u, v)] for point in grid.get("blank", [])]
        marked = [cell for cell, sensor in zip(plane["cells"], grid.get("sensors", []))
                  if sensor.get("mark")]
        places = np.vstack([self._at(blank) if blank else np.empty((0, 2)), self._middles(marked)])
        arm = min(max(0.3 * self.cell[0], 1.5), 8.0)
        self.crosses = "".join(f"M{x - arm:.2f} {y - arm:.2f}L{x + arm:.2f} {y + arm:.2f}"
                               f"M{x - arm:.2f} {y + arm:.2f}L{x + arm:.2f} {y - arm:.2f}"
                               for x, y in places)

    def _coordinates(self, plane: dict[str, Any]) -> list[tuple[float, float, str, str]]:
        """The coordinates of two corners, in the scene's world."""
        low, high = self._at([[0, 0], self._size])
        origin = np.array(plane["origin"], float)
        found = [(x, y, anchor, self._words.figure("({:.2f}, {:.2f}, {:.2f}) m".format(*world)))
                 for x, y, anchor, world in (
                     (low[0], low[1] + (11 if self._low.any() else -4), "start", origin),
                     (high[0], high[1] - 4, "end", origin + plane["u"] + plane["v"]))]
        for x, y, anchor, text in found:
            half = 0.5 * letter_width * 8 * len(text)
            self._writing.add((x + (half if anchor == "start" else -half), y - 3), 0.0, 2 * half, 8)
        return found

    def _dimensions(self, plan: dict[str, Any]) -> list[Dimension]:
        found = []
        bottom, right, tick = title_height + self._inner[1], self._left + self._inner[0], 3
        for row, corners in enumerate([None if self._bare else [[0, 0], list(self._size)], plan.get("room")], 1):
            if corners is None:
                continue
            (ax, ay), (bx, by) = self._at(corners)
            if ax < self._left - 1 or bx > right + 1 or by < title_height - 1 or ay > bottom + 1:
                continue  # beyond what is shown
            x, y = self._left - row * dimension_step, bottom + row * dimension_step
            found.append(Dimension(
                f"M{ax:.2f} {y:.2f}H{bx:.2f}M{ax:.2f} {y - tick:.2f}v{2 * tick}"
                f"M{bx:.2f} {y - tick:.2f}v{2 * tick}M{x:.2f} {ay:.2f}V{by:.2f}"
                f"M{x - tick:.2f} {ay:.2f}h{2 * tick}M{x - tick:.2f} {by:.2f}h{2 * tick}",
                ((ax + bx) / 2, y - 2, self._words.figure(f"{(bx - ax) / self._per_metre:.2f}")),
                (x - 2, (ay + by) / 2, self._words.figure(f"{(ay - by) / self._per_metre:.2f}"))))
        return found

    def _ruler(self) -> dict[str, Any]:
        """A scale bar of 1, 2 or 5 times a power of ten metres, at most a quarter of the plan's width, in
        two or five parts."""
        most = min(max(self._inner[0], 200) / 4, 180) / self._per_metre
        power = 10.0 ** math.floor(math.log10(most))
        step = next(step for step in (5, 2, 1) if step * power <= most or step == 1)
        parts = 2 if step == 2 else 5
        x, length = self._left, step * power * self._per_metre
        return {"y": self._foot + 6, "x": x, "end": x + length,
                "parts": [(x + i * length / parts, length / parts) for i in range(0, parts, 2)],
                "metres": self._words.figure(f"{step * power:g} m"), "scale": self.scale}

    def _legend(self) -> Legend:
        """A bar with values where colours change, or below the colours of isolines and bands."""
        scale, size = self._scale, (9 if self.small else 11)
        label = self._words(scale.label)
        right = max(self._left + self._inner[0], self.width - 2 * margin)
        beside = self.page == "landscape"
        at_label = self.ruler["end"] + 150 if beside else self._left
        x = at_label + letter_width * 12 * len(label) + 8
        width = min(right - (40 if beside and self._north is not None else 0) - x, 560)
        stepped = scale.contours != "cells"
        count = scale.steps if stepped else scale.steps * max(64 // scale.steps, 1)
        bars = [(x + i * width / count, width / count, scale.colour(scale.value_at((i + 0.5) / count)))
                for i in range(count)]
        values = [(x + share * width, self._words.figure(number(value, 4))) for share, value in scale.marks()]
        room = letter_width * size * max(len(text) for _, text in values) + 8
        every = max(math.ceil(room * len(values) / width), 1)
        # The highest has its number, and so has each that is as far from the next.
        shown = values[::-1][::every][::-1]
        y = self._foot + self._foot_rows(self.page)[0] + 4
        return Legend(label, at_label, x, y, 10 if self.small else 14, bars, shown)


class Curve:
    """Intensities of a luminaire in the planes C0-C180 and C90-C270, cd per 1000 lm, with circles at
    round values; down is where it is aimed."""

    size, radius = 200, 78  # pixels

    def __init__(self, intensities: dict[str, list[float]]) -> None:
        planes = [np.array(intensities[plane], float) for plane in ("C0", "C90")]
        ring = rounded_up(max(plane.max() for plane in planes) / 4, (1, 2, 2.5, 5))
        middle = self.size / 2
        self.middle = middle
        self.rings = [(i * self.radius / 4, f"{i * ring:g}") for i in range(1, 5)]
        self.rays = [(middle + self.radius * math.sin(math.radians(angle)),
                      middle + self.radius * math.cos(math.radians(angle)),
                      middle + (self.radius + 11) * math.sin(math.radians(angle)),
                      middle + (self.radius + 11) * math.cos(math.radians(angle)) + 3,
                      min(angle, 360 - angle)) for angle in range(0, 360, 30)]
        self.paths = []
        for plane in planes:
            angles = np.radians(np.linspace(-180, 180, len(plane)))
            reach = self.radius / (4 * ring) * plane
            self.paths.append(_path(np.column_stack([middle + reach * np.sin(angles),
                                                     middle + reach * np.cos(angles)])))
