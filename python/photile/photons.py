"""Photons of a scene, photon maps over photons of any origin, and the nearest of bare points."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .errors import InputError, UsageError
from .progress import Progress, heard_by
from .scenes import Scene, floats

__all__ = ["NONE", "Neighbours", "PhotonMaps", "Photons", "neighbours", "trace"]

NONE: int = _photile.none
"""The index that means: no neighbour, no light or no material."""

_POINTS_AT_A_TIME = 1 << 20  # Ctrl-C is heard between them


class Photons:
    """Photons where they land: arrays of one length, views into the library's memory.

    They are in the order of their triangles. A photon's flux is that of a light layer at a power
    of 1 (lumen or watt): multiply by ``photons.power[photons.light]`` for the scene's own lights.

    ``numpy.asarray(photons)`` copies them into one structured array with the fields position, flux,
    light, triangle and side.

    Attributes
    ----------
    scene : Scene
        The scene on which they lie.
    """

    scene: Scene

    def __init__(self, scene: Scene, core: _photile.Photons) -> None:
        self.scene = scene
        self._core = core

    def __len__(self) -> int:
        return len(self._core)

    @property
    def position(self) -> NDArray[np.float32]:
        """(n, 3) metres from ``scene.origin``; a read-only view."""
        return self._core.position

    @property
    def flux(self) -> NDArray[np.float32]:
        """(n, 3) linear RGB, where the photon's light layer emits 1; a read-only view."""
        return self._core.flux

    @property
    def incoming(self) -> Optional[NDArray[np.float32]]:
        """(n, 3) unit vectors towards where they came from, or None in scenes without glossy surfaces."""
        incoming = self._core.incoming
        return incoming if len(incoming) == len(self) else None

    @property
    def light(self) -> NDArray[np.uint16]:
        """(n,) indices into `layer_names`; a read-only view where there are several layers."""
        light = self._core.light
        return light if len(light) == len(self) else np.zeros(len(self), np.uint16)

    @property
    def triangle(self) -> NDArray[np.uint32]:
        """(n,) row numbers in ``scene.triangles``."""
        return self._core.oriented_face >> np.uint32(1)

    @property
    def side(self) -> NDArray[np.uint8]:
        """(n,) 0 or 1: the side of the triangle; 0 is that of the stored corners' normal."""
        return (self._core.oriented_face & np.uint32(1)).astype(np.uint8)

    @property
    def normal(self) -> NDArray[np.float32]:
        """(n, 3) unit normals of the sides that they lie on."""
        return self._core.normals(self.scene._core)

    @property
    def layer_names(self) -> list[str]:
        """Names of the light layers."""
        return list(self.scene.layers)

    @property
    def power(self) -> NDArray[np.float64]:
        """(layers,) powers of the scene's lights, lumens or watts."""
        return np.array(list(self.scene.layers.values()))

    @property
    def emitted(self) -> NDArray[np.uint64]:
        """(lights,) number of paths started."""
        return np.array(self._core.emitted_per_light, np.uint64)

    @property
    def absorbed_flux(self) -> NDArray[np.float64]:
        """(lights,) fraction of each light's flux that surfaces absorbed."""
        return np.array(self._core.absorbed_flux_per_light)

    @property
    def escaped_flux(self) -> NDArray[np.float64]:
        """(lights,) fraction of each light's flux that left the scene."""
        return np.array(self._core.escaped_flux_per_light)

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        fields = np.empty(
            len(self),
            [("position", "<f4", 3), ("flux", "<f4", 3), ("light", "<u2"), ("triangle", "<u4"),
             ("side", "u1")],
        )
        for name in fields.dtype.names or ():
            fields[name] = getattr(self, name)
        return fields if dtype is None else fields.astype(dtype)

    def __repr__(self) -> str:
        return f"<photile.Photons: {len(self)} of {len(self.layer_names)} light layers>"


