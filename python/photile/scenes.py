"""Scenes: read from files, or made from arrays."""

from __future__ import annotations

import datetime
import json
import os
import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _photile
from .errors import InputError, UsageError
from .progress import Progress, heard_by

__all__ = ["Camera", "Light", "Material", "Scene", "load"]

Vector = tuple[float, float, float]
File = Union[str, os.PathLike[str]]
Luminaire = Mapping[str, Any]
_Part = TypeVar("_Part")


@dataclass(frozen=True)
class Material:
    """How a surface reflects; the same on both of its sides.

    Parameters
    ----------
    name : str
        For messages.
    diffuse : (3,) floats
        Lambertian albedo, linear RGB in [0, 1]; multiplied by the texture.
    texture : (height, width, 3 or 4) uint8 array, optional
        sRGB texels, row 0 at the top; needs ``Scene(uv=...)``.
    interaction : {"opaque", "mirror", "glass"}
        Photons are stored on opaque surfaces only.
    specular : (3,) floats
        Reflectance at normal incidence of the glossy lobe of an opaque surface, or of a mirror.
    roughness : float
        GGX alpha of the glossy lobe, in (0, 1].
    transmission : (3,) floats
        Colour of the light that passes a surface of glass.
    index_of_refraction : float
        Of glass.
    thin : bool
        Glass without volume: rays are not bent.
    opacity : float
        Fraction of the surface that is present, in [0, 1].
    """

    name: str = "material"
    diffuse: Vector = (0.8, 0.8, 0.8)
    texture: Optional[NDArray[np.uint8]] = None
    interaction: str = "opaque"
    specular: Vector = (0.0, 0.0, 0.0)
    roughness: float = 1.0
    transmission: Vector = (1.0, 1.0, 1.0)
    index_of_refraction: float = 1.5
    thin: bool = False
    opacity: float = 1.0


@dataclass(frozen=True)
class Light:
    """A lamp, or light from beyond the scene.

    Parameters
    ----------
    name : str
        Name of its layer in pictures; made unique if several lights have the same name.
    power : float
        Lumens, or watts in a scene of that unit. Not for directional lights and environments.
    kind : {"point", "area", "spot", "directional", "environment"}
        Area lights are triangles of the scene, which emit from their fronts.
    triangles : sequence of int
        For an area light: row numbers in ``Scene(triangles=...)``.
    two_sided : bool
        For an area light: it emits from both sides.
    color : (3,) floats
        Linear RGB of any luminance above 0; only the hue and saturation count.
    position : (3,) floats
        Metres, of point and spot lights.
    direction : (3,) floats
        The direction in which spot and directional lights emit, of any length.
    inner_angle, outer_angle : float
        Degrees from the axis of a spot light at which its light begins to fall off and reaches 0.
    illuminance : float
        Lux (or W/m2) of a directional light on a surface that faces it.
    diameter : float
        Degrees of a directional light's disc, such as 0.53 for the sun; 0 is parallel light.
    texels : (height, width, 3) array, optional
        For an environment: radiance in cd/m2 (or W/(m2 sr)) by direction, row 0 at the zenith (y).
    group : str
        Lights of one group share a layer.
    """

    name: str = "light"
    power: float = 0.0
    kind: str = "point"
    triangles: Sequence[int] = ()
    two_sided: bool = False
    color: Vector = (1.0, 1.0, 1.0)
    position: Vector = (0.0, 0.0, 0.0)
    direction: Vector = (0.0, 0.0, -1.0)
    inner_angle: float = 0.0
    outer_angle: float = 45.0
    illuminance: float = 0.0
    diameter: float = 0.0
    texels: Optional[NDArray[np.float32]] = None
    group: str = ""


