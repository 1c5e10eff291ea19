"""Grids of points: of arrays, over the floors of rooms, on their walls and ceilings, of files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .errors import InputError, UsageError
from .progress import Progress, heard_by
from .scenes import File, Scene, Vector, floats, vector

__all__ = ["Grid", "grid", "grids", "rooms"]


class Grid:
    """Points that are measured together; `grids` makes them."""

    def __init__(self, core: _photile.Grid, of_room: bool = False) -> None:
        self._core = core
        self._of_room = of_room  # whether it is named after one

    @classmethod
    def of_points(cls, points: ArrayLike, normals: ArrayLike = (0.0, 1.0, 0.0), name: str = "points") -> Grid:
        """A grid of points in an array.

        Parameters
        ----------
        points : (m, 3) array
            Metres in the file's world.
        normals : (m, 3) or (3,) array
            The directions that the points face, of any length.
        name : str
            For reports.
        """
        where = floats(points, "points", np.float64)
        if where.ndim != 2 or where.shape[1] != 3:
            raise InputError(f"points: the array has shape {where.shape}; it must have shape (m, 3)")
        if not np.all(np.isfinite(where)):
            row = int(np.argmin(np.all(np.isfinite(where), axis=1)))
            raise InputError(f"points: point {row} is NaN or infinite")
        facing = floats(normals, "normals", np.float64)
        if facing.shape == (3,):
            facing = np.ascontiguousarray(np.broadcast_to(facing, where.shape))
        return cls(_photile.grid_of_points(name, where, facing))

    @property
    def name(self) -> str:
        """The name that reports print."""
        return self._core.name

    @property
    def role(self) -> str:
        """"task", "surroundings", "background", "wall", "ceiling", "cylindrical" or "other"."""
        return self._core.role

    @property
    def points(self) -> NDArray[np.float64]:
        """(m, 3) metres in the file's world."""
        return self._core.points

    @property
    def normals(self) -> NDArray[np.float64]:
        """(m, 3) unit vectors: the directions that the points face, or the axes of cylinders."""
        return self._core.normals

    @property
    def plane(self) -> Optional[dict[str, Any]]:
        """The rectangle of its cells: origin, u, v, columns, rows, and the cell of each point; None
        where it is no plane."""
        return self._core.plane

    @property
    def left_out(self) -> list[tuple[Vector, str]]:
        """The points that are not measured, and why: those in furniture, and those too near to it."""
        return self._core.left_out

    @property
    def marks(self) -> list[str]:
        """For each point why its value is doubtful, "" where it is not; empty where none is."""
        return self._core.marks

    def map(self, values: ArrayLike) -> NDArray[np.float64]:
        """Values of the points by cell, as ``matplotlib.pyplot.imshow(..., origin="lower")`` takes them.

        Parameters
        ----------
        values : (m,) array
            Such as `Illuminance.lux`.

        Returns
        -------
        (rows, columns) array
            NaN in cells without a point.

        Raises
        ------
        UsageError
            The grid is no plane.
        """
        plane, numbers = self.plane, floats(values, "values", np.float64)
        if plane is None:
            raise UsageError(f"{self.name}: the grid is no plane; it has no map")
        if numbers.shape != (len(plane["cells"]),):
            raise InputError(f"values: the array has shape {numbers.shape}; it must have shape "
                             f"({len(plane['cells'])},)")
        cells = np.full(plane["rows"] * plane["columns"], np.nan)
        cells[plane["cells"]] = numbers
        return cells.reshape(plane["rows"], plane["columns"])

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        left_out = f", and {len(self.left_out)} left out" if self.left_out else ""
        return f"<photile.Grid: {self.name}, {len(self)} points{left_out}>"


def cores_of(grids: Union[Grid, Iterable[Grid]]) -> list[_photile.Grid]:
    """Raises UsageError for what is no grid, and where there is none."""
    all_grids = [grids] if isinstance(grids, Grid) else list(grids)
    for one in all_grids:
        if not isinstance(one, Grid):
            raise UsageError(f"grids: {one!r} is not a photile.Grid; photile.grids makes some")
    if not all_grids:
        raise UsageError("grids: there is none; photile.grids makes some")
    return [one._core for one in all_grids]


def _files(files: Union[File, Sequence[File]]) -> list[str]:
    return [os.fspath(file) for file in ([files] if isinstance(files, (str, os.PathLike)) else files)]


