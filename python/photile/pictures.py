"""Pictures with a layer for each light."""

from __future__ import annotations

import io
import os
import struct
import zlib
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _photile
from .errors import InputError, UsageError
from .progress import Progress, heard_by
from .scenes import Camera, File, Scene

__all__ = ["Changes", "LightState", "Picture", "SETTINGS", "relight", "render"]

SETTINGS: tuple[str, ...] = tuple(_photile.setting_names())
"""Names of the settings that `render` and `measure` take; see docs/reference/settings.md."""

_LONGEST_SHOWN = 1024  # pixels: a notebook is hardly wider
Change = Union[float, str]
Changes = Optional[Mapping[str, Change]]


class LightState(NamedTuple):
    """The state of a light layer in a picture."""

    power: float
    """In `unit`."""
    unit: str
    """"lumen" or "watt"; luminaires with a photometric file have lumens in every scene."""
    color: tuple[float, float, float]
    """Linear RGB of the light itself; luminance 1."""
    tint: tuple[float, float, float]
    """An additional factor of its layer."""
    members: list[str]
    """The lights of a group; empty for a single light."""


class Picture(Mapping[str, NDArray[np.float32]]):
    """Layers by the names of their lights, each at the light's power.

    ``picture["desk_lamp"]`` is a new array of shape (height, width, 3): linear RGB with Rec.709
    primaries, cd/m2 (or W/(m2 sr) where all lights have watts), row 0 at the top. `unit_layer` is a
    view at a power of 1. Layers add up to `mix`.

    Changes of lights are a mapping of names to a factor of the power (``2``, ``0.5``, ``0``), or to
    text as for `photile relight`: ``"1500lm"``, ``"x2"``, ``"2700K"``, ``"#ffb070"``, ``"off"``.
    """

    def __init__(self, core: _photile.Picture, changes: Changes = None) -> None:
        self._core = core
        self._changes = listed(changes)
        self._core.lights(self._changes)  # refuses what cannot be done

    @property
    def width(self) -> int:
        """Pixels."""
        return self._core.width

    @property
    def height(self) -> int:
        """Pixels."""
        return self._core.height

    @property
    def lights(self) -> dict[str, LightState]:
        """Powers and colours by layer."""
        return {
            row["name"]: LightState(
                row["power"], row["unit"], row["color"], row["tint"], row["members"]
            )
            for row in self._core.lights(self._changes)
        }

    @property
    def statistics(self) -> list[dict[str, Any]]:
        """The cost of each stage of the rendering: seconds, processor seconds, bytes, figures."""
        return self._core.statistics

    def __getitem__(self, light: str) -> NDArray[np.float32]:
        layer = self._core.unit_layer(light)
        row = next(row for row in self._core.lights(self._changes) if row["name"] == light)
        scale = row["power_in_picture"] * np.array(row["tint"])
        scaled: NDArray[np.float32] = layer * scale.astype(np.float32)
        return scaled

    def __iter__(self) -> Iterator[str]:
        return iter(self.lights)

    def __len__(self) -> int:
        return len(self.lights)

    def unit_layer(self, light: str) -> NDArray[np.float32]:
        """(height, width, 3) radiance where the light's power is 1; a read-only view."""
        return self._core.unit_layer(light)

    def illuminance(self, light: Optional[str] = None) -> NDArray[np.float32]:
        """(height, width) lux of the visible surfaces, from one light or from all together."""
        if light is None:
            total = np.zeros((self.height, self.width), np.float32)
            for name in self:
                total += self.illuminance(name)
            return total
        layer = self._core.unit_illuminance(light)
        state = self.lights[light]
        lumens = 1.0 if state.unit == "lumen" else self._core.lumen_per_watt
        return layer * np.float32(state.power * lumens)

    def mix(self, changes: Changes = None) -> NDArray[np.float32]:
        """The picture with changed lights, in the time that it takes to add its layers.

        Parameters
        ----------
        changes : mapping of names to factors or text, optional
            See the class.

        Returns
        -------
        (height, width, 3) array
            Linear RGB, cd/m2 or W/(m2 sr).

        Raises
        ------
        UsageError
            There is no such light, the value is not a change of a light, or a light that is off in a
            picture from a file is to be turned up.
        """
        return self._core.mix(self._changes + listed(changes))

    def relit(self, changes: Changes) -> Picture:
        """The same layers with changed lights; nothing is copied. Errors as for `mix`."""
        return _changed(self._core, self._changes + listed(changes))

    def display(
        self,
        changes: Changes = None,
        *,
        exposure: float = 0.0,
        automatic: bool = True,
        view: str = "neutral",
    ) -> NDArray[np.uint8]:
        """The picture as a screen shows it.

        Parameters
        ----------
        changes : mapping, optional
            See the class.
        exposure : float
            Stops, on top of the automatic exposure.
        automatic : bool
            Scale so that the log-average luminance becomes 0.36 of white; else 1 cd/m2 is white.
        view : {"neutral", "standard"}
            Khronos PBR Neutral, or the sRGB curve alone.

        Returns
        -------
        (height, width, 3) array of uint8
            sRGB.
        """
        return _in_srgb(self._core.displayed(
            self._changes + listed(changes),
            {"exposure": exposure, "automatic": automatic, "view": view},
        ))

    def save(
        self,
        file: File,
        changes: Changes = None,
        *,
        exposure: float = 0.0,
        automatic: bool = True,
        view: str = "neutral",
    ) -> None:
        """Write an EXR with all layers, or a PNG.

        Parameters
        ----------
        file : path
            Ends in .exr or .png.
        changes : mapping, optional
            See the class.
        exposure, automatic, view
            For a PNG, as for `display`.

        Raises
        ------
        OutputError
            The file cannot be written; an existing file is kept then.
        UsageError
            The name has another ending.
        """
        name, all_changes = os.fspath(file), self._changes + listed(changes)
        if name.lower().endswith(".exr"):
            self._core.save_exr(name, all_changes)
        elif name.lower().endswith(".png"):
            display = {"exposure": exposure, "automatic": automatic, "view": view}
            self._core.save_png(name, all_changes, display)
        else:
            raise UsageError(f"{name}: pictures are written as .exr or .png")

    def _repr_png_(self) -> bytes:
        """What Jupyter shows: `display`, with means of blocks of pixels where a side is longer than
        1024 pixels."""
        linear = self._core.displayed(
            self._changes, {"exposure": 0.0, "automatic": True, "view": "neutral"})
        block = -(-max(self.width, self.height) // _LONGEST_SHOWN)
        high, wide = min(block, self.height), min(block, self.width)
        rows, columns = self.height // high, self.width // wide
        blocks = linear[:rows * high, :columns * wide].reshape(rows, high, columns, wide, 3)
        return png_of(_in_srgb(blocks.mean(axis=(1, 3))))

    def __repr__(self) -> str:
        return f"<photile.Picture: {self.width} x {self.height}, {len(self)} light layers>"


def _in_srgb(linear: NDArray[np.float32]) -> NDArray[np.uint8]:
    curve = np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055
    )
    return (np.clip(curve, 0, 1) * 255 + 0.5).astype(np.uint8)


