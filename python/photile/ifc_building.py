"""What photile takes from IFC files: elements as glTF, rooms, and light fixtures.

Needs ifcopenshell of PyPI, 0.8 or 0.9. Positions are in IFC's coordinates, z upwards, in metres, until
they are written: in scenes y points up, IFC's z becomes y and its y becomes -z.

The colours of a building are those of drawings, in sRGB. They become matt reflectances. Light passes
glass as data sheets state it, not as drawings colour it.
"""

from __future__ import annotations

import contextlib
import dataclasses
import importlib
import math
import os
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .command_line import one_line
from .converters import Gltf, in_child, in_scene, matt, unique, y_up
from .errors import InputError

__all__ = ["Building", "Fixture", "Room", "ifc_module", "in_ifc_child", "most_above_ceiling",
           "number_of", "open_ifc", "read", "wall_bands", "working_plane"]

# A file of a stranger may ask for more than a machine has.
_most_bytes = 1 << 30  # of an IFC file
_most_metres = 1e9  # of a coordinate
_most_elements, _most_triangles = 200_000, 20_000_000

_least_transparency = 0.3  # of a style, from which on it is glass
_transmittance = 0.78  # of a window without data: double glazing of clear glass
_most_transmittance = 0.92  # of a pane of clear glass
_index = 4 / 3  # of each face, so that both faces of a pane reflect what one pane of 1.5 does
_glass = re.compile(r"(?<!fiber)(?<!fibre)(?<!foam)"
                    r"(glass|glas|glazing|glazed|verglasung|verre|vitrage|vidrio|cristal|vetro)\b"
                    r"(?!\W*(wool|fib|block|mosaic))", re.IGNORECASE)  # names of styles
_grey = 0.5  # reflectance of what has no style, whose material has the name of its class