@dataclass(frozen=True)
class Camera:
    """A pinhole camera, in metres of the file's world.

    Parameters
    ----------
    position : (3,) floats
        Metres.
    target : (3,) floats
        A point that it looks at.
    up : (3,) floats
        The direction that is upwards in the picture; y in glTF files.
    field_of_view : float
        Degrees from the lower to the upper edge of the picture.
    name : str
        For ``render(scene, "name")``.
    aspect_ratio : float
        Width over height; 0 follows the picture.
    """

    position: Vector
    target: Vector
    up: Vector = (0.0, 1.0, 0.0)
    field_of_view: float = 40.0
    name: str = "camera"
    aspect_ratio: float = 0.0

    def _parts(self) -> _photile.CameraParts:
        position, target, up = (
            vector(getattr(self, name), f"camera '{self.name}': {name}")
            for name in ("position", "target", "up")
        )
        forward = np.subtract(target, position)
        if not np.all(np.isfinite(forward)) or not np.any(forward):
            raise UsageError(f"camera '{self.name}': its target is its own position; give another target")
        return (
            self.name,
            position,
            vector(forward, "target"),
            up,
            float(np.radians(number(self.field_of_view, f"camera '{self.name}': field_of_view"))),
            self.aspect_ratio,
        )


def floats(values: ArrayLike, name: str, kind: Any = np.float32) -> NDArray[Any]:
    """A C-contiguous array; the argument itself if it is one. Raises InputError if it is no array."""
    try:
        return np.ascontiguousarray(values, kind)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: {reprlib.repr(values)} is not an array of numbers") from None


def number(value: Any, name: str) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{name}: {reprlib.repr(value)} is not a number") from None


def vector(values: ArrayLike, name: str) -> Vector:
    array = floats(values, name, np.float64)
    if array.shape != (3,):
        raise InputError(f"{name}: {reprlib.repr(values)} is not three numbers")
    if not np.all(np.isfinite(array)):
        raise InputError(f"{name}: {reprlib.repr(values)} holds NaN or an infinite number")
    x, y, z = (float(value) for value in array)
    return (x, y, z)


def _per_corner(
    values: Optional[ArrayLike], name: str, columns: int, triangles: NDArray[Any], vertices: int
) -> NDArray[np.float32]:
    """Rows per vertex; no rows if there are no values."""
    if values is None:
        return np.empty((0, columns), np.float32)
    array = floats(values, name)
    expected = (triangles.shape[0], 3, columns)
    if array.shape == expected and 3 * triangles.shape[0] == vertices:
        return np.ascontiguousarray(array.reshape(-1, columns))
    if array.shape == (vertices, columns):
        return np.ascontiguousarray(array)
    raise InputError(
        f"{name}: the array has shape {array.shape}; it must have shape {(vertices, columns)}"
        f" or, with triangles of corners, {expected}"
    )


