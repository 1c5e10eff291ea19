"""Geometry of drawings: planes of values in false colour at a scale, and polar curves of luminaires.

Templates draw them (``plan.svg``, ``curve.svg``); positions here are in pixels from the top left corner.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import contourpy
import numpy as np
from numpy.typing import NDArray

from .texts import number, rounded_up

Floats = NDArray[np.float64]
Place = tuple[float, float]

# Pixels.
margin, title_height, foot_height = 20, 48, 40
pixels_per_millimetre = 4
# Beside and below a whole plan: two lines of dimensions.
dimension_step = 16
dimensions_room = 2 * dimension_step + 6
# A whole plan has the largest of the draughtsmen's scales at which it fits on a page of A4 beside its
# legend and below its figures, millimetres.
widest, highest = 130, 160
draughtsmen = (1, 2, 2.5, 3, 4, 5, 7.5)
most_numbered_cells = 400
# The part of a step that a band takes, around its middle.
band_begin, band_end = 0.4, 0.6


def automatic_top(values: Floats) -> float:
    """The largest of the values without the uppermost 2%; 0 where none is positive."""
    known = np.sort(values[np.isfinite(values) & (values > 0)])
    return float(known[len(known) - 1 - int(0.02 * len(known))]) if len(known) else 0.0


def rounded_top(top: float, steps: int) -> float:
    """The least number that is not below and whose steps have round middles: 10, 30, 50 ..."""
    return rounded_up(top / steps, (1, 1.2, 1.6, 2, 3, 4, 6, 8)) * steps if top > 0 else top


def illuminance_steps(low: float, high: float) -> list[float]:
    """The steps of the scale of EN 12464-1 between two illuminances: 5, 7.5, 10, 15, 20, 30, 50 ..."""
    if not (high > 0 and math.isfinite(high)):
        return []
    least = max(low, high / 1000)
    steps, decade = [], 10.0 ** math.floor(math.log10(least))
    while decade < high:
        steps += [step * decade for step in (1, 1.5, 2, 3, 5, 7.5) if least < step * decade < high]
        decade *= 10
    return steps


class Scale:
    """Colours of values, by the options of false colour. `scale` 0: up to `automatic`."""

    def __init__(self, colours: dict[str, Any], automatic: float) -> None:
        self.top = colours["scale"] or automatic or 1.0
        self.steps, self.decades = int(colours["steps"]), colours["decades"]
        self.contours = colours["contours"]
        self.label = colours["label"]
        self._palette = colours["palette"].split()

    def value_at(self, share: float) -> float:
        return float(self.top * (10 ** ((share - 1) * self.decades) if self.decades else share))

    def levels(self) -> list[float]:
        """The levels of isolines: the middles of the legend's steps, as in falsecolor."""
        return [self.value_at((step + 0.5) / self.steps) for step in range(self.steps)]

    def bands(self) -> list[tuple[float, float]]:
        return [(self.value_at((step + band_begin) / self.steps),
                 self.value_at((step + band_end) / self.steps)) for step in range(self.steps)]

    def colour(self, value: float) -> str:
        share = value / self.top
        if self.decades:
            share = 1 + math.log10(share) / self.decades if value > 0 else 0
        if self.contours == "steps":
            share = (math.floor(min(max(share, 0), 1 - 1e-9) * self.steps) + 0.5) / self.steps
        # Halves are rounded up, as std::lround does.
        return str(self._palette[math.floor(min(max(share, 0), 1) * (len(self._palette) - 1) + 0.5)])