working_plane = 0.75  # metres above the floor
wall_bands = (0.5, 0.25, 0.1, 0.0)  # metres; narrow rooms have the first that leaves something
_least_height = 1.2  # metres of a room for people, as least_room of floor.hpp
_least_rectangle = 0.9  # of a floor by a rectangle, which then is its grid
_near_floor = 0.3  # metres above and below a room's floor, where that of the building is
_least_covered = 0.75  # of a room by elements above it, below which it has no ceiling
most_above_ceiling = 0.5  # metres that a room's luminaires may be above its body
_eye, _seated_eye = 1.6, 1.2  # metres above the floor
_off_body = 0.005  # metres from a fixture's body to its luminous opening
_least_opening = 0.05  # metres, of a luminaire whose file calls it a point
_lumens = ("LuminousFlux", "Luminous Flux", "TotalLuminousFlux", "ContributedLuminousFlux")
_watts = ("TotalWattage", "Wattage", "LightEmitterNominalPower", "NominalPower")
_far = 1000.0  # metres from its origin at which a float no longer tells apart 0.1 mm

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Room:
    """An IfcSpace with a floor. Coordinates are IFC's, in metres."""

    name: str  # number and long name
    number: str
    long_name: str
    storey: str
    global_id: str  # of the IfcSpace
    required: float | None  # lux, on average
    plan: Any  # shapely's polygon that the body covers
    outline: Any  # that of the floor where people stand: with something below, and 1.2 m of height
    floor: float  # height of the floor
    height: float  # of the body
    wall_band: float = 0.0  # left out along the outline
    measured: Any = None  # shapely's polygons without the wall band
    task: Any = None  # the largest rectangle in them
    doubt: str = ""  # why nobody measures it: "without a ceiling"

    @property
    def file(self) -> str:
        """Its name as that of a file."""
        return re.sub(r"[^\w .+-]", "_", self.name)

    @property
    def inside(self) -> Vector:
        """A point well inside."""
        middle = self.task.middle if self.task else self.outline.point_on_surface().coords[0]
        return np.array([*middle, self.floor + min(_eye, self.height / 2)])

    def holds(self, point: Vector) -> bool:
        """Whether a point is in the room, or in the void above its ceiling."""
        above = point[2] - self.floor
        return (-0.1 <= above <= self.height + most_above_ceiling
                and bool(_shapely().contains_xy(self.plan, *point[:2])))

    def record(self) -> dict[str, Any]:
        """The room in ``rooms.json``."""
        def ring(line: Any) -> list[list[float]]:
            return [in_scene([*corner, self.floor]) for corner in line.coords[:-1]]

        return {"name": self.name, "number": self.number, "long_name": self.long_name,
                "storey": self.storey, "area": round(self.outline.area, 4), "height": round(self.height, 4),
                "floor": round(self.floor, 4), "inside": in_scene(self.inside),
                "wall_band": self.wall_band, "outline": ring(self.outline.exterior),
                "holes": [ring(hole) for hole in self.outline.interiors], "plan": ring(self.plan.exterior),
                "required_illuminance": self.required, "global_id": self.global_id,
                "observers": self.file}

    def grid(self) -> dict[str, Any]:
        """The room's working plane in a file of ``--grid``; photile lays the points of EN 12464-1.

        The plane of a room that is no rectangle has an outline, and the spacing of the largest rectangle:
        that of a whole ring of corridors would miss them.
        """
        height = self.floor + working_plane
        plane: dict[str, Any] = {"name": self.name}
        area = self.task
        if area.area < _least_rectangle * self.measured.area:
            ring = _plans().one_ring(self.measured.simplify(0.01))  # the reader takes 1000 corners
            area = area.around(ring)
            plane |= {"spacing": round(self.task.spacing, 4), "outline": area.coordinates(ring).round(3).tolist()}
        return plane | {"origin": in_scene([*area.origin, height]), "u": in_scene([*area.u, 0]),
                        "v": in_scene([*area.v, 0])}

    def observers(self) -> str:
        """Lines of a file of ``--observers``: people who sit at the middles of the grid's rectangle and look
        across the room, as the observers of UGR tables do (CIE 190)."""
        lines = []
        for side in (self.task.u, -self.task.u, self.task.v, -self.task.v):
            eye = in_scene([*(self.task.middle - side / 2), self.floor + _seated_eye])
            lines.append(" ".join(f"{x:g}" for x in eye + in_scene([*side / np.linalg.norm(side), 0])))
        return "\n".join([*lines, ""])

    def camera(self) -> list[float]:
        """glTF's matrix of a view along the room."""
        along, across = self.task.u, self.task.v
        if np.linalg.norm(along) < np.linalg.norm(across):
            along, across = across, along
        way = np.array([*along, 0]) / np.linalg.norm(along)
        eye = [*(self.task.origin + across / 2), self.floor + min(_eye, 0.7 * self.height)]
        matrix = np.eye(4)
        matrix[:3] = np.transpose([np.cross(way, [0, 0, 1]), [0, 0, 1], -way, eye])
        return [float(value) for value in (y_up @ matrix).T.flat]