def png_of(pixels: NDArray[np.uint8]) -> bytes:
    """A PNG of (height, width, 3) sRGB values, such as those of `Picture.display`."""
    if pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.dtype != np.uint8:
        raise InputError(f"pixels: the array of {pixels.dtype} has shape {pixels.shape}; it must "
                         "be of uint8 and have shape (height, width, 3)")
    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)
    file = io.BytesIO(b"")
    file.write(b"\x89PNG\r\n\x1a\n")
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    for name, data in ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b"")):
        file.write(struct.pack(">I", len(data)) + name + data)
        file.write(struct.pack(">I", zlib.crc32(name + data)))
    return file.getvalue()


def _changed(core: _photile.Picture, changes: _photile.Changes) -> Picture:
    picture = Picture(core)
    picture._changes = changes
    core.lights(changes)  # refuses what cannot be done
    return picture


def listed(changes: Changes) -> _photile.Changes:
    """The changes as the extension takes them."""
    listed = []
    for name, value in (changes or {}).items():
        try:
            listed.append((str(name), value if isinstance(value, str) else f"x{float(value)!r}"))
        except (TypeError, ValueError):
            raise UsageError(f"light '{name}': {value!r} is neither a factor nor text") from None
    return listed


def lights_asked(light: Changes, mood: str, moods: Optional[File]) -> dict[str, Any]:
    """A mood, and what is changed in it, as the extension takes them."""
    return {"light": listed(light), "mood": mood, "moods": "" if moods is None else os.fspath(moods)}


