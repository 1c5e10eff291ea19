"""Floors of rooms in plan: the outline of a room's body, and the largest rectangle in an outline.

Needs shapely, which ifcopenshell brings. Plans are in metres, x to the right and y ahead.
"""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

shapely: Any = importlib.import_module("shapely")  # has no types

__all__ = ["Rectangle", "floor_of", "inset", "largest_rectangle"]

_grid = 1e-3  # metres that corners are rounded to, so that triangles of one floor meet
_level = 0.01  # metres within which faces are at one height
_least_side = 0.1  # metres
_most_lines = 40  # along a side, of the cells of which rectangles are made


@dataclass(frozen=True)
class Rectangle:
    """A rectangle in plan: a corner and two sides, u turned to v by a right angle to the left."""

    origin: NDArray[np.float64]
    u: NDArray[np.float64]
    v: NDArray[np.float64]

    @property
    def area(self) -> float:
        return float(np.linalg.norm(self.u) * np.linalg.norm(self.v))

    @property
    def middle(self) -> NDArray[np.float64]:
        return self.origin + (self.u + self.v) / 2


def floor_of(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> tuple[Any, float] | None:
    """The outline of a body in plan, a polygon with the holes of columns and shafts, and the height of
    its floor: of the lowest horizontal faces that cover half of the outline. None without an area.

    vertices   (n, 3), z upwards; triangles (m, 3)
    """
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    level = np.abs(normals[:, 2]) > 0.99 * np.linalg.norm(normals, axis=1)
    seen = np.abs(normals[:, 2]) > _grid**2
    shadows = shapely.polygons(corners[seen][:, :, :2])
    outline = shapely.union_all(shadows, grid_size=_grid)
    parts = [part for part in shapely.get_parts(outline) if part.geom_type == "Polygon"]
    if not parts:
        return None
    polygon = max(parts, key=lambda part: float(part.area)).simplify(2 * _grid)
    heights = np.round(corners[level & seen][:, :, 2].mean(axis=1) / _level).astype(int)
    areas = np.abs(normals[level & seen][:, 2])
    for height in np.unique(heights):
        if areas[heights == height].sum() >= polygon.area / 2:
            at = corners[level & seen][heights == height][:, :, 2]
            return polygon, float(at.mean())
    return polygon, float(vertices[:, 2].min())


def inset(polygon: Any, band: float) -> Any:
    """The largest part of a polygon without a band in metres along its border, or None."""
    parts = shapely.get_parts(polygon.buffer(-band, join_style="mitre"))
    return max((part for part in parts if not part.is_empty), key=lambda part: float(part.area), default=None)


def _direction(polygon: Any) -> float:
    """Radians, from -pi/4 to pi/4, to which most of the outline's length is parallel or at a right
    angle."""
    sides = np.diff(np.asarray(polygon.exterior.coords), axis=0)
    lengths = np.linalg.norm(sides, axis=1)
    quarter = math.pi / 2
    angles = (np.arctan2(sides[:, 1], sides[:, 0]) + quarter / 2) % quarter - quarter / 2
    near = np.abs((angles[:, None] - angles + quarter / 2) % quarter - quarter / 2) < 0.01
    return float(angles[np.argmax(near @ lengths)])


def _lines(values: NDArray[np.float64], slanted: bool) -> NDArray[np.float64]:
    """Positions of the sides that rectangles may have along one axis: the corners', and where sides
    are slanted also even ones."""
    corners: NDArray[np.float64] = np.unique(np.round(values / _grid)) * _grid
    if slanted or len(corners) > _most_lines:
        even = np.linspace(values.min(), values.max(), _most_lines // 2)
        step = -(-len(corners) // (_most_lines // 2))
        corners = np.unique(np.concatenate([corners[::step], even, corners[-1:]]))
    return corners


def largest_rectangle(polygon: Any) -> Rectangle | None:
    """The largest rectangle in a polygon whose sides are parallel to most of the polygon's. None where
    there is none of 0.1 m.

    Of rectangles whose sides pass through corners; where other sides are slanted, through lines of an
    even lattice, too, so that it may be somewhat smaller than the largest.
    """
    angle = _direction(polygon)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    turned = shapely.transform(polygon, lambda points: np.asarray(points @ turn))
    points = shapely.get_coordinates(turned)
    sides = np.abs(np.diff(points, axis=0))
    slanted = bool(np.any(sides.min(axis=1) > 0.01 * sides.max(axis=1)))
    x, y = (_lines(points[:, axis], slanted) for axis in (0, 1))
    cells = shapely.box(x[None, :-1], y[:-1, None], x[None, 1:], y[1:, None])
    room = turned.buffer(2 * _grid, join_style="mitre")  # sides on the border count as inside
    shapely.prepare(room)
    inside = shapely.covers(room, cells)
    best, found = 0.0, None
    for left in range(len(x) - 1):
        free = np.ones(len(y) - 1, bool)
        for right in range(left + 1, len(x)):
            free &= inside[:, right - 1]
            if not free.any():
                break
            bounds = np.flatnonzero(np.diff(np.concatenate([[False], free, [False]]).astype(int)))
            for low, high in zip(bounds[::2], bounds[1::2]):
                width, height = x[right] - x[left], y[high] - y[low]
                if width * height > best and min(width, height) >= _least_side:
                    best, found = width * height, (x[left], y[low], width, height)
    if found is None:
        return None
    left, low, width, height = found
    return Rectangle(turn @ [left, low], width * turn[:, 0], height * turn[:, 1])