@dataclass
class Fixture:
    """A light fixture. Coordinates are IFC's, in metres."""

    kind: str  # its type
    tag: str
    placement: Vector  # 4 x 4
    body: Vector = field(default_factory=lambda: np.empty((0, 3)))  # corners of its body
    source: Any = None  # IfcLightSourceGoniometric
    lumens: float | None = None
    watts: float | None = None
    folder: Path = Path()  # of the IFC file, where files lie that light sources name
    degrees: float = 1.0  # in its unit of angles
    room: Room | None = None
    file: str = ""  # photometric file beside the scene

    @property
    def axes(self) -> Vector:
        """C0, the axis across, and the aim as columns.

        A light source's axis points away from its aim (IfcLightDistributionCurveEnum: the south pole
        is 0). Families of luminaires have an axis that points either way, or out of a wall: they
        shine along it downwards, and those of walls, whose photometry has its pole below, down.
        """
        x, aim = self.placement[:3, 0], -self.placement[:3, 2]
        if self.source is None:
            if abs(aim[2]) < 0.1:
                aim = np.array([0, 0, -1.0])
            aim = -aim if aim[2] > 0 else aim
        aim = aim / np.linalg.norm(aim)
        x = x - (x @ aim) * aim
        if np.linalg.norm(x) < 1e-3:
            x = self.placement[:3, 1] - (self.placement[:3, 1] @ aim) * aim
        x = x / np.linalg.norm(x)
        return np.transpose([x, np.cross(aim, x), aim])

    @property
    def position(self) -> Vector:
        """Of the luminous opening: before the body, or where a light source says."""
        if self.source is not None or not len(self.body):
            return np.array(self.placement[:3, 3])
        extent = self.body @ self.axes
        low, high = extent.min(axis=0), extent.max(axis=0)
        return np.array(self.axes @ [*((low + high) / 2)[:2], high[2] + _off_body])

    @property
    def size(self) -> list[float]:
        """Of the body along C0 and across, metres."""
        extent = np.ptp(self.body @ self.axes, axis=0) if len(self.body) else np.zeros(3)
        return [round(max(float(side), _least_opening), 4) for side in extent[:2]]


@dataclass
class Building:
    """What is read of one or several IFC files."""

    gltf: Gltf = field(default_factory=lambda: Gltf("photile import"))
    rooms: list[Room] = field(default_factory=list)
    fixtures: list[Fixture] = field(default_factory=list)
    glass: list[str] = field(default_factory=list)  # names of materials
    warnings: list[str] = field(default_factory=list)
    elements: int = 0
    triangles: int = 0
    north: float | None = None  # degrees clockwise from y; None where no file tells
    site: tuple[float, float] | None = None  # degrees north and east


def _shapely() -> Any:
    return importlib.import_module("shapely")


def _plans() -> Any:
    return importlib.import_module("photile.floor_plans")  # needs shapely


def ifc_module(module: str = "") -> Any:
    """A module of ifcopenshell, ".guid". Errors: ImportError."""
    return importlib.import_module(f"ifcopenshell{module}")


def in_ifc_child(files: list[Path], work: Callable[[], int]) -> int:
    """Do work with IFC files in a process of its own. Returns its exit code."""
    return in_child(work, f"photile: error: {', '.join(map(str, files))}: ifcopenshell ended without a "
                          "result; the file is damaged, or needs more memory than there is, or an hour: "
                          "export it again, or a part of it")


def open_ifc(file: Path) -> Any:
    """The model of an IFC file. Errors: InputError."""
    try:
        if not file.is_file():
            raise InputError(f"{file}: there is no such file; name an IFC file")
        size = file.stat().st_size
        with open(file, "rb") as stream:
            head = stream.read(1024)
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}; name an IFC file") from None
    if not head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"ISO-10303-21"):
        raise InputError(f"{file}: this is not an IFC file in STEP's format (.ifc); "
                         "unpack .ifczip, and export .ifcxml again")
    if size > _most_bytes:
        raise InputError(f"{file}: {size} bytes, more than {_most_bytes}; export a part of the building")
    ifc = ifc_module()
    try:
        return ifc.open(str(file), format=".ifc")  # whatever its name: others unpack without bounds
    except Exception as error:  # ifcopenshell raises what it likes on damaged files
        raise InputError(f"{file}: damaged: {error}; export it again") from None


@dataclass(frozen=True)
class _Style:
    """Of a surface. Those without a name are ifcopenshell's own, for what has none."""

    name: str
    colour: tuple[float, ...]  # linear
    transparency: float

    @staticmethod
    def of(style: Any, model: Any) -> _Style:
        if not style.instance_id():
            return _no_style
        entity = model.by_id(style.instance_id())
        if entity.is_a("IfcSurfaceStyleShading"):
            entity = next(iter(model.get_inverse(entity)), None)
        opaque = not style.transparency > 0  # not a number where it is not stated
        return _Style(one_line(getattr(entity, "Name", None) or style.name),
                      tuple(_linear(value) for value in style.diffuse.components),
                      0.0 if opaque else style.transparency)