def trace(
    scene: Scene,
    photons: int = 1_000_000,
    seed: int = 1,
    *,
    quota: str = "balanced",
    store_direct: bool = True,
    max_path_length: int = 1_000_000,
    progress: Progress = None,
) -> Photons:
    """Trace photon paths from the lights, and store a photon at each hit on an opaque surface.

    Parameters
    ----------
    scene : Scene
    photons : int
        Paths over all lights; each stores several photons.
    seed : int
        The same seed gives the same photons, bit for bit, on any number of threads.
    quota : {"balanced", "power", "equal"}
        How paths are divided between the lights: half by power and half equally, by power, or equally.
    store_direct : bool
        Whether photons that come directly from a light are stored.
    max_path_length : int
        The most surface interactions of a path; Russian roulette ends almost all paths much earlier.
    progress : callable or True, optional
        See `render`.

    Returns
    -------
    Photons

    Raises
    ------
    UsageError
        A number is out of its range.
    KeyboardInterrupt
        Ctrl-C was pressed.
    """
    options = {
        "photons": photons,
        "seed": seed,
        "quota": quota,
        "store_direct": store_direct,
        "max_path_length": max_path_length,
    }
    with heard_by(progress) as heard:
        return Photons(scene, _photile.trace(scene._core, options, heard))


class Neighbours(NamedTuple):
    """The k nearest photons of each point, nearest first."""

    photons: NDArray[np.uint32]
    """(points, k) row numbers of the photons; ``photile.NONE`` beyond the last."""
    squared_distance: NDArray[np.float32]
    """(points, k) square metres; infinity beyond the last."""

    @property
    def distance(self) -> NDArray[np.float32]:
        """(points, k) metres."""
        return np.sqrt(self.squared_distance)


class PhotonMaps:
    """Photon maps on an OpenCL device, over photons of any origin.

    Parameters
    ----------
    photons : Photons or (n, 3) array
        The result of `trace`, with normals, flux and lights; or positions in metres.
    flux : (n, 3) array, optional
        Linear RGB of each photon; 1 by default.
    normals : (n, 3) array, optional
        Unit normals of the surfaces below. If photons have normals, points need them too, and only
        photons count whose normals differ by at most ``angle``.
    lights : (n,) array of ints below 65536, optional
        The light of each photon; densities are computed for each light.
    radius : float, optional
        Metres: no neighbour is farther away. By default twice the median distance to the
        ``neighbours``-th photon.
    neighbours : int
        The number of neighbours for which the radius is chosen.
    angle : float
        Degrees, in [0, 180].
    photons_per_cell : float
        Aim for the grids of the maps.
    device : str
        As for `render`; of several devices, the first is used.
    progress : callable or True, optional
        See `render`.

    Raises
    ------
    InputError
        Arrays do not fit, or hold NaN or infinite numbers; the first such photon is named.
    UsageError
        A parameter is out of its range.
    DeviceMemoryError
        The device's memory does not suffice.
    """

    def __init__(
        self,
        photons: Union[Photons, ArrayLike],
        flux: Optional[ArrayLike] = None,
        *,
        normals: Optional[ArrayLike] = None,
        lights: Optional[ArrayLike] = None,
        radius: Optional[float] = None,
        neighbours: int = 50,
        angle: float = 60.0,
        photons_per_cell: float = 4.0,
        device: str = "",
        progress: Progress = None,
    ) -> None:
        if isinstance(photons, Photons):
            positions = photons.position
            flux = photons.flux if flux is None else flux
            normals = photons.normal if normals is None else normals
            if lights is None and len(photons.layer_names) > 1:
                lights = photons.light
            self._origin = np.array(photons.scene.origin)
        else:
            self._origin = _origin(photons)
            positions = _rows_from(self._origin, photons, "positions")
        of_photons = None if lights is None else _lights(lights)
        self._has_normals = normals is not None
        options = {
            "radius": _radius(radius),
            "neighbours": neighbours,
            "angle": angle,
            "photons_per_cell": photons_per_cell,
            "device": device,
        }
        with heard_by(progress) as heard:
            self._core = _photile.PhotonMaps(
                positions,
                None if normals is None else _rows(normals, "normals"),
                None if flux is None else _rows(flux, "flux"),
                of_photons,
                options,
                heard,
            )
        if not isinstance(photons, Photons):
            _check_rounding("positions: photon", photons, self._origin, positions, self.radius)

    def __len__(self) -> int:
        return len(self._core)

    @property
    def radius(self) -> float:
        """Metres: no neighbour is farther away."""
        return self._core.radius

    @property
    def statistics(self) -> dict[str, Any]:
        """Photons, references (records over all maps), maps, cells, bytes and seconds."""
        return self._core.statistics()

    def nearest(
        self,
        points: ArrayLike,
        normals: Optional[ArrayLike] = None,
        k: int = 50,
        radius: Optional[float] = None,
    ) -> Neighbours:
        """The k nearest photons of each point, in space.

        Parameters
        ----------
        points : (m, 3) array
            Metres: in the file's world if the photons are those of a scene, else in the coordinates of
            the photons.
        normals : (m, 3) array, optional
            Unit vectors; needed if the photons have normals.
        k : int
            Neighbours of each point.
        radius : float, optional
            Metres, at most the radius of the maps, which is the default.

        Returns
        -------
        Neighbours
            Of photons at distances that agree to a few roundings of a float, any may be the last.

        Raises
        ------
        InputError
            Arrays do not fit, or hold NaN or infinite numbers.
        UsageError
            k or the radius is out of its range.
        """
        where, facing = self._queries(points, normals)
        options = {"k": k, "radius": _radius(radius)}
        parts = [
            self._core.nearest(where[part], None if facing is None else facing[part], options)
            for part in _parts(len(where))
        ]
        return Neighbours(_joined([p[0] for p in parts]), _joined([p[1] for p in parts]))

    def irradiance(
        self,
        points: ArrayLike,
        normals: Optional[ArrayLike] = None,
        k: int = 50,
        radius: Optional[float] = None,
        kernel: str = "constant",
    ) -> NDArray[np.float32]:
        """Flux per area at each point: the flux of its neighbours over the area of their disc.

        Parameters
        ----------
        points, normals, k, radius
            As for `nearest`.
        kernel : {"constant", "cone"}
            The weight of photons by their distance.

        Returns
        -------
        (m, lights, 3) array
            Linear RGB, in the unit of the flux per square metre; one light if the photons have no lights.
            For photons of `trace` each light layer is at a power of 1: weight the layers by
            ``photons.power`` to get the irradiance in the scene.

        Raises
        ------
        InputError, UsageError
            As for `nearest`.
        """
        where, facing = self._queries(points, normals)
        options = {"k": k, "radius": _radius(radius), "kernel": kernel}
        return _joined(
            [
                self._core.irradiance(where[part], None if facing is None else facing[part], options)
                for part in _parts(len(where))
            ]
        )

    def _queries(
        self, points: ArrayLike, normals: Optional[ArrayLike]
    ) -> tuple[NDArray[np.float32], Optional[NDArray[np.float32]]]:
        where = _rows_from(self._origin, points, "points")
        if normals is None and self._has_normals:
            raise InputError("normals: the photons have normals, so the points need them too")
        return where, None if normals is None else _rows(normals, "normals")

    def __repr__(self) -> str:
        return f"<photile.PhotonMaps: {len(self)} photons, radius {self.radius:.4g} m>"


