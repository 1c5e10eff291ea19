"""What photile's converters of other programs' files (``from_gldf``, ``from_honeybee``, ``from_ifc``)
share: glTF, names, the turn of luminaires, files that appear whole, and processes of their own."""

from __future__ import annotations

import contextlib
import json
import math
import os
import resource
import signal
import struct
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import OutputError
from .report.command import permissions

__all__ = ["Conversion", "Gltf", "in_child", "in_scene", "json_lines", "luminaire_rotation", "matt", "unique",
           "write_files", "y_up"]

_float, _index = 5126, 5125  # glTF's numbers of component types
_json_chunk, _binary_chunk = b"JSON", b"BIN\0"


# In scenes y points up, in buildings z.
y_up = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def in_scene(point: ArrayLike) -> list[float]:
    """Of a point or direction whose z points up."""
    return [round(float(value), 6) + 0.0 for value in y_up[:3, :3] @ np.asarray(point, float)]


@dataclass(frozen=True)
class Conversion:
    """What was done."""

    commands: list[list[str]]  # words of those that measure what was written, or of an option
    summary: list[str] = field(default_factory=list)  # lines about what was written
    warnings: list[str] = field(default_factory=list)  # lines about what was left out


def json_lines(entries: list[dict[str, Any]]) -> bytes:
    """A list with an entry a line."""
    lines = (json.dumps(entry, ensure_ascii=False, allow_nan=False) for entry in entries)
    return ("[" + ",\n ".join(lines) + "]\n").encode()


def unique(name: str, taken: dict[str, int]) -> str:
    """The name, or with a number that keeps it apart from those taken, to which it is added.

    taken   how often each name was asked for
    """
    found = name
    while found in taken:
        taken[name] += 1
        found = f"{name}_{taken[name]}"
    taken[found] = 1
    return found