_no_style = _Style("", (_grey,) * 3, 0.0)


@dataclass(frozen=True)
class _Body:
    """Triangles that elements share, each with the number of a style."""

    vertices: Vector  # (n, 3)
    triangles: NDArray[np.int32]  # (m, 3)
    of_triangle: NDArray[np.int32]  # (m,)
    styles: dict[int, _Style]  # those that triangles have

    @staticmethod
    def of(geometry: Any, model: Any) -> _Body:
        """Of what is a number."""
        vertices = np.frombuffer(geometry.verts_buffer, "d").reshape(-1, 3)
        triangles = np.frombuffer(geometry.faces_buffer, "i").reshape(-1, 3)
        there = (np.abs(vertices) < _most_metres).all(axis=1)  # not NaN either
        good = there[triangles].all(axis=1)
        of_triangle = np.frombuffer(geometry.material_ids_buffer, "i")[good]
        styles = {one: _Style.of(geometry.materials[one], model) if one >= 0 else _no_style
                  for one in np.unique(of_triangle).tolist()}
        return _Body(np.where(there[:, None], vertices, 0.0), triangles[good], of_triangle, styles)


@dataclass(frozen=True)
class _Placed:
    """A body at an element."""

    element: Any
    shared: str  # by what elements share the body
    body: _Body
    matrix: Vector  # 4 x 4

    @property
    def vertices(self) -> Vector:
        """In the building's coordinates."""
        return np.asarray(self.body.vertices @ self.matrix[:3, :3].T + self.matrix[:3, 3])


def _bodies(model: Any, elements: list[Any], title: str, most: int) -> list[_Placed]:
    """Elements with triangles, with openings cut out, in the order of the file.

    Errors: InputError where they have more triangles than `most`.
    """
    if not elements:
        return []
    geom, shape_of = ifc_module(".geom"), ifc_module(".util.shape")
    iterator = geom.iterator(geom.settings(), model, os.cpu_count() or 1, include=elements)
    bodies: dict[str, _Body] = {}
    placed = []
    with _progress(title, iterator) as tell:
        more = iterator.initialize()
        while more:
            shape = iterator.get()  # is there until the next one, and comes in any order
            shared = shape.geometry.id
            if shared not in bodies:
                bodies[shared] = _Body.of(shape.geometry, model)
            matrix = np.array(shape_of.get_shape_matrix(shape), float)
            count = len(bodies[shared].triangles)
            if count and _is_placement(matrix):
                placed.append(_Placed(model.by_id(shape.id), shared, bodies[shared], matrix))
            most -= count
            if most < 0:
                raise InputError(f"{title}: more than {_most_triangles} triangles; export a part of it")
            tell()
            more = iterator.next()
    return sorted(placed, key=lambda one: int(one.element.id()))


@contextlib.contextmanager
def _progress(title: str, iterator: Any) -> Iterator[Callable[[], None]]:
    """Tells on a terminal how much is done, in a line that is gone afterwards."""
    shown = sys.stderr.isatty()

    def tell() -> None:
        if shown:
            print(f"\r{title}: {iterator.progress()}%", end="", file=sys.stderr)

    try:
        yield tell
    finally:
        if shown:
            print("\r\33[K", end="", file=sys.stderr)


def _linear(srgb: float) -> float:
    """IEC 61966-2-1."""
    value = min(max(srgb, 0.0), 1.0)
    return value / 12.92 if value <= 0.04045 else float(((value + 0.055) / 1.055) ** 2.4)