def neighbours(
    points: ArrayLike,
    queries: ArrayLike,
    k: int,
    normals: Optional[ArrayLike] = None,
    query_normals: Optional[ArrayLike] = None,
    *,
    max_distance: float = np.inf,
    angle: float = 60.0,
    device: str = "",
    progress: Progress = None,
) -> tuple[NDArray[np.uint32], NDArray[np.float32]]:
    """The k nearest points of each query, as ``scipy.spatial.cKDTree(points).query(queries, k)``.

    The search runs on an OpenCL device, and is prepared again in each call: pass all queries at once,
    or keep `PhotonMaps`, whose neighbours lie within a radius.

    Parameters
    ----------
    points : (n, 3) array
        At least one point, in any unit of length, which distances have as well; coordinates up to 1e12.
    queries : (m, 3) array
        As the points. Doubles far from the origin are taken relative to the middle of the points
        before they are rounded to floats.
    k : int
        1 to 1,000,000; it may exceed n.
    normals, query_normals : (n, 3) and (m, 3) arrays, optional
        Unit vectors. With them, only points count whose normals differ from the query's by at most
        ``angle``.
    max_distance : float
        Above 0: no neighbour is farther. Infinity: all points count.
    angle : float
        Degrees, in [0, 180].
    device : str
        As for `render`; of several devices, the first is used.
    progress : callable or True, optional
        See `render`.

    Returns
    -------
    indices : (m, k) array of uint32
        Row numbers in ``points``, nearest first, coincident points in the order of their rows; n
        where there are fewer than k neighbours.
    distances : (m, k) array of float32
        Distances of the points as floats, computed in double precision; infinity where there are
        fewer. Of points whose distances agree to a few roundings of a float, any may be the last.

    Raises
    ------
    InputError
        There are no points, arrays do not fit or hold NaN or infinite numbers, the first of which is
        named, or points are so far apart that rounding to floats would change the neighbours.
    UsageError
        k, the distance or the angle is out of its range.
    DeviceMemoryError
        The device's memory does not suffice.
    """
    origin = _origin(points)
    rows = _rows_from(origin, points, "points")
    with heard_by(progress) as heard:
        found = _photile.neighbours(
            rows,
            _rows_from(origin, queries, "queries"),
            None if normals is None else _rows(normals, "normals"),
            None if query_normals is None else _rows(query_normals, "query_normals"),
            {"k": k, "max_distance": max_distance, "angle": angle, "device": device},
            heard,
        )
    apart = found[1][np.isfinite(found[1]) & (found[1] > 0)]
    if apart.size:
        _check_rounding("points: point", points, origin, rows, float(2 * np.median(apart)))
    return found


