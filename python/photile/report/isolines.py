"""Isolines of the values of a plane's cells, and where numbers are written along them."""

from __future__ import annotations

import math
from typing import Any

import contourpy
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

most_cells = 4_000_000


def on_cells(plane: dict[str, Any], values: list[float | None]) -> Floats:
    """The values at a plane's sensors by its cells, rows by columns; NaN where it has none.

    Raises ValueError where the plane has no cells, or too many.
    """
    columns, rows = int(plane["columns"]), int(plane["rows"])
    if not (min(columns, rows) > 0 and columns * rows <= most_cells):
        raise ValueError("a plane has no cells or too many")
    found: Floats = np.full(columns * rows, np.nan)
    found[plane["cells"]] = np.array(values, float)
    return found.reshape(rows, columns)


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


class Contours:
    """Lines and areas of values, rows by columns with NaN where there is none, at the middles of the
    cells of a plane; both counts are at least 2.

    size   metres of the plane along its columns and rows
    """

    def __init__(self, values: Floats, size: Floats, smooth: bool = True) -> None:
        rows, columns = values.shape
        values, per_cell = refined(values) if smooth else (values, 1)
        x = (np.arange(values.shape[1]) / per_cell + 0.5) / columns * size[0]
        y = (np.arange(values.shape[0]) / per_cell + 0.5) / rows * size[1]
        self._generator: Any = contourpy.contour_generator(
            x, y, values, name="serial", corner_mask=False, quad_as_tri=not smooth,
            line_type=contourpy.LineType.Separate, fill_type=contourpy.FillType.OuterOffset)

    def lines(self, level: float) -> list[Floats]:
        """Metres along the columns and the rows from the plane's corner; a closed line ends where it
        begins."""
        return list(self._generator.lines(level))

    def areas(self, low: float, high: float) -> list[list[Floats]]:
        """The outlines of each area between two levels, the outer one first."""
        points, offsets = self._generator.filled(low, high)
        return [[one[begin:end] for begin, end in zip(starts, starts[1:])]
                for one, starts in zip(points, offsets)]


class Writing:
    """Where a drawing has texts, as rows of discs that cover them, so that others keep clear of them.
    Any unit of length."""

    def __init__(self) -> None:
        self._discs: list[Floats] = []

    @staticmethod
    def _covering(x: Any, y: Any, angle: Any, width: float, height: float) -> Floats:
        """Discs of texts around positions, [text][disc][x, y, radius]; angles in radians."""
        radius = 0.55 * height
        reach = max(0.5 * width - radius, 0.0)
        along = np.linspace(-reach, reach, 1 + math.ceil(reach / radius))
        return np.stack([x + np.outer(np.cos(angle), along), y + np.outer(np.sin(angle), along),
                         np.full((len(angle), len(along)), radius)], axis=2)

    def clearance(self, places: Floats, angles: Floats, width: float, height: float) -> Floats:
        """The distance of a text to the nearest other at each of several places [place][x, y]: negative
        where they overlap, infinite where there is none within a few heights of all places."""
        if not self._discs:
            return np.full(len(places), math.inf)
        self._discs = [np.vstack(self._discs)]
        near = width + 3 * height
        others = self._discs[0][np.all((self._discs[0][:, :2] > places.min(axis=0) - near)
                                       & (self._discs[0][:, :2] < places.max(axis=0) + near), axis=1)]
        discs = self._covering(places[:, :1], places[:, 1:], angles, width, height)
        apart = np.hypot(*(discs[:, :, None, :2] - others[:, :2]).transpose(3, 0, 1, 2))
        nearest: Floats = (apart - discs[:, :, None, 2] - others[:, 2]).min(axis=(1, 2), initial=math.inf)
        return nearest

    def add(self, place: Any, angle: float, width: float, height: float) -> None:
        self._discs.append(self._covering(place[0], place[1], np.array([angle]), width, height)[0])


def upright(angle: Any) -> Any:
    """The angle, radians, by whole half turns within a quarter turn from 0: a text along it can be read."""
    return angle - math.pi * np.ceil(angle / math.pi - 0.5)


def _candidates(line: Floats, width: float, most: int) -> tuple[Floats, Floats, Floats]:
    """Middles, angles and bends of chords of about `width` along a line, whose ends lie on it. A bend is
    the distance of the chord's middle from the line's."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    middles = np.linspace(0.5 * width, lengths[-1] - 0.5 * width, most)

    def at(lengths_along: Floats) -> Floats:
        return np.column_stack([np.interp(lengths_along, lengths, line[:, axis]) for axis in (0, 1)])

    begin, middle, end = at(middles - 0.5 * width), at(middles), at(middles + 0.5 * width)
    chord = end - begin
    return middle, upright(np.arctan2(chord[:, 1], chord[:, 0])), np.hypot(*(0.5 * (begin + end) - middle).T)


def place_numbers(line: Floats, width: float, height: float, writing: Writing,
                  apart: float) -> list[tuple[float, float, float]]:
    """Places for the number of an isoline, x, y and the angle of a text along it, in the units of the
    line; none where there is no room. They become part of the writing.

    width, height   of the number
    apart           length of line that has one number
    """
    length = float(np.sum(np.hypot(*np.diff(line, axis=0).T)))
    if length < 2 * width:
        return []
    found = []
    parts = max(round(length / apart), 1)
    middles, angles, bends = _candidates(line, width, 24 * parts)
    for part in range(parts):
        here = slice(24 * part, 24 * (part + 1))
        places, turned = middles[here], angles[here]
        room = np.minimum(writing.clearance(places, turned, width, height), 2 * height)
        # A straight stretch with room, near the middle of the part.
        off_middle = np.abs(np.arange(24) - 11.5) / 24
        worth = room / height - 4 * bends[here] / height - off_middle
        best = int(np.argmax(np.where((room > 0.2 * height) & (bends[here] < 0.3 * height), worth, -math.inf)))
        if room[best] > 0.2 * height and bends[here][best] < 0.3 * height:
            found.append((float(places[best, 0]), float(places[best, 1]), float(turned[best])))
            writing.add(places[best], found[-1][2], width, height)
    return found