def matt(name: str, colour: ArrayLike) -> dict[str, Any]:
    """A glTF material that reflects diffusely alone.

    colour   linear reflectance of red, green and blue
    """
    return {"name": name, "doubleSided": True,
            "pbrMetallicRoughness": {"metallicFactor": 0.0,
                                     "baseColorFactor": [*np.asarray(colour, float).tolist(), 1.0]},
            # Without this glTF adds a coat of 4% to every surface.
            "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}}


class Gltf:
    """A glTF 2.0 file that grows."""

    def __init__(self, generator: str) -> None:
        self._json: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": generator}, "scene": 0, "scenes": [{"nodes": []}],
            "nodes": [], "meshes": [], "materials": [], "cameras": [], "accessors": [],
            "bufferViews": [], "extensionsUsed": []}
        self._binary = bytearray()

    def _add(self, kind: str, element: dict[str, Any]) -> int:
        self._json[kind].append(element)
        return len(self._json[kind]) - 1

    def _accessor(self, values: NDArray[Any], described: dict[str, Any]) -> int:
        view = self._add("bufferViews", {"buffer": 0, "byteOffset": len(self._binary),
                                         "byteLength": values.nbytes})
        self._binary += values.tobytes()
        return self._add("accessors", {"bufferView": view, **described})

    def material(self, material: dict[str, Any]) -> int:
        return self._add("materials", material)

    def points(self, points: ArrayLike) -> int:
        """The accessor of corners, shape (n, 3), metres."""
        array = np.asarray(points, "<f4").reshape(-1, 3)
        return self._accessor(array, {"componentType": _float, "type": "VEC3", "count": len(array),
                                      "min": array.min(axis=0).tolist(),
                                      "max": array.max(axis=0).tolist()})

    def triangles(self, corners: ArrayLike) -> int:
        """The accessor of triangles, whose corners are rows of points, shape (n, 3)."""
        array = np.asarray(corners, "<u4").reshape(-1)
        return self._accessor(array, {"componentType": _index, "type": "SCALAR", "count": len(array)})

    def mesh(self, name: str, parts: list[tuple[int, int | None, int]]) -> int:
        """A mesh of parts: points, triangles (None = each three points are one) and material."""
        return self._add("meshes", {"name": name, "primitives": [
            {"attributes": {"POSITION": points}, "material": material}
            | ({} if triangles is None else {"indices": triangles})
            for points, triangles, material in parts]})

    def camera(self, vertical_degrees: float) -> int:
        return self._add("cameras", {"type": "perspective", "perspective": {
            "yfov": math.radians(vertical_degrees), "znear": 0.01}})

    def node(self, parent: int | None = None, **members: Any) -> int:
        """A node below another one, or a root."""
        number = self._add("nodes", members)
        siblings = (self._json["scenes"][0]["nodes"] if parent is None
                    else self._json["nodes"][parent].setdefault("children", []))
        siblings.append(number)
        return number

    def glb(self) -> bytes:
        """A ``.glb``: chunks of JSON and of numbers (glTF 2.0, section 4.4)."""
        content = {key: value for key, value in self._json.items() if value != []}
        content["buffers"] = [{"byteLength": len(self._binary)}]
        used = {name for material in self._json["materials"] for name in material["extensions"]}
        content["extensionsUsed"] = sorted(used)
        text = json.dumps(content, allow_nan=False).encode()
        chunks = [(_json_chunk, text + b" " * (-len(text) % 4)),
                  (_binary_chunk, bytes(self._binary) + b"\0" * (-len(self._binary) % 4))]
        body = b"".join(struct.pack("<I4s", len(data), kind) + data for kind, data in chunks)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def luminaire_rotation(c0: ArrayLike, aim: ArrayLike, up: ArrayLike) -> float:
    """Degrees about the aim that turn a luminaire of photile so that its C0 lies along an axis.

    c0, aim   unit vectors at a right angle
    up        the axis of the file that points up, y or z
    """
    upwards, z = np.asarray(up, float), -np.asarray(aim, float)
    # As luminaire_axes of luminaires.cpp has it.
    level = np.array([1.0, 0, 0]) if abs(z @ upwards) > 0.999 else np.cross(upwards, z)
    x = level - (level @ z) * z
    x /= np.linalg.norm(x)
    axis = np.asarray(c0, float)
    return math.degrees(math.atan2(axis @ np.cross(z, x), axis @ x))


def write_files(contents: Mapping[Path, bytes]) -> None:
    """Write files so that each appears whole, and none before all are written; their folders are made.

    Errors: OutputError naming the file.
    """
    with contextlib.ExitStack() as left_over:
        written: list[tuple[str, Path]] = []
        for path, content in contents.items():
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
                left_over.callback(Path(temporary).unlink, missing_ok=True)
                with open(handle, "wb") as stream:
                    stream.write(content)
                os.chmod(temporary, permissions(path))
            except OSError as error:
                raise OutputError(f"{path}: not written: {error.strerror}; name another file") from None
            written.append((temporary, path))
        for temporary, path in written:
            try:
                os.replace(temporary, path)
            except OSError as error:
                raise OutputError(f"{path}: not written: {error.strerror}; name another file") from None


def in_child(work: Callable[[], int], crash: str, seconds: int = 3600) -> int:
    """Do work that calls native code of others, which may crash on a damaged file, ask for memory or time
    without end, or not hear Ctrl-C: in a process of its own, with at most the memory of the machine and
    without what native code prints. Returns its exit code.

    work      returns an exit code
    crash     line to print where the process ends without one, which then is 3
    seconds   of processor time, at which it is ended
    """
    child = os.fork()
    if child == 0:
        code = 1
        try:
            memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent hears it
            sys.stderr = os.fdopen(os.dup(2), "w", buffering=1)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            code = work()
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)
    stopped = []

    def stop(*_: Any) -> None:
        stopped.append(True)
        os.kill(child, signal.SIGKILL)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    status = os.waitpid(child, 0)[1]
    if os.WIFEXITED(status):
        return os.WEXITSTATUS(status)
    print("\ninterrupted" if stopped else crash, file=sys.stderr)
    return 130 if stopped else 3