def _radius(radius: Optional[float]) -> float:
    """0 stands for none."""
    if radius is None:
        return 0.0
    if not isinstance(radius, (int, float, np.number)) or not radius > 0:
        raise UsageError(f"radius: '{radius}' is not a number above 0")
    return float(radius)


def _rows(values: ArrayLike, name: str) -> NDArray[np.float32]:
    """A C-contiguous (n, 3) array of floats; the argument itself if it is one."""
    array = floats(values, name)
    if array.ndim == 1 and array.size == 3:
        array = array.reshape(1, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(f"{name}: the array has shape {array.shape}; it must have shape (n, 3)")
    return array


def _rows_from(origin: NDArray[np.float64], values: ArrayLike, name: str) -> NDArray[np.float32]:
    """Positions relative to ``origin``: the array of `_rows` if that is zero."""
    if not origin.any():
        return _rows(values, name)
    return _rows(floats(values, name, np.float64) - origin, name)


_FARTHER = 16  # times their distance from the middle of their box, as for the origins of scenes


def _origin(values: ArrayLike) -> NDArray[np.float64]:
    """The origin of positions before they become floats, whose steps grow with the distance.

    Zero, unless they lie much nearer to the middle of their box.
    """
    positions = np.asarray(values)
    if positions.dtype.kind not in "fiu" or positions.size == 0 or positions.shape[-1] != 3:
        return np.zeros(3)
    rows = positions.reshape(-1, 3)
    low, high = rows.min(axis=0).astype(np.float64), rows.max(axis=0).astype(np.float64)
    with np.errstate(over="ignore", invalid="ignore"):
        middle: NDArray[np.float64] = (low + (high - low) / 2).astype(np.float32).astype(np.float64)
    nearest = np.abs([low - middle, high - middle]).max()
    far = np.isfinite(nearest) and np.abs([low, high]).max() > _FARTHER * nearest
    return middle if far else np.zeros(3)


_LARGEST_ROUNDING = 1 / 64  # of the radius: a tenth of the distance between 50 photons within it


def _check_rounding(
    what: str,
    values: ArrayLike,
    origin: NDArray[np.float64],
    rows: NDArray[np.float32],
    radius: float,
) -> None:
    """Refuses positions so far apart that rounding to floats would change the neighbours."""
    if np.asarray(values).dtype == np.float32 and not origin.any() or len(rows) == 0:
        return
    moved = np.abs(floats(values, "positions", np.float64).reshape(-1, 3) - origin - rows)
    most = np.unravel_index(np.argmax(moved), moved.shape)
    if moved[most] > _LARGEST_ROUNDING * radius:
        raise InputError(
            f"{what} {most[0]} is so far from the others that its position in floats is"
            f" {moved[most]:.2g} m off, too much for a radius of {radius:.4g} m;"
            " search each part separately"
        )


def _lights(values: ArrayLike) -> NDArray[np.uint16]:
    array = np.asarray(values)
    if array.dtype.kind not in "iu" or (array.size and (array.min() < 0 or array.max() > 0xFFFF)):
        raise InputError("lights: the array must hold whole numbers from 0 to 65535")
    return np.ascontiguousarray(array, np.uint16)


def _parts(count: int) -> list[slice]:
    starts = range(0, max(count, 1), _POINTS_AT_A_TIME)
    return [slice(start, start + _POINTS_AT_A_TIME) for start in starts]


def _joined(parts: list[NDArray[Any]]) -> NDArray[Any]:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