def render(
    scene: Scene,
    camera: Union[None, int, str, Camera] = None,
    *,
    size: Optional[tuple[int, int]] = None,
    quality: str = "good",
    integrator: str = "photon-map",
    light: Changes = None,
    mood: str = "",
    moods: Optional[File] = None,
    lumen_per_watt: float = _photile.lumen_per_watt,
    device: str = "",
    progress: Progress = None,
    **settings: Union[int, float, str],
) -> Picture:
    """Render a picture with a layer for each light.

    Parameters
    ----------
    scene : Scene
    camera : Camera, str or int, optional
        A camera, or one of the scene's by name or number; by default the first.
    size : (width, height), optional
        Pixels; by default 512 x 384, or the width that fits the camera's aspect ratio.
    quality : {"draft", "good", "final"}
        A set of settings; those given by name override it.
    integrator : {"photon-map", "path"}
        Paths are unbiased and need no OpenCL device; samples_per_pixel controls their noise.
    light : mapping, optional
        Changes of lights, see `Picture`; after the mood.
    mood : str
        A mood that the live page saved under this name.
    moods : path, optional
        The file of moods; by default room.moods.json beside room.gltf.
    lumen_per_watt : float
        The factor between watts and lumens.
    device : str
        An OpenCL device, or several, as `photile devices` lists them: "" is the best; else
        "0:0", "cpu", "gpu", a part of a name, or "all".
    progress : callable or True, optional
        ``progress(stage, done, total, unit)`` is called a few times a second in the calling thread.
        An exception from it stops the work and is raised here once it has stopped. True writes a line
        to standard error. Notes to the user go to the logger "photile".
    **settings
        Settings by their names in ``photile.SETTINGS``: ``photons_emitted=100_000``, ``neighbours=80``,
        ``seed=7``, ``maps="naive"``.

    Returns
    -------
    Picture

    Raises
    ------
    UsageError
        Names the setting and its range, or the camera; there is no such light or mood.
    DeviceError
        There is no such device, or it failed.
    KeyboardInterrupt
        Ctrl-C was pressed.
    """
    asked = lights_asked(light, mood, moods)
    options = {
        "size": size,
        "integrator": integrator,
        "lumen_per_watt": lumen_per_watt,
        "device": device,
        **asked,
    }
    with heard_by(progress) as heard:
        core = _photile.render(scene._core, scene._camera(camera), options,
                               {"quality": quality, **settings}, heard)
    return _changed(core, core.mood(mood, asked["moods"]) + asked["light"])


def relight(file: File, changes: Changes = None, *, mood: str = "", moods: Optional[File] = None) -> Picture:
    """Read a picture with light layers, from photile, Blender or Arnold, and change its lights.

    Parameters
    ----------
    file : path
        An EXR whose layers are called ``Combined_<light>`` or ``RGBA_<light>``.
    changes : mapping, optional
        See `Picture`; after the mood.
    mood, moods
        As for `render`; the file is beside the picture's scene, or the picture.

    Returns
    -------
    Picture

    Raises
    ------
    InputError
        Names the file, which is missing, damaged or has no light layers.
    UsageError
        There is no such light or mood, or a light that is off in the file is to be turned up.
    """
    core = _photile.read_picture(os.fspath(file))
    asked = lights_asked(changes, mood, moods)
    return _changed(core, core.mood(mood, asked["moods"]) + asked["light"])