def grids(
    scene: Scene,
    plane: Union[str, float] = "",
    *,
    walls: bool = False,
    ceiling: bool = False,
    cylindrical_at: Union[str, float] = "",
    semi_cylindrical_at: Union[str, float] = "",
    grid: Union[File, Sequence[File]] = (),
    points: Union[File, Sequence[File]] = (),
    inside: Optional[ArrayLike] = None,
    rooms: str = "",
    wall_band: float = _photile.wall_band,
    spacing: float = 0.0,
    clearance: float = 0.0,
    progress: Progress = None,
) -> list[Grid]:
    """The grids of `photile measure`, by the names of its options.

    Parameters
    ----------
    scene : Scene
        With y upwards, as after `load`.
    plane : str or float
        A grid of EN 12464-1 over the floor: "floor+0.75", or a height in metres.
    walls, ceiling : bool
        A grid on each wall of the room, on its ceiling.
    cylindrical_at, semi_cylindrical_at : str or float
        Cylindrical illuminance at this height, semi-cylindrical towards four sides.
    grid, points : paths
        Planes as JSON; points in the format of Radiance.
    inside : (3,) floats, optional
        A point in the room, metres; by default it is the room of the first camera.
    rooms : str
        A pattern of the names that `rooms` lists, "*" for all: each has its own grids, whose names
        begin with its own.
    wall_band : float
        Metres that are left out along the walls.
    spacing : float
        Metres between points; 0 is that of EN 12464-1.
    clearance : float
        Metres from furniture. Points inside it are always left out.
    progress : callable or True, optional
        See `render`; here it only serves to notice Ctrl-C.

    Returns
    -------
    list of Grid
        Files first, then in the order of the parameters.

    Raises
    ------
    InputError
        There is no floor or no room with a ceiling, or a file is malformed.
    UsageError
        A height or a length is none, the point is in no room, no room has the name, or no point
        is left.
    """
    options: dict[str, Any] = {
        "plane": str(plane),
        "walls": walls,
        "ceiling": ceiling,
        "cylindrical_at": str(cylindrical_at),
        "semi_cylindrical_at": str(semi_cylindrical_at),
        "grid": _files(grid),
        "points": _files(points),
        "inside": None if inside is None else vector(inside, "inside"),
        "rooms": rooms,
        "wall_band": wall_band,
        "spacing": spacing,
        "clearance": clearance,
        "north": scene._north,
    }
    with heard_by(progress) as heard:
        found = _photile.grids(scene._core, options, heard)
    if not found:
        raise UsageError("grids: nothing is asked for; give plane='floor+0.75', or another of the places")
    return [Grid(core, bool(rooms)) for core in found]


def rooms(scene: Scene) -> list[dict[str, Any]]:
    """The rooms of a scene, as `photile info` lists them.

    Those of the file NAME.rooms.json beside it, which `photile import` writes; where there is none,
    those around its cameras and others with walls on all sides, 100 at most.

    Returns
    -------
    list of dict
        Of each its name; area, m2; height, and floor, the height of its floor, metres; inside, (3,)
        metres, a point in it; outline, the corners of its floor, and holes, those of what stands in
        it; and more that the file has.
    """
    return _photile.rooms(scene._core)


def grid(
    corner: ArrayLike, along: ArrayLike, across: ArrayLike, columns: int, rows: int
) -> NDArray[np.float64]:
    """The centres of the equal cells of a rectangle.

    Parameters
    ----------
    corner : (3,) floats
        Metres.
    along, across : (3,) floats
        The sides of the rectangle, metres.
    columns, rows : int
        Cells along the first and the second side.

    Returns
    -------
    (rows * columns, 3) array
        Metres, row by row.
    """
    for name, count in (("columns", columns), ("rows", rows)):
        if not isinstance(count, (int, np.integer)) or count < 1:
            raise UsageError(f"{name}: {count!r} is not a whole number above 0")
    u, v = (np.arange(count) + 0.5 for count in (columns, rows))
    places = np.stack(np.meshgrid(u / columns, v / rows), axis=-1).reshape(-1, 2)
    sides = np.array([vector(along, "along"), vector(across, "across")])
    middles: NDArray[np.float64] = vector(corner, "corner") + places @ sides
    return middles