def _indices(values: ArrayLike, count: int, name: str) -> NDArray[np.uint32]:
    """Whole numbers from 0 to below ``count``."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of several lengths
        raise InputError(f"{name}: {reprlib.repr(values)} is not an array of whole numbers") from None
    if array.size == 0:
        return np.empty(array.shape, np.uint32)
    if array.dtype.kind not in "iu":
        raise InputError(f"{name}: the array has type {array.dtype}; it must hold whole numbers")
    if array.min() < 0 or array.max() >= count:
        wrong = array.min() if array.min() < 0 else array.max()
        raise InputError(f"{name}: index {wrong} is out of range; there are {count}, counted from 0")
    return np.ascontiguousarray(array, np.uint32)


class Scene:
    """Triangles, materials and lights, checked and ready to be rendered.

    Parameters
    ----------
    triangles : (n, 3, 3) array of floats, or (n, 3) array of ints
        Corners of each triangle in metres, counter-clockwise as seen from its front; or, with
        ``vertices``, the row numbers of the corners there.
    vertices : (v, 3) array, optional
        Metres.
    normals : (n, 3, 3) or (v, 3) array, optional
        Shading normals of the corners or vertices, of any length; zero means flat.
    uv : (n, 3, 2) or (v, 2) array, optional
        Coordinates of the materials' textures, (0, 0) at the upper left.
    materials : sequence of Material
        A single white material if none is given.
    triangle_materials : (n,) array of ints, optional
        The material of each triangle; by default all have the first.
    lights : sequence of Light
        At least one, unless there are luminaires.
    luminaires : sequence of mappings
        Luminaires to place, see `load`; here y points up, too.
    cameras : sequence of Camera
        A camera that shows the whole scene if none is given.
    unit : {"lumen", "watt"}
        The unit of all powers: pictures are in cd/m2 or in W/(m2 sr).
    name : str
        For messages.

    Raises
    ------
    InputError
        For arrays that do not fit, missing triangles or lights, and NaN or infinite numbers.

    Notes
    -----
    Triangles without area, and those that coincide with others, are left out and counted in
    `dropped_triangles`; the library chooses the order in which it stores the corners of a triangle.
    """

    _core: _photile.Scene
    _north: float = 0.0
    """Degrees clockwise from -z."""
    _portals: Sequence[str] = ()
    """What the caller of `load` asked for."""
    _sky: tuple[Optional[float], Sequence[tuple[str, str]]] = (None, ())
    """The reflectance of the ground under the sky that was asked for, and what else results state of it."""

    def __init__(
        self,
        triangles: ArrayLike,
        vertices: Optional[ArrayLike] = None,
        *,
        normals: Optional[ArrayLike] = None,
        uv: Optional[ArrayLike] = None,
        materials: Sequence[Material] = (),
        triangle_materials: Optional[ArrayLike] = None,
        lights: Sequence[Light] = (),
        luminaires: Sequence[Luminaire] = (),
        cameras: Sequence[Camera] = (),
        unit: str = "lumen",
        name: str = "scene in memory",
    ) -> None:
        if vertices is None:
            corners = floats(triangles, "triangles", np.float64)
            if corners.ndim != 3 or corners.shape[1:] != (3, 3):
                raise InputError(
                    f"triangles: the array has shape {corners.shape}; it must have shape (n, 3, 3)"
                    " or, with vertices, (n, 3)"
                )
            points = np.ascontiguousarray(corners.reshape(-1, 3))
            faces = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
        else:
            points = floats(vertices, "vertices", np.float64)
            if points.ndim != 2 or points.shape[1] != 3:
                raise InputError(
                    f"vertices: the array has shape {points.shape}; it must have shape (v, 3)"
                )
            faces = _indices(triangles, len(points), "triangles")
            if faces.ndim != 2 or faces.shape[1] != 3:
                raise InputError(
                    f"triangles: the array has shape {faces.shape}; it must have shape (n, 3)"
                )
        materials = [_part(one, Material, "materials") for one in materials or (Material(),)]
        lights = [_part(one, Light, "lights") for one in lights]
        if triangle_materials is None:
            of_triangles = np.zeros(len(faces), np.uint32)
        else:
            of_triangles = _indices(triangle_materials, len(materials), "triangle_materials")
        shining = np.full(len(faces), _photile.none, np.uint32)
        for number, light in enumerate(lights):
            rows = _indices(light.triangles, len(faces), f"triangles of light '{light.name}'")
            shining[rows] = number
        self._core = _photile.build(
            name,
            unit,
            points,
            faces,
            _per_corner(normals, "normals", 3, faces, len(points)),
            _per_corner(uv, "uv", 2, faces, len(points)),
            of_triangles,
            shining,
            [_fields(material) for material in materials],
            [_fields(light) for light in lights],
            [_part(camera, Camera, "cameras")._parts() for camera in cameras],
            _luminaire_text(luminaires),
        )

    @property
    def _ground(self) -> float:
        """The reflectance of the ground below the horizon under a sky."""
        return _photile.ground_reflectance if self._sky[0] is None else self._sky[0]

    @classmethod
    def _of(cls, core: _photile.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._core = core
        return scene

    @property
    def unit(self) -> str:
        """"lumen" or "watt": the unit of the powers of `lights` and `layers`."""
        return self._core.unit

    @property
    def origin(self) -> Vector:
        """Where (0, 0, 0) of `vertices` and photons lies in the file's world, metres.

        It is (0, 0, 0) except for scenes that are far from there in relation to their size.
        """
        return self._core.origin

    @property
    def warnings(self) -> list[str]:
        """The warnings of the import, one line each."""
        return self._core.warnings

    @property
    def dropped_triangles(self) -> int:
        """The number of triangles that had no area or no finite corners, or coincided with others."""
        return self._core.dropped_triangles

    @property
    def vertices(self) -> NDArray[np.float32]:
        """(v, 3) metres from `origin`; a read-only view."""
        return self._core.vertices

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(n, 3) row numbers in `vertices`; a read-only view."""
        return self._core.triangles

    @property
    def triangle_material(self) -> NDArray[np.uint32]:
        """(n,) indices into `materials`; a read-only view."""
        return self._core.triangle_material

    @property
    def triangle_light(self) -> NDArray[np.uint32]:
        """(n,) indices into `lights`, ``photile.NONE`` for triangles that are not lights; a read-only
        view."""
        return self._core.triangle_light

    @property
    def triangle_normals(self) -> NDArray[np.float32]:
        """(n, 3) unit normals of the triangles' fronts."""
        return self._core.triangle_normals()

    @property
    def triangle_areas(self) -> NDArray[np.float64]:
        """(n,) square metres."""
        return self._core.triangle_areas()

    @property
    def materials(self) -> list[Material]:
        """The materials of the scene, without their textures."""
        return [Material(**fields) for fields in self._core.materials()]

    @property
    def lights(self) -> list[Light]:
        """The lights of the scene, with their triangles in it."""
        return [Light(**fields) for fields in self._core.lights()]

    @property
    def layers(self) -> dict[str, float]:
        """The power of each layer of the picture: of a light, or of the lights of a group."""
        return dict(self._core.layers())

    @property
    def cameras(self) -> list[Camera]:
        """The cameras of the file, or the one that was placed; there is always at least one."""
        return [
            Camera(position, vector(np.add(position, forward), "target"), up, float(np.degrees(angle)),
                   name, aspect)
            for name, position, forward, up, angle, aspect in self._core.cameras()
        ]

    def _camera(self, camera: Union[None, int, str, Camera]) -> Union[int, _photile.CameraParts]:
        """The camera as the extension takes it. Cameras of the scene keep all their bits."""
        if isinstance(camera, Camera):
            return camera._parts()
        names = [parts[0] for parts in self._core.cameras()]
        if isinstance(camera, str):
            if camera not in names:
                raise UsageError(f"there is no camera '{camera}'; there are {', '.join(names)}")
            return names.index(camera)
        number = camera or 0
        if not isinstance(number, (int, np.integer)):
            raise UsageError(f"camera: {camera!r} is neither a camera nor the name or number of one")
        if not 0 <= number < len(names):
            raise UsageError(f"there is no camera {number}; there are {len(names)}, counted from 0")
        return number

    def __repr__(self) -> str:
        return (
            f"<photile.Scene: {len(self.triangles)} triangles, {len(self.layers)} light layers>"
        )


