"""Illuminance at points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .errors import InputError, UsageError
from .scenes import Scene, floats, vector

__all__ = ["Illuminance", "grid", "measure"]


@dataclass(frozen=True, repr=False)
class Illuminance:
    """Lux at points, with standard errors.

    Attributes
    ----------
    points, normals : (m, 3) arrays
        The points of measurement and their normals.
    lux, error : (m,) arrays
        Lux from all lights together, and its standard error.
    by_light, error_by_light : dicts of (m,) arrays
        The same for each light layer.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    lux: NDArray[np.float64]
    error: NDArray[np.float64]
    by_light: dict[str, NDArray[np.float64]]
    error_by_light: dict[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.lux)

    def __repr__(self) -> str:
        span = f", {self.lux.min():.4g} to {self.lux.max():.4g} lx" if len(self) else ""
        return f"<photile.Illuminance: {len(self)} points{span}>"

    def columns(self) -> dict[str, NDArray[np.float64]]:
        """Columns of a table: ``pandas.DataFrame(measured.columns())``."""
        columns = {axis: self.points[:, i] for i, axis in enumerate("xyz")}
        return {**columns, "lux": self.lux, "error": self.error, **self.by_light}


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


def measure(
    scene: Scene,
    points: ArrayLike,
    normals: ArrayLike = (0.0, 1.0, 0.0),
    *,
    rays: int = 1024,
    repeats: int = 8,
    cylindrical: bool = False,
    integrator: str = "photon-map",
    maintenance: float = 1.0,
    lumen_per_watt: float = _photile.lumen_per_watt,
    device: str = "",
    progress: _photile.Callback = None,
    **settings: Union[int, float, str],
) -> Illuminance:
    """Illuminance at points in the air or on surfaces, as `photile measure` prints it.

    Parameters
    ----------
    scene : Scene
    points : (m, 3) array
        Metres in the file's world.
    normals : (m, 3) or (3,) array
        The directions that the points face, of any length; y is upwards in glTF files.
    rays : int
        Rays of each point and repeat.
    repeats : int
        At least 2: measurements with different random numbers, whose scatter gives the standard
        error.
    cylindrical : bool
        Cylindrical illuminance around the normals (EN 12464-1).
    integrator : {"photon-map", "path"}
        Paths are unbiased and need no OpenCL device.
    maintenance : float
        Factor of all values, for ageing and dirt.
    lumen_per_watt : float
        The factor between watts and lumens.
    device, progress
        As for `render`.
    **settings
        Settings by their names in ``photile.SETTINGS``, such as ``photons_emitted=200_000``.

    Returns
    -------
    Illuminance

    Raises
    ------
    InputError
        Arrays do not fit, or hold NaN or infinite numbers.
    UsageError
        Names the setting and its range.
    """
    where = floats(points, "points", np.float64)
    if where.ndim != 2 or where.shape[1] != 3:
        raise InputError(f"points: the array has shape {where.shape}; it must have shape (m, 3)")
    if not np.all(np.isfinite(where)):
        row = int(np.argmin(np.all(np.isfinite(where), axis=1)))
        raise InputError(f"points: point {row} is NaN or infinite")
    facing = floats(normals, "normals", np.float64)
    if facing.shape == (3,):
        facing = np.broadcast_to(facing, where.shape)
    facing = np.ascontiguousarray(facing)
    found = _photile.measure(
        scene._core,
        where,
        facing,
        {
            "rays": rays,
            "repeats": repeats,
            "cylindrical": cylindrical,
            "integrator": integrator,
            "maintenance": maintenance,
            "lumen_per_watt": lumen_per_watt,
            "device": device,
        },
        dict(settings),
        progress,
    )
    total, lights = found[0], found[1:]
    return Illuminance(
        where,
        facing,
        total[1],
        total[2],
        {name: lux for name, lux, _ in lights},
        {name: error for name, _, error in lights},
    )
