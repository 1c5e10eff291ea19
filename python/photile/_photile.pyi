"""The compiled part of the package; the package's other modules say what arrays it takes."""

from typing import Any, Callable, Optional, Union

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Doubles = NDArray[np.float64]
Numbers = NDArray[np.uint32]
Vector = tuple[float, float, float]
CameraParts = tuple[str, Vector, Vector, Vector, float, float]
Changes = list[tuple[str, str]]
Callback = Optional[Callable[[str, int, int, str], object]]

version: str
none: int
lumen_per_watt: float

def devices() -> list[dict[str, Any]]: ...
def test_devices(selector: str) -> str: ...
def setting_names() -> list[str]: ...

class ArrayMemory:
    """Memory of the library, of which numpy makes the arrays that functions return."""

class Scene:
    @property
    def source(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def origin(self) -> Vector: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def dropped_triangles(self) -> int: ...
    @property
    def vertices(self) -> Floats: ...
    @property
    def triangles(self) -> Numbers: ...
    @property
    def triangle_material(self) -> Numbers: ...
    @property
    def triangle_light(self) -> Numbers: ...
    def triangle_normals(self) -> Floats: ...
    def triangle_areas(self) -> Doubles: ...
    def lights(self) -> list[dict[str, Any]]: ...
    def materials(self) -> list[dict[str, Any]]: ...
    def layers(self) -> list[tuple[str, float]]: ...
    def cameras(self) -> list[CameraParts]: ...

def load(file: str, options: dict[str, Any], progress: Callback) -> Scene: ...
def build(
    name: str,
    unit: str,
    vertices: Floats,
    triangles: Numbers,
    normals: Floats,
    uv: Floats,
    triangle_materials: Numbers,
    triangle_lights: Numbers,
    materials: list[dict[str, Any]],
    lights: list[dict[str, Any]],
    cameras: list[CameraParts],
) -> Scene: ...

class Photons:
    def __len__(self) -> int: ...
    @property
    def position(self) -> Floats: ...
    @property
    def flux(self) -> Floats: ...
    @property
    def incoming(self) -> Floats: ...
    @property
    def light(self) -> NDArray[np.uint16]: ...
    @property
    def sided_triangle(self) -> Numbers: ...
    def normals(self, scene: Scene) -> Floats: ...
    @property
    def emitted_per_light(self) -> list[int]: ...
    @property
    def absorbed_flux_per_light(self) -> list[float]: ...
    @property
    def escaped_flux_per_light(self) -> list[float]: ...

def trace(
    scene: Scene,
    count: int,
    seed: int,
    quota: str,
    store_direct: bool,
    max_path_length: int,
    progress: Callback,
) -> Photons: ...

class PhotonMaps:
    def __init__(
        self,
        positions: Floats,
        normals: Optional[Floats],
        flux: Optional[Floats],
        lights: Optional[NDArray[np.uint16]],
        radius: float,
        neighbours: int,
        angle: float,
        photons_per_cell: float,
        device: str,
        progress: Callback,
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def radius(self) -> float: ...
    def statistics(self) -> dict[str, Any]: ...
    def nearest(
        self, points: Floats, normals: Optional[Floats], k: int, radius: float
    ) -> tuple[Numbers, Floats]: ...
    def irradiance(
        self, points: Floats, normals: Optional[Floats], k: int, radius: float, kernel: str
    ) -> Floats: ...

class Picture:
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def lumen_per_watt(self) -> float: ...
    @property
    def statistics(self) -> list[dict[str, Any]]: ...
    @property
    def radius(self) -> float: ...
    def lights(self, changes: Changes) -> list[dict[str, Any]]: ...
    def unit_layer(self, light: str) -> Floats: ...
    def unit_illuminance(self, light: str) -> Floats: ...
    def mix(self, changes: Changes) -> Floats: ...
    def displayed(
        self, changes: Changes, exposure: Optional[float], automatic: bool, display: str
    ) -> Floats: ...
    def save_exr(self, file: str, changes: Changes) -> None: ...
    def save_png(
        self,
        file: str,
        changes: Changes,
        exposure: Optional[float],
        automatic: bool,
        display: str,
    ) -> None: ...

def render(
    scene: Scene,
    camera: Union[int, CameraParts],
    size: Optional[tuple[int, int]],
    integrator: str,
    settings: dict[str, Any],
    lumen_per_watt: float,
    device: str,
    progress: Callback,
) -> Picture: ...
def read_picture(file: str) -> Picture: ...
def measure(
    scene: Scene,
    points: Doubles,
    normals: Doubles,
    rays: int,
    repeats: int,
    cylindrical: bool,
    integrator: str,
    maintenance: float,
    lumen_per_watt: float,
    settings: dict[str, Any],
    device: str,
    progress: Callback,
) -> list[tuple[str, Doubles, Doubles]]: ...