def number_of(value: Any) -> float | None:
    """A number, or that at the beginning of a text: "18 W"."""
    found = re.match(r"\s*[-+]?\d+(\.\d*)?([eE][-+]?\d+)?", str(value))
    number = float(found[0]) if found and not isinstance(value, bool) else math.nan
    return number if math.isfinite(number) else None


def _property(element: Any, names: tuple[str, ...]) -> float | None:
    """The first number above 0 of these properties of an element or its type."""
    values = {name: value for properties in ifc_module(".util.element").get_psets(element).values()
              for name, value in properties.items()}
    numbers = (number_of(values[name]) for name in names if name in values)
    return next((number for number in numbers if number is not None and number > 0), None)


class _Materials:
    """glTF's materials by what makes them differ."""

    def __init__(self, building: Building) -> None:
        self._building = building
        self._numbers: dict[tuple[Any, ...], int] = {}
        self._names: dict[str, int] = {}

    def of(self, style: _Style, element: Any, alone: bool) -> int:
        """The material of a style on an element.

        alone   whether the element has no other style: a window that is one body is its pane
        """
        name = style.name or element.is_a()
        passes = 0.0
        if (style.transparency >= _least_transparency or _glass.search(name)
                or (alone and element.is_a("IfcWindow"))):
            stated = _property(element, ("VisibleLightTransmittance", "VisibleTransmittance"))
            passes = stated if stated and stated <= _most_transmittance else _transmittance
        key = (name, passes or tuple(round(value, 3) for value in style.colour))
        if key not in self._numbers:
            found = unique(name, self._names)
            material = _pane(found, passes) if passes else matt(found, style.colour)
            if passes:
                self._building.glass.append(f"{found} {passes:.2g}")
            self._numbers[key] = self._building.gltf.material(material)
        return self._numbers[key]


def _pane(name: str, transmittance: float) -> dict[str, Any]:
    """Clear glass of which a pane is a body: light passes two of its faces.

    transmittance   of the pane at normal incidence. Two faces of reflectance R, each of which
                    transmits T, transmit T^2 / (1 - R^2).
    """
    fresnel = ((_index - 1) / (_index + 1)) ** 2
    reflects = 2 * fresnel / (1 + fresnel)
    tint = math.sqrt(transmittance * (1 - reflects**2)) / (1 - reflects)
    return {"name": name, "doubleSided": True,
            "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.0,
                                     "baseColorFactor": [tint, tint, tint, 1.0]},
            "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1.0},
                           "KHR_materials_ior": {"ior": _index}}}


def _north(model: Any) -> float | None:
    """Degrees clockwise from the y axis."""
    for context in model.by_type("IfcGeometricRepresentationContext", include_subtypes=False):
        if context.TrueNorth:
            x, y = context.TrueNorth.DirectionRatios[:2]
            return round(math.degrees(math.atan2(x, y)), 3) + 0.0
    return None


def _site(model: Any) -> tuple[float, float] | None:
    """Degrees north and east."""
    for site in model.by_type("IfcSite"):
        if site.RefLatitude and site.RefLongitude:
            # Degrees, minutes, seconds and their millionths, all of one sign.
            latitude, longitude = (sum(part / size for part, size in zip(angle, (1, 60, 3600, 3.6e9)))
                                   for angle in (site.RefLatitude, site.RefLongitude))
            return round(latitude, 4), round(longitude, 4)
    return None


def _storey(element: Any) -> str:
    util = ifc_module(".util.element")
    for _ in range(100):  # a damaged file may hold itself
        if element is None or element.is_a("IfcBuildingStorey"):
            break
        element = util.get_container(element) or util.get_aggregate(element)
    return one_line(getattr(element, "Name", None) or "")


