"""Illuminance at points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .grids import Grid, cores_of
from .pictures import Changes, lights_asked
from .progress import Progress, heard_by
from .scenes import File, Scene

__all__ = ["Illuminance", "measure"]


@dataclass(frozen=True)
class Run:
    """What grids were measured with, for reports."""

    scene: Scene
    core: _photile.Measurement
    options: dict[str, Any]


@dataclass(frozen=True, repr=False)
class Illuminance:
    """Lux at points, with standard errors.

    Attributes
    ----------
    points, normals : (m, 3) arrays
        The points of measurement and their normals.
    lux, error : (m,) arrays
        Lux from all lights together, and its standard error; daylight factors are per cent.
    by_light, error_by_light : dicts of (m,) arrays
        The same for each light layer.
    statistics : dict of (value, standard error)
        Em, Emin and Emax in lux, Uo = Emin / Em and Ud = Emin / Emax.
    grid : Grid
        The grid of the points.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    lux: NDArray[np.float64]
    error: NDArray[np.float64]
    by_light: dict[str, NDArray[np.float64]]
    error_by_light: dict[str, NDArray[np.float64]]
    statistics: dict[str, tuple[float, float]]
    grid: Grid
    _run: Run

    def __len__(self) -> int:
        return len(self.lux)

    @property
    def unit(self) -> str:
        """"lx", or "%" of daylight factors."""
        return "%" if self._run.options["daylight_factor_ground"] is not None else "lx"

    def __repr__(self) -> str:
        span = f", {self.lux.min():.4g} to {self.lux.max():.4g} {self.unit}" if len(self) else ""
        return f"<photile.Illuminance: {len(self)} points{span}>"

    def columns(self) -> dict[str, NDArray[np.float64]]:
        """Columns of a table: ``pandas.DataFrame(measured.columns())``."""
        columns = {axis: self.points[:, i] for i, axis in enumerate("xyz")}
        return {**columns, "lux": self.lux, "error": self.error, **self.by_light}

    def map(self) -> NDArray[np.float64]:
        """(rows, columns) lux by cell of a plane, see `Grid.map`."""
        return self.grid.map(self.lux)


@overload
def measure(scene: Scene, points: Sequence[Grid], **options: Any) -> list[Illuminance]: ...
@overload
def measure(scene: Scene, points: Union[Grid, ArrayLike], normals: ArrayLike = ...,
            **options: Any) -> Illuminance: ...
def measure(
    scene: Scene,
    points: Union[Grid, Sequence[Grid], ArrayLike],
    normals: ArrayLike = (0.0, 1.0, 0.0),
    *,
    rays: int = 1024,
    repeats: int = 8,
    cylindrical: bool = False,
    daylight_factor: bool = False,
    target: str = "",
    light: Changes = None,
    mood: str = "",
    moods: Optional[File] = None,
    integrator: str = "photon-map",
    maintenance: float = 1.0,
    lumen_per_watt: float = _photile.lumen_per_watt,
    device: str = "",
    progress: Progress = None,
    **settings: Union[int, float, str],
) -> Union[Illuminance, list[Illuminance]]:
    """Illuminance at points in the air or on surfaces, as `photile measure` prints it.

    Parameters
    ----------
    scene : Scene
    points : Grid, sequence of Grid, or (m, 3) array
        Metres in the file's world. Several grids are measured together and share their photons, as those
        of the command.
    normals : (m, 3) or (3,) array
        The directions that the points of an array face, of any length; y is upwards in glTF files.
    rays : int
        Rays of each point and repeat.
    repeats : int
        At least 2: measurements with different random numbers, whose scatter gives the standard
        error.
    cylindrical : bool
        Cylindrical illuminance around the normals (EN 12464-1).
    daylight_factor : bool
        Per cent of the lux on open ground under the CIE overcast sky, in place of lux. Lamps are off, and
        the sky takes the place of the scene's.
    target : str
        Requirements as for `write_report`, whose default this is. Those of EN 1838 ("escape-route") are about
        direct light alone: nothing reflects, then.
    light, mood, moods
        As for `render`.
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
    Illuminance, or a list of those of several grids

    Raises
    ------
    InputError
        Arrays do not fit, or hold NaN or infinite numbers.
    UsageError
        Names the setting and its range; there is no such light, mood or target.
    """
    options = {
        "rays": rays,
        "repeats": repeats,
        "cylindrical": cylindrical,
        "integrator": integrator,
        "maintenance": maintenance,
        "lumen_per_watt": lumen_per_watt,
        "device": device,
        "portals": scene._portals,
        "target": target,
        "daylight_factor_ground": scene._ground if daylight_factor else None,
        **lights_asked(light, mood, moods),
    }
    grids, several = _grids_of(points, normals)
    with heard_by(progress) as heard:
        core = _photile.measure(scene._core, cores_of(grids), options, dict(settings), heard)
    run = Run(scene, core, {**options, **settings})
    measured = [_of_grid(run, number, grid) for number, grid in enumerate(grids)]
    return measured if several else measured[0]


def _grids_of(points: Any, normals: ArrayLike) -> tuple[list[Grid], bool]:
    """The grids, and whether they came as a sequence."""
    if isinstance(points, Grid):
        return [points], False
    if isinstance(points, Sequence) and any(isinstance(one, Grid) for one in points):
        return list(points), True
    return [Grid.of_points(points, normals)], False


def _of_grid(run: Run, number: int, grid: Grid) -> Illuminance:
    (_, total, error), *lights = run.core.values(number)
    return Illuminance(
        grid.points,
        grid.normals,
        total,
        error,
        {name: lux for name, lux, _ in lights},
        {name: error for name, _, error in lights},
        run.core.statistics(number),
        grid,
        run,
    )
