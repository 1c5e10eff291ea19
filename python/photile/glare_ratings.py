"""Discomfort glare."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .errors import InputError, UsageError
from .grids import Grid
from .pictures import Changes, lights_asked
from .progress import Progress, heard_by
from .scenes import Camera, File, Scene, floats, stated

__all__ = ["Glare", "glare"]

Observer = Union[Grid, Camera, str, int]


@dataclass(frozen=True, repr=False)
class Glare:
    """Ratings of observers; those that do not exist are NaN.

    Attributes
    ----------
    names : list of str
        Of the observers.
    positions, directions : (n, 3) arrays
        Eyes, metres; unit vectors.
    illuminance, illuminance_error : (n,) arrays
        Lux at the eyes, and its standard error.
    background, background_error : (n,) arrays
        cd/m2 of what is not a luminaire.
    ugr, ugr_error : (n,) arrays
        NaN where no luminaire is visible.
    ggr : (n,) array
        With luminaires larger than 1.5 m2.
    dgp, dgp_error, dgp_low_light, dgi : (n,) arrays
        Of pictures; dgp_low_light has the correction for less than 1000 lux.
    observers : list of dict
        All that `photile glare` writes to JSON, with luminaires and glare sources.
    """

    names: list[str]
    positions: NDArray[np.float64]
    directions: NDArray[np.float64]
    illuminance: NDArray[np.float64]
    illuminance_error: NDArray[np.float64]
    background: NDArray[np.float64]
    background_error: NDArray[np.float64]
    ugr: NDArray[np.float64]
    ugr_error: NDArray[np.float64]
    ggr: NDArray[np.float64]
    dgp: NDArray[np.float64]
    dgp_error: NDArray[np.float64]
    dgp_low_light: NDArray[np.float64]
    dgi: NDArray[np.float64]
    observers: list[dict[str, Any]]
    _content: dict[str, Any]
    """What a report includes."""
    _facts: dict[str, Any]
    """What a report of glare alone states beside it."""

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        highest = ", ".join(
            f"highest {name} {np.nanmax(ratings):.3g}"
            for name, ratings in (("UGR", self.ugr), ("DGP", self.dgp)) if np.any(np.isfinite(ratings)))
        observers = "1 observer" if len(self) == 1 else f"{len(self)} observers"
        return f"<photile.Glare: {observers}{highest and ', '}{highest}>"

    def columns(self) -> dict[str, Any]:
        """Columns of a table: ``pandas.DataFrame(glare.columns())``."""
        places = {axis: self.positions[:, i] for i, axis in enumerate("xyz")}
        facing = {f"d{axis}": self.directions[:, i] for i, axis in enumerate("xyz")}
        figures = ("illuminance", "illuminance_error", "background", "background_error", "ugr", "ugr_error",
                   "ggr", "dgp", "dgp_error", "dgp_low_light", "dgi")
        return {"observer": self.names, **places, **facing, **{name: getattr(self, name) for name in figures}}


def glare(
    scene: Scene,
    observers: Union[Observer, Sequence[Observer], ArrayLike],
    *,
    ratings: Optional[Sequence[str]] = None,
    directions: int = 4,
    source_luminance: float = 2000.0,
    picture_size: int = 512,
    rays: int = 1024,
    repeats: int = 8,
    light: Changes = None,
    mood: str = "",
    moods: Optional[File] = None,
    integrator: str = "photon-map",
    lumen_per_watt: float = _photile.lumen_per_watt,
    device: str = "",
    progress: Progress = None,
    **settings: Union[int, float, str],
) -> Glare:
    """Rate the discomfort glare of observers by UGR, DGP and DGI, as `photile glare` does.

    Parameters
    ----------
    scene : Scene
    observers : Grid, Camera, name or number of a camera, a sequence of these, or (n, 6) array
        At each point of a plane (``photile.grids(scene, "floor+1.2")``) observers look in several
        directions. Rows are x, y, z of the eyes, metres, and the direction of view.
    ratings : sequence of {"ugr", "dgp", "dgi"}, optional
        By default all, of grids UGR. DGP and DGI render a picture of each view.
    directions : int
        Directions of view at each point of a plane.
    source_luminance : float
        Threshold of glare sources in pictures: above 100 in cd/m2, otherwise times the mean luminance.
    picture_size : int
        Pixels across a picture.
    rays, repeats, light, mood, moods, integrator, lumen_per_watt, device
        As for `measure`.
    progress : callable or True, optional
        See `render`.
    **settings
        As for `measure`.

    Returns
    -------
    Glare

    Raises
    ------
    InputError
        Rows are no six finite numbers, or a direction has length 0.
    UsageError
        Names the parameter and its range, or there is no such camera.
    """
    places = _places(observers)
    wanted = {"ugr", "dgp", "dgi"} if ratings is None else {ratings} if isinstance(ratings, str) else set(ratings)
    if not wanted <= {"ugr", "dgp", "dgi"} or not wanted:
        raise UsageError(f"ratings: {ratings!r} is not some of ugr, dgp, dgi")
    planes = [place for place in places if isinstance(place, Grid) and place.plane is not None]
    by_pictures = len(planes) < len(places) if ratings is None else wanted != {"ugr"}
    options = {
        "by_pictures": by_pictures,
        "directions": directions,
        "source_luminance": source_luminance,
        "picture_size": picture_size,
        "rays": rays,
        "repeats": repeats,
        "integrator": integrator,
        "lumen_per_watt": lumen_per_watt,
        "device": device,
        **lights_asked(light, mood, moods),
    }
    cores = [place._core if isinstance(place, Grid) else scene._camera(place) for place in places]
    with heard_by(progress) as heard:
        found = _photile.glare(scene._core, cores, options, dict(settings), heard)
    content: dict[str, Any] = {"observers": found}
    if planes:
        plane = planes[-1]
        content |= {"plane": plane.plane, "plan": _photile.plan(scene._core, plane._core, None)}
    facts = {**stated(scene, settings), "response": "planar", "maintenance_factor": 1, "rays": rays,
             "repeats": repeats, "integrator": integrator, "sky": dict(scene._sky[1])}
    return _ratings(content, {**facts, "mood": mood} if mood else facts)


def _places(observers: Any) -> list[Union[Grid, Camera, str, int]]:
    if isinstance(observers, (Grid, Camera, str, int)):
        return [observers]
    if isinstance(observers, Sequence) and any(isinstance(one, (Grid, Camera, str)) for one in observers):
        return list(observers)
    rows = floats(observers, "observers", np.float64)
    if rows.ndim != 2 or rows.shape[1] != 6:
        raise InputError(f"observers: the array has shape {rows.shape}; it must have shape (n, 6)")
    return [Grid.of_points(rows[:, :3], rows[:, 3:], "observer")]


def _ratings(content: dict[str, Any], facts: dict[str, Any]) -> Glare:
    observers = content["observers"]

    def figures(key: str, part: str = "value") -> NDArray[np.float64]:
        found = [one.get(key) for one in observers]
        return np.array([np.nan if each is None else each[part] if isinstance(each, dict) else each
                         for each in found], float)

    def errors(key: str) -> NDArray[np.float64]:
        return figures(key, "standard_error")

    return Glare(
        [one["name"] for one in observers],
        np.array([one["position"] for one in observers], float),
        np.array([one["direction"] for one in observers], float),
        figures("illuminance"), errors("illuminance"),
        figures("background_luminance"), errors("background_luminance"),
        figures("ugr"), errors("ugr"),
        figures("ggr"),
        figures("dgp"), errors("dgp"),
        figures("dgp_low_light"),
        figures("dgi"),
        observers,
        content,
        facts,
    )