def _part(part: Any, kind: type[_Part], name: str) -> _Part:
    if not isinstance(part, kind):
        raise UsageError(f"{name}: {reprlib.repr(part)} is not a photile.{kind.__name__}")
    return part


def _fields(part: Union[Material, Light]) -> dict[str, Any]:
    """The fields by name, with arrays unchanged."""
    return dict(part.__dict__)


def joined(values: Any, *separators: str) -> str:
    """The values in the form of the command line, whose parsers refuse what does not fit."""
    parts = [str(value) for value in values] if isinstance(values, (tuple, list)) else [str(values)]
    between = iter(separators)
    text, separator = "", ""
    for part in parts:
        text += separator + part
        separator = next(between, separator or separators[-1])
    return text


def _luminaire_text(luminaires: Sequence[Luminaire]) -> str:
    """The list as a file would have it, "" for none. Photometric files are relative to the current folder."""
    entries = []
    for number, luminaire in enumerate(luminaires, 1):
        if not isinstance(luminaire, Mapping):
            raise UsageError(f"luminaires: luminaire {number}: {reprlib.repr(luminaire)} is not a mapping; "
                             "give one, such as {'file': 'panel.ies', 'position': 'ceiling'}")
        entry = dict(luminaire)
        if isinstance(entry.get("file"), (str, os.PathLike)):
            entry["file"] = os.path.abspath(entry["file"])
        entries.append(entry)
    try:
        return json.dumps(entries, allow_nan=False, default=lambda value: value.tolist()) if entries else ""
    except (TypeError, ValueError, AttributeError, RecursionError):
        raise UsageError("luminaires: a value is NaN, infinite, or neither text nor numbers") from None