class _Reader:
    """Adds files to a building, and keeps apart what has the same name in several of them."""

    def __init__(self) -> None:
        self.building = Building()
        self._materials = _Materials(self.building)
        self._rooms: dict[str, int] = {}
        self._kinds: dict[str, int] = {}
        self._elements: list[tuple[_Placed, Vector, Vector]] = []  # with two corners of their boxes

    def add(self, model: Any, title: str) -> None:
        """Errors: InputError where the file asks for more than the limits."""
        if self.building.north is None:
            self.building.north = _north(model)
        if self.building.site is None:
            self.building.site = _site(model)
        self._add_elements(model, title, self._add_fixtures(model, Path(title).parent))
        self._add_rooms(model, title)

    def _add_elements(self, model: Any, title: str, fixtures: dict[int, list[Fixture]]) -> None:
        """Draw the building elements: a node for each, named as it is, below that of its storey; its
        mesh is named by its class."""
        building = self.building
        elements = [element for element in model.by_type("IfcElement")
                    if not element.is_a("IfcFeatureElement") and not element.is_a("IfcVirtualElement")]
        if building.elements + len(elements) > _most_elements:
            raise InputError(f"{title}: more than {_most_elements} elements; export a part of it")
        storeys: dict[str, int] = {}
        meshes: dict[tuple[Any, ...], tuple[int, Vector]] = {}
        shown: set[int] = set()
        for placed in _bodies(model, elements, title, _most_triangles - building.triangles):
            element, body, vertices = placed.element, placed.body, placed.vertices
            shown.add(element.id())
            building.elements += 1
            building.triangles += len(body.triangles)
            self._elements.append((placed, vertices.min(axis=0), vertices.max(axis=0)))
            for fixture in fixtures.get(element.id(), ()):
                fixture.body = vertices
            materials = {one: self._materials.of(style, element, len(body.styles) == 1)
                         for one, style in body.styles.items()}
            key = (placed.shared, element.is_a(), *materials.items())
            if key not in meshes:
                far = np.abs(body.vertices).max() > _far
                middle = np.round(body.vertices[body.triangles[0, 0]]) if far else np.zeros(3)
                points = building.gltf.points(body.vertices - middle)
                meshes[key] = building.gltf.mesh(element.is_a(), [
                    (points, building.gltf.triangles(body.triangles[body.of_triangle == one]), material)
                    for one, material in materials.items()]), middle
            mesh, middle = meshes[key]
            storey = _storey(element)
            if storey not in storeys:
                storeys[storey] = building.gltf.node(name=storey or "no storey")
            matrix = y_up @ placed.matrix
            matrix[:3, 3] += matrix[:3, :3] @ middle
            building.gltf.node(storeys[storey], name=one_line(element.Name or element.is_a()), mesh=mesh,
                               matrix=[float(value) for value in matrix.T.flat])
        lost = [element for element in elements if element.id() not in shown and _has_body(element)]
        if lost:
            names = ", ".join(one_line(element.Name or element.is_a()) for element in lost[:3])
            building.warnings.append(f"{title}: {len(lost)} elements whose bodies have no triangles are "
                                     f"left out: {names}{', ...' if len(lost) > 3 else ''}")

    def _doubt_of(self, room: Room) -> str:
        """Why nobody would measure a room, such as one on a roof; "" = he would."""
        if room.height < _least_height:
            return f"lower than {_least_height} m"
        steps = (np.arange(5) + 0.5) / 5
        points = np.array([room.task.origin + u * room.task.u + v * room.task.v
                           for u in steps for v in steps])
        low, high, height = points.min(axis=0), points.max(axis=0), room.floor + working_plane
        covered = np.zeros(len(points), bool)
        for placed, lowest, highest in self._elements:
            if (lowest[:2] > high).any() or (highest[:2] < low).any() or highest[2] < height:
                continue
            corners = placed.vertices[placed.body.triangles]
            corners = corners[corners[:, :, 2].max(axis=1) > height]
            edges = (np.roll(corners, -1, axis=1) - corners)[..., :2]
            twice = _cross(edges[:, 0], edges[:, 1])  # the area in plan
            upright = np.abs(twice) < 1e-9
            corners, edges, twice = corners[~upright], edges[~upright], twice[~upright, None]
            # Barycentric coordinates: each edge gives that of the corner across from it.
            weights = _cross(edges, points[:, None, None] - corners[..., :2]) / twice
            above = (weights * np.roll(corners[..., 2], 1, axis=1)).sum(axis=2) > height
            covered |= ((weights >= 0).all(axis=2) & above).any(axis=1)
        return "without a ceiling" if covered.mean() < _least_covered else ""

    def _add_rooms(self, model: Any, title: str) -> None:
        spaces = [space for space in model.by_type("IfcSpace")
                  if not any(part.is_a("IfcSpace") for part in ifc_module(".util.element").get_parts(space))]
        placed = _bodies(model, spaces, f"{title}: rooms", _most_triangles)
        lux = ifc_module(".util.unit").calculate_unit_scale(model, "ILLUMINANCEUNIT")
        if len(placed) < len(spaces):
            self.building.warnings.append(f"{title}: {len(spaces) - len(placed)} rooms (IfcSpace) have no "
                                          "body and are left out")
        rooms = [room for one in placed if (room := self._room(one, lux)) is not None]
        # A file of another discipline may repeat rooms.
        rooms = [room for room in rooms if not any(known.number == room.number and known.holds(room.inside)
                                                   for known in self.building.rooms)]
        self.building.rooms += sorted(rooms, key=lambda room: (round(room.floor, 1), room.name))

    def _room(self, placed: _Placed, lux: float) -> Room | None:
        """A room without its grid."""
        plans = _plans()
        space, vertices, triangles = placed.element, placed.vertices, placed.body.triangles
        number, long_name = one_line(space.Name or ""), one_line(space.LongName or "")
        name = number if long_name in number else f"{number} {long_name}".strip()
        floor = plans.floor_height(vertices, triangles)
        height = float(vertices[:, 2].max()) - floor
        outline = plans.section(vertices, triangles, floor + min(_least_height, height / 2))
        if outline is None:
            self.building.warnings.append(f"room '{name}' has no floor and is left out")
            return None
        required = _property(space, ("Illuminance",))
        return Room(name or "room", number, long_name, _storey(space), space.GlobalId,
                    required and required * lux, plans.shadow_of(vertices, triangles), outline, floor,
                    height)

    def finish_rooms(self) -> None:
        """Give rooms their grids, now that all floors are known, and names that keep them apart."""
        rooms, self.building.rooms = self.building.rooms, []
        for room in rooms:
            outline = _plans().without_voids(room.outline, self._floors_of(room))
            for band in wall_bands:
                measured = _plans().inset(outline, band)
                task = _plans().largest_rectangle(measured)
                if task is not None:
                    break
            else:
                self.building.warnings.append(f"room '{room.name}' is too small for a grid and is left out")
                continue
            room = dataclasses.replace(room, name=unique(room.name, self._rooms), outline=outline,
                                       measured=measured, wall_band=band, task=task)
            self.building.rooms.append(dataclasses.replace(room, doubt=self._doubt_of(room)))

    def _floors_of(self, room: Room) -> Vector:
        """What elements have at a room's floor, as triangles (m, 3, 3)."""
        low, high = room.floor - _near_floor, room.floor + _near_floor
        left, below, right, ahead = room.outline.bounds
        found = [np.empty((0, 3, 3))]
        for placed, lowest, highest in self._elements:
            if (lowest < (right, ahead, high)).all() and (highest > (left, below, low)).all():
                corners = placed.vertices[placed.body.triangles]
                found.append(_plans().between(corners, low, high))
        return np.concatenate(found)

    def _add_fixtures(self, model: Any, folder: Path) -> dict[int, list[Fixture]]:
        """Fixtures by their elements' numbers, still without bodies."""
        element_of, unit = ifc_module(".util.element"), ifc_module(".util.unit")
        scale = unit.calculate_unit_scale(model)
        power = unit.calculate_unit_scale(model, "POWERUNIT")
        degrees = math.degrees(unit.calculate_unit_scale(model, "PLANEANGLEUNIT"))
        kinds: dict[Any, str] = {}
        fixtures: dict[int, list[Fixture]] = {}
        for element in model.by_type("IfcFlowTerminal"):
            kind = element_of.get_type(element)
            if not (element.is_a("IfcLightFixture") or (kind and kind.is_a("IfcLightFixtureType"))):
                continue
            own, tag = one_line(element.Name or ""), one_line(element.Tag or element.GlobalId)
            label = one_line((kind and kind.Name) or element.ObjectType or own or "fixture")
            if own.endswith(f":{tag}"):  # Revit: FAMILY:TYPE:TAG, where all families have a type "100W"
                label = ":".join(dict.fromkeys(own.split(":")[:-1]))
            identity = kind.id() if kind else label
            if identity not in kinds:
                kinds[identity] = unique(label, self._kinds)
            watts = _property(element, _watts)
            known: dict[str, Any] = {
                "kind": kinds[identity], "tag": tag, "folder": folder, "degrees": degrees,
                "lumens": _property(element, _lumens),
                "watts": None if watts is None else watts * power}
            sources = list(_sources(element)) or [(None, _placement(element))]
            for source, placement in sources:
                placement[:3, 3] *= scale
                if _is_placement(placement):
                    fixture = Fixture(placement=placement, source=source, **known)
                    fixtures.setdefault(element.id(), []).append(fixture)
                    self.building.fixtures.append(fixture)
        return fixtures


