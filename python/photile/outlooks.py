"""View out and exposure to sunlight by EN 17037:2018: what windows give besides light."""

from __future__ import annotations

import datetime
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .errors import InputError, UsageError
from .grids import Grid
from .progress import Progress, heard_by
from .scenes import File, Scene, floats, joined, number

__all__ = ["SunHours", "ViewOut", "sun_hours", "view_out"]

Doubles = NDArray[np.float64]
Flags = NDArray[np.bool_]
Windows = Union[str, Sequence[str], ArrayLike]

LEVELS = ("none", "minimum", "medium", "high")
# Table A.5: degrees, metres, layers, of which one is the landscape. Table A.6: hours.
_ANGLES, _DISTANCES, _LAYERS, _HOURS = (14.0, 28.0, 54.0), (6.0, 20.0, 50.0), (1, 2, 3), (1.5, 3.0, 4.0)
_PART = 0.75  # of a room that has a view
_DAYS = ((2, 1), (3, 21))  # of the year, from which the standard has one chosen

_COLUMNS, _ROWS = 64, 32  # lines through a window
_AT_ONCE = 500_000  # lines
_OWN_REVEAL = 1.0  # metres beyond a window within which what a line meets belongs to its wall
_BESIDE = 0.25  # metres that a room is wider than its window
_NARROWEST = 0.1  # metres of a window: the edges of panes are none


@dataclass(frozen=True, repr=False)
class SunHours:
    """How long the sun shines on points in one cloudless day.

    Attributes
    ----------
    points : (n, 3) array
        Metres.
    hours : (n,) array
        Of each point.
    together : float
        Hours in which the sun reaches any of them.
    times : (m,) array of datetime64
        The moments that were tried, standard time: those with the sun high enough.
    sunlit : (n, m) array of bool
        Whether it reaches the point then.
    level : str
        "none", "minimum" (1.5 h), "medium" (3 h) or "high" (4 h), by the point with the most hours; "" of
        a day that is not one from 1 February to 21 March.
    date : str
        The day, "YYYY-MM-DD".
    """

    points: Doubles
    hours: Doubles
    together: float
    times: NDArray[np.datetime64]
    sunlit: Flags
    level: str
    date: str

    @property
    def _content(self) -> dict[str, Any]:
        """What ``photile outlook`` writes, and reports show."""
        places = [{"position": place, "hours": hours}
                  for place, hours in zip(self.points.tolist(), self.hours.tolist())]
        return {"sunlight": {"date": self.date, "level": self.level, "places": places}}

    def __len__(self) -> int:
        return len(self.hours)

    def __repr__(self) -> str:
        longest = f", at most {self.hours.max():.2f} h" if len(self) else ""
        return f"<photile.SunHours: {len(self)} points{longest}, level {self.level or 'not of this day'}>"


@dataclass(frozen=True, repr=False)
class ViewOut:
    """What eyes see through windows.

    Attributes
    ----------
    points : (n, 3) array
        Eyes, metres.
    angle : (n,) array
        Horizontal sight angle: the degrees of the plan in which they see out, through all windows together.
    distance : (n,) array
        Metres of the plan from the window to what bounds the view at the height of the eyes, the median over
        that angle; infinite where the scene has nothing there.
    sky, landscape, ground : (n,) arrays of bool
        The layers seen, from 6 m of the plan beyond the window on. Landscape is any surface that does not face upwards,
        and the horizon where nothing hides it; ground is what faces upwards, and what lies below the
        horizon where the scene ends.
    levels : (n,) array of str
        "none", "minimum", "medium" or "high": the lowest by angle, distance and layers of one window.
    name : str
        Of the grid.
    """

    points: Doubles
    angle: Doubles
    distance: Doubles
    sky: Flags
    landscape: Flags
    ground: Flags
    levels: NDArray[np.str_]
    name: str = "points"

    @property
    def _content(self) -> dict[str, Any]:
        """What ``photile outlook`` writes, and reports show."""
        distance = float(np.median(self.distance)) if len(self) else 0.0
        return {"view_out": [{"grid": self.name, "points": len(self), "level": self.level,
                              "angle": float(np.median(self.angle)) if len(self) else 0.0,
                              "distance": distance if np.isfinite(distance) else None,
                              "levels": {level: int(np.sum(self.levels == level)) for level in LEVELS}}]}

    @property
    def level(self) -> str:
        """The highest level that 75% of the points have."""
        ranks = sorted((LEVELS.index(level) for level in self.levels), reverse=True)
        return LEVELS[ranks[int(np.ceil(_PART * len(ranks))) - 1]] if ranks else LEVELS[0]

    def __len__(self) -> int:
        return len(self.angle)

    def __repr__(self) -> str:
        return f"<photile.ViewOut: {len(self)} points, level {self.level}>"

    def columns(self) -> dict[str, Any]:
        """Columns of a table: ``pandas.DataFrame(view.columns())``."""
        places = {axis: self.points[:, i] for i, axis in enumerate("xyz")}
        names = ("angle", "distance", "sky", "landscape", "ground", "levels")
        return {**places, **{name: getattr(self, name) for name in names}}