def refined(values: Floats) -> tuple[Floats, int]:
    """Values between the middles of cells by bicubic interpolation (Catmull and Rom, 1974), so that
    isolines are smooth; NaN beside a cell without a value. Also the steps from one middle to the next.

    It keeps given values and follows slopes exactly: beyond the border and beside cells without a value
    they continue linearly.
    """
    per_cell = min(max(2000 // max(values.shape), 1), 8)
    for _ in range(2):  # along the rows, then along the columns
        b, c = values[:, :-1], values[:, 1:]
        edge = np.full((len(values), 1), np.nan)
        a = np.hstack([edge, values[:, :-2]]) if values.shape[1] > 1 else b
        d = np.hstack([values[:, 2:], edge]) if values.shape[1] > 1 else c
        a, d = np.where(np.isnan(a), 2 * b - c, a), np.where(np.isnan(d), 2 * c - b, d)
        fine = np.empty((len(values), (values.shape[1] - 1) * per_cell + 1))
        fine[:, ::per_cell] = values
        for step in range(1, per_cell):
            t = step / per_cell
            fine[:, step::per_cell] = b + 0.5 * t * (
                c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
        values = fine.T
    return values, per_cell


@dataclasses.dataclass
class Label:
    x: float
    y: float
    size: int
    weight: str
    text: str


@dataclasses.dataclass
class Dimension:
    """Metres between two corners, below the plan and left of it."""

    path: str
    across: tuple[float, float, str]
    upright: tuple[float, float, str]


def _path(points: Floats, close: bool = False) -> str:
    return "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points) + ("Z" if close else "")


class Plan:
    """A plane seen against the direction that it faces, `u` to the right.

    A small plan is one of several: without the values of isolines and cells, and not to scale.
    """

    def __init__(self, grid: dict[str, Any], values: list[float | None], title: str,
                 colours: dict[str, Any], small: bool = False) -> None:
        plane = grid["plane"]
        plan = grid.get("plan") or {}
        self.small, self._reach = small, float(plan.get("reach", 0))
        self._columns, self._rows = int(plane["columns"]), int(plane["rows"])
        self._size = np.array([np.linalg.norm(plane["u"]), np.linalg.norm(plane["v"])])
        self._values = np.full(self._columns * self._rows, np.nan)
        self._values[plane["cells"]] = np.array(values, float)
        known = self._values[~np.isnan(self._values)]
        self._scale = Scale(colours, rounded_top(automatic_top(known), int(colours["steps"])))
        wide, high = self._size + 2 * self._reach
        scale = rounded_up(max(1.0, 1000 * max(wide / widest, high / highest)), draughtsmen)
        self._per_metre = 190 / max(wide, high) if small else 1000 * pixels_per_millimetre / scale
        self._left = margin + (0 if small else dimensions_room)
        self._inner = self._per_metre * np.array([wide, high])
        self.title = title if small else f"{title}, 1:{scale:g}"
        # No letter of common fonts without serifs is wider on the mean than 0.6 of its height.
        legend, title_width = (75 if small else 110), 0.6 * 14 * len(self.title)
        foot = 0 if small else dimensions_room
        self._legend_height = max(self._inner[1], 130 if small else 200)
        self.width = round(self._left + max(self._inner[0] + margin + legend, title_width + margin))
        self.height = round(title_height + self._legend_height + foot_height + foot)
        self.unit, self.per_unit = ("", 1) if small else ("mm", pixels_per_millimetre)
        self._numbers: list[Place] = []
        self._draw(grid, plane, plan)

    def _draw(self, grid: dict[str, Any], plane: dict[str, Any], plan: dict[str, Any]) -> None:
        scale, cells = self._scale, np.flatnonzero(~np.isnan(self._values))
        middles = self._middles(cells)
        self.cell = self._per_metre * self._size / (self._columns, self._rows)
        self.cells = [] if scale.contours in ("isolines", "bands") else [
            (x - self.cell[0] / 2, y - self.cell[1] / 2, scale.colour(self._values[cell]))
            for cell, (x, y) in zip(cells, middles)]
        self.labels: list[Label] = []
        if not self.small and len(self._values) <= most_numbered_cells:
            self._numbers = [(x, y) for x, y in middles]
            self.labels = [Label(x, y, 9, "normal", number(self._values[cell], 3))
                           for cell, (x, y) in zip(cells, middles)]
        self.bands = self._bands() if scale.contours == "bands" else []
        self.isolines = self._isolines() if scale.contours in ("cells", "isolines") else []
        self._surround(plan)
        self._cross(grid, plane)
        (x, y), (right, top) = self._at([[0, 0], self._size])
        self.frame = (x, top, right - x, y - top)
        self.corners = [] if self.small else self._coordinates(plane)
        self.dimensions = [] if self.small else self._dimensions(plan)
        self.ruler = self._ruler()
        self.legend = self._legend()

    def _at(self, metres: Any) -> Floats:
        """Pixels of positions in metres along u and v from the plane's corner."""
        places = (np.reshape(np.asarray(metres, float), (-1, 2)) + self._reach) * self._per_metre
        return np.column_stack([self._left + places[:, 0],
                                title_height + self._inner[1] - places[:, 1]])

    def _middles(self, cells: Any) -> Floats:
        cells = np.asarray(cells, int)
        places = np.column_stack([cells % self._columns, cells // self._columns]) + 0.5
        return self._at(places / (self._columns, self._rows) * self._size)

    def _lines_of(self, values: Floats, per_cell: int) -> Any:
        """Contours of values that lie on the middles of cells, in pixels."""
        rows, columns = values.shape
        x = (np.arange(columns) / per_cell + 0.5) / self._columns * self._size[0]
        y = (np.arange(rows) / per_cell + 0.5) / self._rows * self._size[1]
        places = self._at(np.column_stack([np.tile(x, rows), np.repeat(y, columns)]))
        return contourpy.contour_generator(
            places[:, 0].reshape(rows, columns), places[:, 1].reshape(rows, columns),
            values, name="serial", corner_mask=False, quad_as_tri=per_cell == 1,
            line_type=contourpy.LineType.Separate, fill_type=contourpy.FillType.OuterOffset)

    def _bands(self) -> list[tuple[str, str]]:
        """Colours and paths, with the levels numbered like isolines."""
        if min(self._columns, self._rows) < 2:
            return []
        found = []
        generator = self._lines_of(self._values.reshape(self._rows, self._columns), 1)
        for (low, high), level in zip(self._scale.bands(), self._scale.levels()):
            points, offsets = generator.filled(low, high)
            if not points:
                continue
            found.append((self._scale.colour(level), "".join(
                _path(one[begin:end], True) for one, starts in zip(points, offsets)
                for begin, end in zip(starts, starts[1:]))))
            self._number(np.vstack(points), level)
        return found

    def _isolines(self) -> list[tuple[str, str]]:
        """Colours and paths, at the steps of the standard or as in falsecolor."""
        known = self._values[~np.isnan(self._values)]
        if min(self._columns, self._rows) < 2 or not len(known):
            return []
        alone = self._scale.contours == "isolines"
        generator = self._lines_of(*refined(self._values.reshape(self._rows, self._columns)))
        found = []
        for level in self._scale.levels() if alone else illuminance_steps(min(known), max(known)):
            lines = generator.lines(level)
            if lines:
                found.append((self._scale.colour(level) if alone else "#000000",
                              "".join(map(_path, lines))))
                self._number(np.vstack([0.5 * (line[1:] + line[:-1]) for line in lines]), level)
        return found

    def _number(self, places: Floats, level: float) -> None:
        """Writes a level at the position that is farthest from other numbers, or far enough and nearest
        to the middle one; not at all where there is no room, since the legend has it."""
        if self.small:
            return
        far_enough, too_near = 30.0, 12.0
        room = np.full(len(places), far_enough)
        for x, y in self._numbers:
            room = np.minimum(room, np.hypot(places[:, 0] - x, places[:, 1] - y))
        away = np.abs(np.arange(len(places)) - len(places) // 2)
        best = int(np.lexsort((away, -room))[0])
        if room[best] < too_near:
            return
        x, y = places[best]
        self._numbers.append((x, y))
        self.labels.append(Label(x, y, 11, "bold", number(level, 3)))

    def _surround(self, plan: dict[str, Any]) -> None:
        """Walls and furniture are paths in metres, which the template moves to their place."""
        (x, y), = self._at([0, 0])
        self.transform = f"matrix({self._per_metre:.6g} 0 0 {-self._per_metre:.6g} {x:.2f} {y:.2f})"
        self.pixel = 1 / self._per_metre
        self.furniture, self.walls = plan.get("furniture", ""), plan.get("walls", "")
        self.lamps = [] if self.small else [
            (*self._at(lamp["position"])[0], int(lamp["number"])) for lamp in plan.get("lamps", [])]

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
        return [(x, y, anchor, "({:.2f}, {:.2f}, {:.2f}) m".format(*world)) for x, y, anchor, world in (
            (low[0], low[1] + (11 if self._reach else -4), "start", origin),
            (high[0], high[1] - 4, "end", origin + plane["u"] + plane["v"]))]

    def _dimensions(self, plan: dict[str, Any]) -> list[Dimension]:
        found = []
        bottom, right, tick = title_height + self._inner[1], self._left + self._inner[0], 3
        for row, corners in enumerate([[[0, 0], list(self._size)], plan.get("room")], 1):
            if not corners:
                continue
            (ax, ay), (bx, by) = self._at(corners)
            if ax < self._left - 1 or bx > right + 1 or by < title_height - 1 or ay > bottom + 1:
                continue  # beyond what is shown
            x, y = self._left - row * dimension_step, bottom + row * dimension_step
            found.append(Dimension(
                f"M{ax:.2f} {y:.2f}H{bx:.2f}M{ax:.2f} {y - tick:.2f}v{2 * tick}"
                f"M{bx:.2f} {y - tick:.2f}v{2 * tick}M{x:.2f} {ay:.2f}V{by:.2f}"
                f"M{x - tick:.2f} {ay:.2f}h{2 * tick}M{x - tick:.2f} {by:.2f}h{2 * tick}",
                ((ax + bx) / 2, y - 2, f"{(bx - ax) / self._per_metre:.2f}"),
                (x - 2, (ay + by) / 2, f"{(ay - by) / self._per_metre:.2f}")))
        return found

    def _ruler(self) -> tuple[float, float, float, str]:
        """A ruler of 1, 2 or 5 times a power of ten metres, at most a quarter of the plan's width."""
        most = self._inner[0] / self._per_metre / 4
        power = 10.0 ** math.floor(math.log10(most))
        metres = next(step * power for step in (5, 2, 1) if step * power <= most or step == 1)
        y = title_height + self._legend_height + 14 + (0 if self.small else dimensions_room)
        return self._left, self._left + metres * self._per_metre, y, f"{metres:g} m"

    def _legend(self) -> dict[str, Any]:
        bar, step = (14 if self.small else 22), self._legend_height / self._scale.steps
        x, bottom = self._left + self._inner[0] + margin, title_height + self._legend_height
        values = [self._scale.value_at((i + 0.5) / self._scale.steps) for i in range(self._scale.steps)]
        return {"label": self._scale.label, "x": x, "y": title_height - 7, "width": bar, "height": step,
                "bars": [(bottom - (i + 1) * step, self._scale.colour(value), number(value, 4))
                         for i, value in enumerate(values)]}


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