def _cross(a: Vector, b: Vector) -> Vector:
    """In plan."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _has_body(element: Any) -> bool:
    shape = element.Representation
    return shape is not None and any(one.RepresentationIdentifier == "Body"
                                     for one in shape.Representations)


def _is_placement(matrix: Vector) -> bool:
    """Whether it has an inverse and places what it moves within the limit."""
    return bool((np.abs(matrix) < _most_metres).all()) and abs(np.linalg.det(matrix)) > 1e-9


def _placement(element: Any) -> Vector:
    """Of an element, in the file's unit."""
    if element.ObjectPlacement is None:
        return np.eye(4)
    return np.array(ifc_module(".util.placement").get_local_placement(element.ObjectPlacement), float)


def _sources(element: Any) -> Iterator[tuple[Any, Vector]]:
    """The goniometric light sources of an element, and their axes in the file's unit."""
    util = ifc_module(".util.placement")
    for shape in element.Representation.Representations if element.Representation else ():
        for item in shape.Items:
            items, inner = [item], np.eye(4)
            if item.is_a("IfcMappedItem"):
                items = item.MappingSource.MappedRepresentation.Items
                inner = util.get_mappeditem_transformation(item)
            for source in items:
                if source.is_a("IfcLightSourceGoniometric"):
                    axes = util.get_axis2placement(source.Position)
                    yield source, np.array(_placement(element) @ inner @ axes, float)


def read(files: list[Path]) -> Building:
    """Read IFC files that share their coordinates, such as those of architecture and electricity.

    Errors: InputError naming the file; ImportError where ifcopenshell is missing.
    """
    reader = _Reader()
    building = reader.building
    for file in files:
        model = open_ifc(file)
        try:
            reader.add(model, str(file))
        except (InputError, ImportError, MemoryError):
            raise
        except Exception as error:  # ifcopenshell raises what it likes on damaged files
            raise InputError(f"{file}: damaged: {error}; export it again") from None
    if not building.triangles:
        raise InputError(f"{files[0]}: no element has triangles; export bodies, not only lines")
    reader.finish_rooms()
    for fixture in building.fixtures:
        fixture.room = next((room for room in building.rooms if room.holds(fixture.position)), None)
    return building