def shares(of: Optional[Mapping[str, float]]) -> list[str]:
    """Fractions of materials in the form of the command line."""
    return [f"{material}={share}" for material, share in (of or {}).items()]


def stated(scene: Scene, settings: Mapping[str, Any]) -> dict[str, Any]:
    """What reports state of a scene and of the settings of a measurement."""
    return {"photile": _photile.version, "scene": os.path.basename(scene._core.source),
            "date": f"{datetime.date.today()}", **_photile.stated(dict(settings))}


def load(
    file: File,
    *,
    scene: str = "",
    up: str = "",
    metres_per_unit: float = 1.0,
    emissive_scale: float = 1.0,
    allow_outside: bool = False,
    light_groups: Optional[Mapping[str, str]] = None,
    profiles: Optional[Mapping[str, File]] = None,
    temperatures: Optional[Mapping[str, float]] = None,
    panels: Optional[Mapping[str, tuple[float, float, float]]] = None,
    luminaires: Union[None, File, Sequence[Luminaire]] = None,
    environment: Optional[File] = None,
    environment_scale: float = 1.0,
    environment_rotation: float = 0.0,
    sun: Union[None, float, tuple[float, ...]] = None,
    sky: Union[None, tuple[str, float], tuple[str, float, float]] = None,
    site: Optional[tuple[float, float, float]] = None,
    time: Union[None, str, datetime.datetime] = None,
    weather: Optional[File] = None,
    north: float = 0.0,
    ground: float = 0.2,
    reflectance: Optional[Mapping[str, float]] = None,
    glass: Optional[Mapping[str, float]] = None,
    hide: Sequence[str] = (),
    portals: Sequence[str] = (),
    lumen_per_watt: float = _photile.lumen_per_watt,
    progress: Progress = None,
) -> Scene:
    """Read a scene from OBJ and MTL (.obj) or glTF 2.0 (.gltf, .glb).

    Parameters
    ----------
    file : path
        The scene.
    scene : str
        Name or number of one of the scenes in a glTF file; "" means the file's default.
    up : str
        The axis of the file that points up, "x" to "-z"; "" means y.
    metres_per_unit : float
        Metres per unit of the lengths in the file: 0.001 for millimetres.
    emissive_scale : float
        Factor of emissive radiance; 683 corrects files from Blender.
    allow_outside : bool
        Textures and buffers may lie outside the scene's folder.
    light_groups : mapping of patterns of light names to groups
        Lights of a group share a layer of the picture.
    profiles : mapping of light names to files
        LM-63 (.ies) or EULUMDAT (.ldt) files for point and spot lights.
    temperatures : mapping of light names to kelvin
        Colours of lights.
    panels : mapping of node names to (width, height, lumens)
        Luminous rectangles at nodes of a glTF file, metres; they emit along -z.
    luminaires : path or sequence of mappings, optional
        A file as of ``photile --luminaires``, or its entries, whose photometric files are then relative
        to the current folder: ``[{"file": "panel.ies", "position": "ceiling", "count": [2, 3],
        "spacing": [1.8, 2.4]}]``.
    environment : path, optional
        A picture of the surroundings, equirectangular.
    environment_scale, environment_rotation : float
        Factor of its texels, and degrees clockwise as seen from above.
    sun : (azimuth, elevation, lux) or (azimuth, elevation, lux, diameter) or lux, optional
        Degrees clockwise from north and above the horizon; lux on a surface that faces it; degrees. Its
        lux alone where `site` and `time` place it.
    sky : (kind, lux) or ("perez", direct, diffuse) or ("patches", count), optional
        "uniform", "overcast" or "clear"; lux on a horizontal surface. W/m2 facing the sun and on a
        horizontal surface. 145, 577 or 2305 lights.
    site : (latitude, longitude, time zone), optional
        Degrees north and east, hours ahead of UTC; by default that of `weather`.
    time : datetime or "YYYY-MM-DDTHH:MM", optional
        Standard time of the site. With `weather` the sky is that of the hour.
    weather : path, optional
        An EnergyPlus weather file (.epw).
    north : float
        Degrees clockwise from -z as seen from above.
    ground : float
        Reflectance of even ground below the horizon, which the sun and the sky light; 0 is black.
    reflectance, glass : mappings of patterns of material names to fractions, optional
        Reflectances; transmittances of what becomes clear glass.
    hide : sequence of patterns
        Nodes, meshes, objects and groups that are left out.
    portals : sequence of patterns
        Materials of windows; none searches for windows, "off" has none.
    lumen_per_watt : float
        The factor between lumens or lux and the watts of an OBJ scene.
    progress : callable or True, optional
        See `render`; here it only serves to notice Ctrl-C.

    Returns
    -------
    Scene

    Raises
    ------
    InputError
        Names the file and the remedy: the file is missing, malformed, beyond a limit or without lights.
    UsageError
        The file has no such scene or light.
    """
    windows = [portals] if isinstance(portals, str) else list(portals)
    options = {
        "scene": scene,
        "up": up,
        "metres_per_unit": metres_per_unit,
        "emissive_scale": emissive_scale,
        "allow_outside": allow_outside,
        "light_groups": [f"{glob}={group}" for glob, group in (light_groups or {}).items()],
        "profiles": [f"{light}={of}" for light, of in (profiles or {}).items()],
        "temperatures": [f"{light}={kelvin}" for light, kelvin in (temperatures or {}).items()],
        "panels": [f"{node}={joined(size, 'x', ',')}" for node, size in (panels or {}).items()],
        "environment": os.fspath(environment) if environment is not None else "",
        "environment_scale": environment_scale,
        "environment_rotation": environment_rotation,
        "sun": joined(sun, ",") if sun is not None else "",
        "sky": joined(sky, "=", ",") if sky is not None else "",
        "site": joined(site, ",") if site is not None else "",
        "time": f"{time:%Y-%m-%dT%H:%M}" if isinstance(time, datetime.datetime) else time or "",
        "weather": os.fspath(weather) if weather is not None else "",
        "north": north,
        "ground": ground,
        "reflectance": shares(reflectance),
        "glass": shares(glass),
        "hide": [hide] if isinstance(hide, str) else list(hide),
        "portals": windows,
        "luminaires": "",
        "luminaires_text": "",
        "lumen_per_watt": lumen_per_watt,
    }
    if isinstance(luminaires, (str, os.PathLike)):
        options["luminaires"] = os.fspath(luminaires)
    else:
        options["luminaires_text"] = _luminaire_text(luminaires or ())
    with heard_by(progress) as heard:
        loaded = Scene._of(_photile.load(os.fspath(file), options, heard))
    loaded._north, loaded._portals, loaded._sky = float(north), windows, _photile.sky_of(options)
    return loaded
