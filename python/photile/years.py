"""A year of daylight."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _photile
from .errors import UsageError
from .grids import Grid, cores_of
from .pictures import Changes, lights_asked
from .progress import Progress, heard_by
from .scenes import File, Scene, joined, number, shares, stated

__all__ = ["Daylight", "daylight"]


@dataclass(frozen=True, repr=False)
class Daylight:
    """A year of daylight at the points of a grid. Fractions are of the occupied hours.

    Attributes
    ----------
    grid : Grid
    lux : (m, hours) array
        Of each point in each hour of the weather file, by the schedule of the blinds.
    sun : (m, hours) array or None
        The lux straight from the sun, without blinds; None where the sun is patches.
    hours : (hours,) array of datetime64
        The middles of the hours, standard time, in a year without 29 February unless the file has it.
    occupied : (hours,) array of bool
        The hours that count.
    autonomy, continuous_autonomy : (m,) arrays
        DA and cDA: the fractions with the requested lux, and with less as lux over requested lux.
    useful : (m, 4) array
        UDI: below 100 lux, to 300, to 3000, above.
    sun_hours : (m,) array
        Occupied hours with more than 1000 lux straight from the sun.
    figures : dict
        All that `photile daylight` writes to JSON of the grid: DA, sDA, ASE, UDI, EN 17037, with
        several rounds their standard errors, with `lamps_to` the energy of lamps.
    """

    grid: Grid
    lux: NDArray[np.float32]
    sun: Optional[NDArray[np.float32]]
    hours: NDArray[np.datetime64]
    occupied: NDArray[np.bool_]
    autonomy: NDArray[np.float64]
    continuous_autonomy: NDArray[np.float64]
    useful: NDArray[np.float64]
    sun_hours: NDArray[np.float64]
    figures: dict[str, Any]
    _facts: dict[str, Any]
    """What a report of the year alone states beside it."""

    @property
    def spatial_autonomy(self) -> float:
        """sDA: the fraction of points with the requested lux in half of the occupied hours (IES LM-83)."""
        return float(self.figures["sDA"])

    @property
    def sunlight_exposure(self) -> float:
        """ASE: the fraction of points with 250 hours of sun above 1000 lux; NaN where the sun is patches."""
        return float(self.figures.get("ASE", np.nan))

    def __len__(self) -> int:
        return len(self.autonomy)

    def __repr__(self) -> str:
        return (f"<photile.Daylight: {self.grid.name}, {len(self)} points, DA {self.figures['DA']:.1%}, "
                f"sDA {self.spatial_autonomy:.1%}>")


def daylight(
    scene: Scene,
    grids: Union[Grid, Sequence[Grid]],
    weather: File,
    *,
    site: Optional[tuple[float, float, float]] = None,
    patches: int = 577,
    suns: str = "rays",
    ground: float = 0.2,
    lux: float = 300.0,
    occupied: str = "8-18",
    days: str = "mon-sun",
    schedule: Optional[File] = None,
    blinds: Union[None, Scene, Mapping[str, float]] = None,
    lamps_to: Optional[float] = None,
    lamp_efficacy: float = 100.0,
    light: Changes = None,
    mood: str = "",
    moods: Optional[File] = None,
    rays: int = 256,
    repeats: int = 4,
    rounds: int = 1,
    maintenance: float = 1.0,
    lumen_per_watt: float = _photile.lumen_per_watt,
    device: str = "",
    progress: Progress = None,
    **settings: Union[int, float, str],
) -> list[Daylight]:
    """Assess a year of daylight at the points of grids, as `photile daylight` does.

    Parameters
    ----------
    scene : Scene
        Its sun and sky do not count, its lamps only for `lamps_to`.
    grids : Grid or sequence of Grid
        As `grids` returns them.
    weather : path
        An EnergyPlus weather file (.epw).
    site : (latitude, longitude, time zone), optional
        By default that of the weather file.
    patches : {145, 577, 2305}
        Of the sky.
    suns : {"rays", "patches"}
        Rays from each point to the sun, or its light as that of the nearest patches.
    ground : float
        Reflectance of the ground around the scene.
    lux : float
        The illuminance that daylight has to provide.
    occupied, days : str
        Hours of the day, standard time, and days of the week: "8-18", "mon-fri".
    schedule : path, optional
        A value for each hour of the year, occupied if above 0, in place of both.
    blinds : Scene, or mapping of patterns of material names to transmittances, optional
        The scene with closed blinds, or panes behind closed blinds. They close when the sun shines in.
    lamps_to : float, optional
        Mean lux of a grid that the scene's lamps, dimmed together, maintain: `Daylight.figures` has the
        energy of each, its watts and kilowatt hours.
    lamp_efficacy : float
        lm/W of lamps whose photometric files state no power.
    light, mood, moods, rays, repeats, maintenance, lumen_per_watt, device
        As for `measure`.
    rounds : int
        Of independent rays; with several, results have standard errors.
    progress : callable or True, optional
        See `render`.
    **settings
        As for `measure`, such as ``seed=7``.

    Returns
    -------
    list of Daylight
        That of each grid.

    Raises
    ------
    InputError
        Names the weather file or the schedule, its line and the remedy.
    UsageError
        Names the parameter and its range.
    """
    if patches not in (145, 577, 2305):
        raise UsageError(f"patches: {patches!r} is not one of 145, 577, 2305")
    if suns not in ("rays", "patches"):
        raise UsageError(f"suns: {suns!r} is not one of rays, patches")
    if blinds is not None and suns == "patches":
        raise UsageError("blinds need rays to the sun; leave out suns='patches'")
    if not isinstance(rounds, (int, np.integer)) or rounds < 1:
        raise UsageError(f"rounds: {rounds!r} is not a whole number above 0")
    if not 0 <= number(ground, "ground") <= 1:
        raise UsageError(f"ground: {ground!r} is not a reflectance from 0 to 1")
    for name, value in (("lux", lux), ("lamps_to", 1 if lamps_to is None else lamps_to),
                        ("lamp_efficacy", lamp_efficacy)):
        if not 0 < number(value, name) < np.inf:
            raise UsageError(f"{name}: {value!r} is not a number above 0")
    all_grids = [grids] if isinstance(grids, Grid) else list(grids)
    options = {
        "weather": os.fspath(weather),
        "site": joined(site, ",") if site is not None else "",
        "patches": patches,
        "suns": suns,
        "ground": ground,
        "lux": lux,
        "occupied": occupied,
        "days": days,
        "schedule": os.fspath(schedule) if schedule is not None else "",
        "blinds": shares(None if isinstance(blinds, Scene) else blinds),
        "rays": rays,
        "repeats": repeats,
        "rounds": int(rounds),
        "maintenance": maintenance,
        "north": scene._north,
        "portals": scene._portals,
        "lamps_to": lamps_to or 0,
        "lamp_efficacy": lamp_efficacy,
        "lumen_per_watt": lumen_per_watt,
        "device": device,
        **lights_asked(light, mood, moods),
    }
    closed = blinds._core if isinstance(blinds, Scene) else None
    with heard_by(progress) as heard:
        found, (months, numbers, middles, counted) = _photile.daylight(
            scene._core, cores_of(all_grids), options, closed, dict(settings), heard)
    for grid, (figures, _, _) in zip(all_grids, found):
        if grid.plane is not None:
            figures["plan"] = _photile.plan(scene._core, grid._core, scene._north)
    year = 2004 if (2, 29) in zip(months, numbers) else 2005
    starts = np.array([f"{year}-{month:02}-{day:02}" for month, day in zip(months, numbers)], "datetime64[m]")
    times = starts + np.round(60 * np.array(middles)).astype("timedelta64[m]")
    facts = {**stated(scene, settings), "weather": os.path.basename(weather), "patches": patches,
             "ground_reflectance": ground, "repeats": int(rounds) * repeats, "rays": rays,
             "maintenance_factor": maintenance}
    return [_of_grid(grid, *of_grid, times, np.array(counted), facts) for grid, of_grid in zip(all_grids, found)]


def _of_grid(grid: Grid, figures: dict[str, Any], lux: NDArray[np.float32], sun: Optional[NDArray[np.float32]],
             hours: NDArray[np.datetime64], occupied: NDArray[np.bool_], facts: dict[str, Any]) -> Daylight:
    sensors = figures["sensors"]

    def column(key: str) -> NDArray[np.float64]:
        return np.array([sensor[key] for sensor in sensors], float)

    return Daylight(
        grid, lux, sun, hours, occupied, column("DA"), column("cDA"),
        np.array([list(sensor["UDI"].values()) for sensor in sensors], float),
        column("sun_hours"), figures, facts,
    )
