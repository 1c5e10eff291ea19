"""photile: photon mapping on OpenCL devices, with a layer of the picture for each light.

Scenes come from files (`load`) or arrays (`Scene`). `trace` returns photons as arrays, `PhotonMaps`
finds the nearest photons on an OpenCL device, `neighbours` the nearest points, `render` returns a
picture with a layer for each light, `Picture.mix` changes its lights, `relight` those of a file, and
`measure` returns lux at points. Units are metres, lumens (or watts), cd/m2 and lux; arrays are
numpy's.

Long work releases the interpreter's lock, stops on Ctrl-C and reports its progress to a callback.
"""

from typing import Any

from . import _photile
from .errors import (
    DeviceError,
    DeviceMemoryError,
    Error,
    InputError,
    KernelBuildError,
    OutputError,
    UsageError,
)
from .glare_ratings import Glare, glare
from .grids import Grid, grid, grids, rooms
from .years import Daylight, daylight
from .measuring import Illuminance, measure
from .outlooks import SunHours, ViewOut, sun_hours, view_out
from .photons import NONE, Neighbours, PhotonMaps, Photons, neighbours, trace
from .pictures import SETTINGS, LightState, Picture, png_of, relight, render
from .reports import write_report
from .scenes import Camera, Light, Material, Scene, load

__version__: str = _photile.version

__all__ = [
    "NONE", "SETTINGS", "Camera", "Daylight", "DeviceError", "DeviceMemoryError", "Error", "Glare", "Grid",
    "Illuminance", "InputError", "KernelBuildError", "Light", "LightState", "Material",
    "Neighbours", "OutputError", "PhotonMaps", "Photons", "Picture", "Scene", "SunHours", "UsageError",
    "ViewOut",
    "daylight", "devices", "glare", "grid", "grids", "load", "measure", "neighbours", "png_of", "relight", "render",
    "rooms", "sun_hours", "test_devices", "trace", "view_out", "write_report",
]


def devices() -> list[dict[str, Any]]:
    """The OpenCL devices: id, name, platform, type, memory and more of each."""
    return _photile.devices()


def test_devices(device: str = "") -> str:
    """Test devices, which takes seconds: "" if they compute correctly, else a line about what is wrong.

    Parameters
    ----------
    device : str
        As for `render`.
    """
    return _photile.test_devices(device)


test_devices.__test__ = False  # type: ignore[attr-defined]  # it is not a test of pytest's