def sun_hours(
    scene: Scene,
    date: Union[str, datetime.date],
    points: Union[None, Grid, ArrayLike] = None,
    *,
    site: Optional[tuple[float, float, float]] = None,
    weather: Optional[File] = None,
    lowest_sun: float = 11.0,
    windows: Windows = (),
    minutes: float = 1.0,
    progress: Progress = None,
) -> SunHours:
    """Exposure to sunlight by EN 17037: how long the sun shines into windows in one cloudless day.

    Parameters
    ----------
    scene : Scene
        With `load`'s north. Glass counts as clear; nothing counts that the scene lacks, such as the house
        opposite.
    date : date or "YYYY-MM-DD"
        The standard has one chosen from 1 February to 21 March.
    points : Grid or (n, 3) array, optional
        By default the reference point of each window: on the inner face of its wall, in the middle of its
        width, 1.2 m above the floor and at least 0.3 m above its sill. In the plane of a roof window its middle.
    site : (latitude, longitude, time zone), optional
        Degrees north and east, hours ahead of UTC; by default that of `weather`.
    weather : path, optional
        An EnergyPlus weather file (.epw), of which the site is taken.
    lowest_sun : float
        Degrees above the horizon from which on the sun counts. The standard states them for each country,
        11 for Germany.
    windows
        As for `view_out`; without points.
    minutes : float
        Between the moments that are tried.
    progress : callable or True, optional
        See `render`.

    Returns
    -------
    SunHours

    Raises
    ------
    InputError
        The weather file cannot be read, or points are no finite numbers.
    UsageError
        There is no such day, no site, or no window.
    """
    day = f"{date:%Y-%m-%d}" if isinstance(date, datetime.date) else str(date)
    if site is None and weather is None:
        raise UsageError("sun_hours: give site=(latitude, longitude, time zone), or weather")
    if not 0 < number(minutes, "minutes") <= 60:
        raise UsageError(f"minutes: {minutes!r} is not a number above 0, at most 60")
    if not -90 <= number(lowest_sun, "lowest_sun") <= 90:
        raise UsageError(f"lowest_sun: {lowest_sun!r} is not a number of degrees from -90 to 90")
    steps = int(np.ceil(24 * 60 / minutes))
    hours = (np.arange(steps) + 0.5) * 24 / steps
    suns, elevations = _photile.suns(
        scene._core, joined(site, ",") if site is not None else "",
        os.fspath(weather) if weather is not None else "", scene._north, day, hours.tolist())
    high = elevations >= np.radians(lowest_sun)
    around = _photile.surroundings(scene._core)
    if points is None:
        axes = _photile.axes(scene._core)
        found = np.array([_reference_point(around, axes, one) for one in _windows(scene, windows)])
        # The two faces of a pane are one window.
        places = found[np.sort(np.unique(np.round(found, 1), axis=0, return_index=True)[1])]
    else:
        places = _places(points)
    towards = suns[high]
    sunlit = np.zeros((len(places), len(towards)), bool)
    chunk = max(1, _AT_ONCE // max(1, len(towards)))
    with heard_by(progress) as heard:
        for first in range(0, len(places), chunk):
            some = places[first:first + chunk]
            distances, _ = around.ends(np.repeat(some, len(towards), 0), np.tile(towards, (len(some), 1)))
            sunlit[first:first + chunk] = np.isinf(distances).reshape(len(some), -1)
            if heard:
                heard("sun", min(first + chunk, len(places)), len(places), "points")
    each = 24 / steps
    of_points = each * sunlit.sum(axis=1)
    start = np.datetime64(day, "s")
    parts = tuple(int(part) for part in day.split("-")[1:])
    level = LEVELS[_rank(of_points.max(initial=0.0), _HOURS)] if _DAYS[0] <= parts <= _DAYS[1] else ""
    return SunHours(places, of_points, float(each * sunlit.any(axis=0).sum()),
                    start + np.round(3600 * hours[high]).astype("timedelta64[s]"), sunlit, level, day)


def view_out(
    scene: Scene,
    points: Union[Grid, ArrayLike],
    *,
    windows: Windows = (),
    progress: Progress = None,
) -> ViewOut:
    """The view out by EN 17037: its width, how far it reaches, and the layers that are seen.

    Parameters
    ----------
    scene : Scene
        With what stands outside: nothing else bounds the view. Glass counts as clear.
    points : Grid or (n, 3) array
        Eyes, metres: ``photile.grids(scene, "floor+1.2")`` of people who sit, 1.7 of those who stand.
    windows : patterns of material names, or (n, 3, 3) array, optional
        The panes of windows, or rectangles: a corner and two sides u and v, metres, where u x v points
        inwards. By default those of `load`'s portals, or else all glass: name the panes where other things
        are of glass, too. Windows in roofs give no view.
    progress : callable or True, optional
        See `render`.

    Returns
    -------
    ViewOut

    Raises
    ------
    InputError
        Points or rectangles are no finite numbers.
    UsageError
        There is no such material, or no window.
    """
    places = _places(points)
    axes = _photile.axes(scene._core)
    walls = [one for one in _windows(scene, windows) if abs(_inwards(one) @ axes[2]) < np.sqrt(0.5)]
    around = _photile.surroundings(scene._core)
    seen: list[list[_Seen]] = [[] for _ in places]
    chunk = max(1, _AT_ONCE // (_COLUMNS * _ROWS))
    with heard_by(progress) as heard:
        for done, window in enumerate(walls):
            lines = _Lines(window, axes)
            for first in range(0, len(places), chunk):
                for row, one in enumerate(lines.seen_from(around, places[first:first + chunk]), first):
                    seen[row].append(one)
            if heard:
                heard("view", done + 1, len(walls), "windows")
    rows = [_together(each) for each in seen]
    columns = [np.array(column) for column in zip(*rows)] or [np.empty(0)] * 6
    angle, distance, sky, landscape, ground, layers = columns
    ranks = [min(_rank(a, _ANGLES), _rank(d, _DISTANCES), _rank(n, _LAYERS))
             for a, d, n in zip(angle, distance, layers)]
    return ViewOut(places, angle, distance, sky, landscape, ground, np.array([LEVELS[rank] for rank in ranks]),
                   points.name if isinstance(points, Grid) else "points")


def _rank(value: float, least: Sequence[float]) -> int:
    """How many levels a value has, up to rounding."""
    return sum(value >= each * (1 - 1e-9) for each in least)


def _places(points: Union[Grid, ArrayLike]) -> Doubles:
    return np.ascontiguousarray(points.points if isinstance(points, Grid) else Grid.of_points(points).points)


def _windows(scene: Scene, windows: Windows) -> Doubles:
    """Rectangles: corner, u, v."""
    names: Any = [windows] if isinstance(windows, str) else windows
    if len(names) and not isinstance(names[0], str):
        rectangles = floats(windows, "windows", np.float64)
        if rectangles.ndim != 3 or rectangles.shape[1:] != (3, 3) or not np.all(np.isfinite(rectangles)):
            raise InputError(f"windows: the array of shape {rectangles.shape} is not (n, 3, 3) finite numbers")
    else:
        rectangles = _photile.windows(
            scene._core, list(names) or [name for name in scene._portals if name not in ("auto", "off")])
    wide = np.linalg.norm(rectangles[:, 1:], axis=2).min(axis=1, initial=np.inf) >= _NARROWEST
    if not wide.any():
        raise UsageError("windows: there is no glass; name the material of their panes, such as windows='pane*', "
                         "or give their rectangles")
    return np.asarray(rectangles[wide])


def _inwards(window: Doubles) -> Doubles:
    across = np.cross(window[1], window[2])
    return np.asarray(across / np.linalg.norm(across))


def _reference_point(around: _photile.Surroundings, axes: Doubles, window: Doubles) -> Doubles:
    """Of EN 17037 for exposure to sunlight."""
    corner, u, v = window
    up, inwards, middle = axes[2], _inwards(window), corner + (u + v) / 2
    if abs(inwards @ up) >= np.sqrt(0.5):
        return np.asarray(middle)
    sideways = np.cross(up, inwards)
    half = (abs(u @ sideways) + abs(v @ sideways)) / 2
    # The inner face is where the room is wider than the window: the reveals end there.
    depths = np.arange(0.01, 1.0, 0.01)
    within = middle + depths[:, None] * inwards
    free = [around.ends(within, np.repeat(side[None], len(within), 0))[0] for side in (sideways, -sideways)]
    wider = np.maximum(*free) > half + _BESIDE
    face = middle + (depths[wider.argmax()] if wider.any() else 0.0) * inwards
    # A sill and furniture below the window are no floor.
    over_floor = face + np.array([0.05, 0.3, 0.6, 1.0])[:, None] * inwards
    below, _ = around.ends(over_floor, np.repeat(-up[None], 4, 0))
    level = middle @ up
    floor = level - below[np.isfinite(below)].max(initial=0.0)
    sill = level - (abs(u @ up) + abs(v @ up)) / 2
    return np.asarray(face + (max(floor + 1.2, sill + 0.3) - level) * up)


@dataclass(frozen=True)
class _Seen:
    """What an eye sees through one window."""

    starts: Doubles
    """Of the parts of the plan in which it sees out, degrees."""
    widths: Doubles
    distances: Doubles
    layers: tuple[bool, bool, bool]
    """Sky, landscape, ground."""


class _Lines:
    """Lines from eyes through the cells of a window."""

    def __init__(self, window: Doubles, axes: Doubles) -> None:
        corner, *sides = window
        self._right, self._ahead, self._up = axes
        self._inwards, self._corner = _inwards(window), corner
        across, upwards = sorted(sides, key=lambda side: abs(float(side @ self._up)))
        if upwards @ self._up < 0:
            corner, upwards = corner + upwards, -upwards
        x, y = ((np.arange(count) + 0.5) / count for count in (_COLUMNS, _ROWS))
        self._targets = corner + x[:, None, None] * across + y[None, :, None] * upwards
        self._edges = corner + upwards / 2 + np.linspace(0, 1, _COLUMNS + 1)[:, None] * across
        self._low, self._high = corner @ self._up, (corner + upwards) @ self._up

    def seen_from(self, around: _photile.Surroundings, eyes: Doubles) -> list[_Seen]:
        towards = self._targets - eyes[:, None, None]
        through = np.linalg.norm(towards, axis=-1)
        directions = np.ascontiguousarray(towards.reshape(-1, 3))
        ends, upwards = around.ends(np.repeat(eyes, _COLUMNS * _ROWS, 0), directions)
        rising = towards @ self._up
        level = np.sqrt(np.maximum(1 - (rising / through) ** 2, 1e-12))  # metres of the plan for one of a line
        beyond = (ends.reshape(through.shape) - through) * level
        facing = upwards.reshape(through.shape)
        return [self._seen(eye, *of_eye) for eye, *of_eye in zip(eyes, beyond, facing, rising)]

    def _seen(self, eye: Doubles, beyond: Doubles, facing: Doubles, rising: Doubles) -> _Seen:
        """From the lines of one eye: metres beyond the window in the plan, whether what ends them faces upwards,
        and whether they rise."""
        if (eye - self._corner) @ self._inwards <= 0:
            return _Seen(np.empty(0), np.empty(0), np.empty(0), (False, False, False))
        seen = beyond > _OWN_REVEAL
        out = seen.any(axis=1)
        offsets = self._edges - eye
        turns = np.degrees(np.arctan2(offsets @ self._right, offsets @ self._ahead))
        widths = (np.diff(turns) + 180) % 360 - 180
        starts = np.where(widths < 0, turns[1:], turns[:-1])
        # Of each column the line that sees out nearest to the height of the eye.
        level = beyond[np.arange(_COLUMNS), np.where(seen, np.abs(rising), np.inf).argmin(axis=1)]
        far, ends = beyond >= _DISTANCES[0], np.isfinite(beyond)
        horizon = self._low < eye @ self._up < self._high and np.isinf(beyond[:, np.abs(rising[0]).argmin()]).any()
        layers = ((~ends & (rising > 0)).any(), (far & ends & (facing <= 0.5)).any() or horizon,
                  ((far & ends & (facing > 0.5)) | (~ends & (rising < 0))).any())
        return _Seen(starts[out], np.abs(widths[out]), level[out],
                     (bool(layers[0]), bool(layers[1]), bool(layers[2])))


def _together(windows: list[_Seen]) -> tuple[float, float, bool, bool, bool, int]:
    """Angle, distance, layers, and the layers of the window that shows most of them."""
    starts, widths, distances = (np.concatenate([getattr(each, name) for each in windows] or [np.empty(0)])
                                 for name in ("starts", "widths", "distances"))
    layers = [each.layers for each in windows]
    sky, landscape, ground = (any(each[i] for each in layers) for i in range(3))
    most = max((sum(each) for each in layers if each[1]), default=0)
    if not len(starts):
        return 0.0, 0.0, sky, landscape, ground, most
    order = np.argsort(distances)
    middle = np.searchsorted(np.cumsum(widths[order]), widths.sum() / 2)
    return _union(starts % 360, widths), float(distances[order][middle]), sky, landscape, ground, most


def _union(starts: Doubles, widths: Doubles) -> float:
    """The degrees of the circle that arcs cover together."""
    covered, end = 0.0, 0.0
    ends = starts + widths
    arcs = [*zip(starts, np.minimum(ends, 360)), *((0.0, over - 360) for over in ends if over > 360)]
    for start, stop in sorted(arcs):
        covered += max(0.0, stop - max(start, end))
        end = max(end, stop)
    return covered
