"""Floors of rooms in plan: sections of a room's body, and the largest rectangle in an outline.

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

__all__ = ["Rectangle", "between", "floor_height", "inset", "largest_rectangle", "one_ring", "section", "shadow_of",
           "without_voids"]

_grid = 1e-3  # metres that corners are rounded to, so that triangles of one floor meet
_level = 0.01  # metres within which faces are at one height
_least_side = 0.1  # metres
_least_void = 0.5  # metres across what is missing of a floor
_down = np.array([1.0, 1.0, -1.0])  # turns heights into depths
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

    @property
    def spacing(self) -> float:
        """Metres between points of a grid, as EN 12464-1 has it (points_of_en12464 of sensor_grid.hpp)."""
        shorter, longer = sorted(np.linalg.norm([self.u, self.v], axis=1))
        side = shorter if longer >= 2 * shorter else longer
        return float(min(10.0, 0.2 * 5 ** math.log10(side)))

    @property
    def _axes(self) -> NDArray[np.float64]:
        return np.array([side / np.linalg.norm(side) for side in (self.u, self.v)])

    def coordinates(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of points (n, 2): metres from the origin along u and along v, (n, 2)."""
        return np.asarray((points - self.origin) @ self._axes.T)

    def around(self, points: NDArray[np.float64]) -> Rectangle:
        """The rectangle around points (n, 2) whose sides are parallel to those of this one."""
        axes, own = self._axes, self.coordinates(points)
        low, high = own.min(axis=0), own.max(axis=0)
        return Rectangle(self.origin + low @ axes, (high - low)[0] * axes[0], (high - low)[1] * axes[1])


def _shadow(corners: NDArray[np.float64]) -> Any:
    """The union of what triangles (m, 3, 3) cover in plan; those that are upright cover nothing."""
    seen = np.abs(_normals(corners)[:, 2]) > _grid**2
    union = shapely.union_all(shapely.polygons(corners[seen][:, :, :2]), grid_size=_grid)
    # Where a corner of one triangle is on the side of others, rounding opens a crack.
    return union.buffer(2 * _grid, join_style="mitre").buffer(-2 * _grid, join_style="mitre")


def _normals(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of triangles (m, 3, 3), as long as they are large."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2


def _above(corners: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    """The parts of triangles (m, 3, 3) above a height, as triangles."""
    over = corners[:, :, 2] >= height
    parts = [*corners[over.all(axis=1)]]
    for triangle in corners[over.any(axis=1) & ~over.all(axis=1)]:
        part = []
        for begin, end in zip(triangle, np.roll(triangle, -1, axis=0)):
            if begin[2] >= height:
                part.append(begin)
            if (begin[2] >= height) != (end[2] >= height):
                part.append(begin + (height - begin[2]) / (end[2] - begin[2]) * (end - begin))
        parts += [[part[0], *others] for others in zip(part[1:], part[2:])]
    return np.reshape(np.array(parts, float), (-1, 3, 3))


def between(corners: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    """The parts of triangles (m, 3, 3) between two heights, as triangles."""
    return np.asarray(_above(_above(corners, low) * _down, -high) * _down)


def _largest(geometry: Any) -> Any:
    """The largest polygon of a geometry, or None."""
    parts = [part for part in shapely.get_parts(geometry) if part.geom_type == "Polygon" and not part.is_empty]
    return max(parts, key=lambda part: float(part.area), default=None)


def shadow_of(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Any:
    """The polygon that a body covers in plan, or None.

    vertices   (n, 3), z upwards; triangles (m, 3)
    """
    shadow = _largest(_shadow(vertices[triangles]))
    return None if shadow is None else shadow.simplify(2 * _grid)


def floor_height(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> float:
    """Of a body's lowest horizontal faces that cover half of its shadow; where none do, of its lowest
    corner."""
    corners = vertices[triangles]
    normals = _normals(corners)
    level = np.abs(normals[:, 2]) > np.maximum(0.99 * np.linalg.norm(normals, axis=1), _grid**2)
    heights = np.round(corners[level][:, :, 2].mean(axis=1) / _level).astype(int)
    areas = np.abs(normals[level, 2])
    for height in np.unique(heights):
        if areas[heights == height].sum() >= _shadow(corners).area / 2:
            return float(corners[level][heights == height][:, :, 2].mean())
    return float(vertices[:, 2].min())


def section(vertices: NDArray[np.float64], triangles: NDArray[np.int32], height: float) -> Any:
    """The largest polygon of a horizontal section through a body, with the holes of columns and shafts,
    or None: where it has something both above and below. A sloped ceiling ends it."""
    corners = vertices[triangles]
    both = _shadow(_above(corners, height)).intersection(_shadow(_above(corners * _down, -height)),
                                                         grid_size=_grid)
    found = _largest(both)
    return None if found is None else found.simplify(2 * _grid)


def without_voids(polygon: Any, floors: NDArray[np.float64]) -> Any:
    """A polygon without the voids in the floor below it that are at least 0.5 m wide, such as that
    beside a gallery. It stays as it is where less than half of the floor is there: then it is not
    modelled.

    floors   triangles (m, 3, 3)
    """
    missing = polygon.difference(_shadow(floors), grid_size=_grid)
    voids = missing.buffer(-_least_void / 2, join_style="mitre").buffer(_least_void / 2, join_style="mitre")
    if voids.is_empty or voids.area > polygon.area / 2:
        return polygon
    return _largest(polygon.difference(voids, grid_size=_grid)).simplify(2 * _grid)


def inset(polygon: Any, band: float) -> Any:
    """What is left of a polygon without a band in metres along its border: polygons, or nothing."""
    return polygon.buffer(-band, join_style="mitre")


def one_ring(polygons: Any) -> NDArray[np.float64]:
    """The corners, (n, 2), of one polygon by the even-odd rule: all rings of polygons in turn, with ways to and
    from the first ring that are walked twice and so bound nothing."""
    first, *rings = (np.asarray(ring.coords)[:, :2] for part in shapely.get_parts(polygons)
                     for ring in (part.exterior, *part.interiors))
    return np.concatenate([first, *(way for ring in rings for way in (ring, first[:1]))])


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


def largest_rectangle(polygons: Any) -> Rectangle | None:
    """The largest rectangle in the largest of polygons whose sides are parallel to most of the polygon's. None where
    there is none of 0.1 m.

    Of rectangles whose sides pass through corners; where other sides are slanted, through lines of an
    even lattice, too, so that it may be somewhat smaller than the largest.
    """
    polygon = _largest(polygons)
    if polygon is None:
        return None
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
