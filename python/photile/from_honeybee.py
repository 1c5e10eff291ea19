"""Honeybee's models (HBJSON) as scenes that photile reads: ``photile import``.

Needs honeybee-radiance of PyPI. In models z points up, in scenes y: z becomes y, and y becomes -z.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .command_line import one_line
from .converters import Conversion, Gltf, in_scene, json_lines, luminaire_rotation, matt, write_files, y_up
from .errors import InputError, UsageError

__all__ = ["convert"]

_least_opening = 0.05  # metres, of a lamp whose file calls it a point
_lumens_per_watt = 179.0  # Radiance's
_channels = "rgb"
_eye = 1.6  # metres above the floor


def _colour(modifier: Any, what: str) -> list[float]:
    return [float(getattr(modifier, f"{channel}_{what}")) for channel in _channels]


def _tint(transmissivity: float, index: float) -> float:
    """The tint of photile's thin glass that transmits as much of an even sky as Radiance's glass does.

    photile's tint is the same at all angles, while Radiance's grows with the path through the pane.
    """
    cosine = (np.arange(64) + 0.5) / 64
    within = np.sqrt(1 - (1 - cosine**2) / index**2)
    faces = np.stack([(cosine - index * within) / (cosine + index * within),
                      (within - index * cosine) / (within + index * cosine)]) ** 2
    passed = transmissivity ** (1 / within)
    pane = ((1 - faces) ** 2 * passed / (1 - (faces * passed) ** 2)).mean(axis=0)
    face = faces.mean(axis=0)
    return float((pane @ cosine) / ((1 - face) / (1 + face) @ cosine))


def _material(modifier: Any) -> tuple[dict[str, Any], str]:
    """A glTF material for a Radiance modifier, and what of the modifier is lost or ""."""
    kind, lost = type(modifier).__name__, ""
    material = matt(modifier.identifier, [0.0] * 3)
    surface, extensions = material["pbrMetallicRoughness"], material["extensions"]
    if kind in ("Plastic", "Metal", "Trans"):
        colour = _colour(modifier, "reflectance")
        surface["roughnessFactor"] = math.sqrt(modifier.roughness)
        if kind == "Metal":
            surface["metallicFactor"] = 1.0
        elif modifier.specularity > 0:  # reflectance at normal incidence over the 0.04 of glTF
            extensions["KHR_materials_specular"] = {
                "specularColorFactor": [modifier.specularity / 0.04] * 3}
        if kind == "Trans":
            lost = "its transmission is left out"
    elif kind == "Mirror":
        colour = _colour(modifier, "reflectance")
        surface.update(metallicFactor=1.0, roughnessFactor=0.0)
    elif kind == "Glass":
        index = modifier.refraction_index or 1.52
        colour = [min(1.0, _tint(value, index)) for value in _colour(modifier, "transmissivity")]
        surface["roughnessFactor"] = 0.0
        extensions.update(KHR_materials_transmission={"transmissionFactor": 1.0},
                          KHR_materials_ior={"ior": index})
        del extensions["KHR_materials_specular"]
    elif kind in ("Light", "Glow"):
        colour = [0.0] * 3
        nits = [_lumens_per_watt * value for value in _colour(modifier, "emittance")]
        most = max(nits) or 1.0
        material["emissiveFactor"] = [value / most for value in nits]
        extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": most}
    else:
        colour, lost = [0.5] * 3, f"{kind} is not supported; it becomes matt grey (0.5)"
    surface["baseColorFactor"] = [*colour, 1.0]
    return material, lost


def _surfaces(model: Any) -> Iterator[tuple[Any, Any]]:
    """Meshes of triangles and quads, and their modifiers.

    Rooms' faces, windows and doors face inwards: where two rooms touch, each has its own side.
    """
    for face in model.faces:
        if str(face.type) != "AirBoundary":
            inwards = face.punched_geometry.flip() if face.has_parent else face.punched_geometry
            yield inwards.triangulated_mesh3d, face.properties.radiance.modifier
    for part in (*model.apertures, *model.doors):
        of_room = part.has_parent and part.parent.has_parent
        inwards = part.geometry.flip() if of_room else part.geometry
        yield inwards.triangulated_mesh3d, part.properties.radiance.modifier
    for part in model.shades:
        yield part.geometry.triangulated_mesh3d, part.properties.radiance.modifier
    for part in model.shade_meshes:
        yield part.geometry, part.properties.radiance.modifier


def _gltf(model: Any, warnings: list[str]) -> bytes:
    corners: dict[str, list[Any]] = {}
    modifiers: dict[str, Any] = {}
    for mesh, modifier in _surfaces(model):
        modifiers[modifier.identifier] = modifier
        of_modifier = corners.setdefault(modifier.identifier, [])
        for face in mesh.faces:
            for i in range(2, len(face)):  # Honeybee's quads are convex
                of_modifier += [tuple(mesh.vertices[k]) for k in (face[0], face[i - 1], face[i])]
    gltf = Gltf("photile import")
    for name, points in corners.items():
        material, lost = _material(modifiers[name])
        if lost:
            warnings.append(f"modifier '{name}': {lost}")
        part = (gltf.points(np.array(points) @ y_up[:3, :3].T), None, gltf.material(material))
        gltf.node(name=name, mesh=gltf.mesh(name, [part]))
    return gltf.glb()


def _rooms(model: Any, warnings: list[str]) -> list[dict[str, Any]]:
    """The list of ``rooms.json``. A floor's outline is that of the room as seen from above."""
    rooms = []
    for room in model.rooms:
        try:
            boundary = room.horizontal_boundary(tolerance=model.tolerance)
            height, floor = room.max.z - room.min.z, room.min.z
            widest = max(room.floors, key=lambda face: float(face.area))
            x, y, _ = widest.geometry.pole_of_inaccessibility(model.tolerance)
        except Exception as error:  # ladybug raises what it likes on rooms that are not closed
            warnings.append(f"room '{room.display_name}': it is not listed: {one_line(error) or 'it has no floor'}")
            continue
        outline, *holes = ([in_scene([corner.x, corner.y, floor]) for corner in ring]
                           for ring in (boundary.boundary, *(boundary.holes or ())))
        rooms.append({"name": one_line(room.display_name), "storey": one_line(room.story or ""),
                      "area": round(room.floor_area, 4), "height": round(height, 4), "floor": round(floor, 4),
                      "inside": in_scene([x, y, floor + min(_eye, height / 2)]), "outline": outline, "holes": holes})
    return rooms


def _add(files: dict[str, bytes], name: str, text: str) -> None:
    if name in files:
        raise ValueError(f"two grids or luminaires have the name '{Path(name).stem}'; rename one")
    files[name] = text.encode()


def _luminaires(model: Any, stem: str, warnings: list[str]) -> tuple[list[dict[str, Any]], dict[str, bytes]]:
    """The list that ``--luminaires`` takes, and photometric files by name, which begins with a stem."""
    entries: list[dict[str, Any]] = []
    files: dict[str, bytes] = {}
    for lamp in model.properties.radiance.luminaires:
        name, text, factor = lamp.identifier, lamp.ies_content, lamp.light_loss_factor
        factor *= lamp.candela_multiplier
        if lamp.custom_lamp is not None:
            factor *= lamp.custom_lamp.depreciation_factor
            warnings.append(f"luminaire '{name}': its colour is left out; set it by --light NAME=KELVINK")
        if factor != 1:
            # The third number after the line of the tilt multiplies all intensities.
            match = re.search(r"TILT\s*=\s*NONE\s+\S+\s+\S+\s+(\S+)", text)
            if match:
                text = (f"{text[:match.start(1)]}{float(match[1]) * factor:.9g}"
                        f"{text[match.end(1):]}")
            else:
                warnings.append(f"luminaire '{name}': its factor of {factor:g} is left out "
                                "because its file has a TILT")
        file = f"{stem}.{name}.ies"
        _add(files, file, text)
        small = max(lamp.width_m, lamp.length_m) == 0 == min(lamp.width_m, lamp.length_m)
        for number, instance in enumerate(lamp.luminaire_zone or ()):
            position, c0, aim = map(in_scene, (instance.point, instance.c0_axis, instance.g0_axis))
            entry = {"name": f"{name}_{number + 1}", "file": file, "position": position, "aim": aim,
                     "rotation": round(luminaire_rotation(c0, aim, (0, 1, 0)), 4)}
            if small:
                entry["size"] = [_least_opening, _least_opening]
            entries.append(entry)
    return entries, files


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is not a number")
    return value


def _read(file: Path, warnings: list[str]) -> Any:
    """A model of JSON alone: Honeybee's own reader runs the programs in a file that it takes for a
    pickle. Parts of the model that would make Honeybee read or write other files are left out."""
    def harmless(part: dict[str, Any]) -> dict[str, Any]:
        if part.get("type") == "BSDF":  # is written to a file that its identifier names
            grey = {f"{channel}_reflectance": 0.5 for channel in _channels}
            warning = (f"modifier '{part['identifier']}': BSDF is not supported; "
                       "it becomes matt grey (0.5)")
            if warning not in warnings:
                warnings.append(warning)
            return {"type": "Plastic", "identifier": part["identifier"], **grey,
                    "specularity": 0.0, "roughness": 0.0}
        if "ies_path" in part:
            part["ies_path"] = None  # its content is in the model
        return part

    try:
        text = file.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ValueError(error.strerror) from None
    data = json.loads(text, object_hook=harmless, parse_float=_finite, parse_constant=_finite)
    importlib.import_module("honeybee_radiance")  # adds what models know of light
    return importlib.import_module("honeybee.model").Model.from_dict(data)


def _files(model: Any, scene: Path, warnings: list[str]) -> tuple[dict[str, bytes], list[str]]:
    """By their names beside the scene, and the words of the command that measures."""
    files = {scene.name: _gltf(model, warnings)}
    command = ["photile", "measure", str(scene)]
    rooms = _rooms(model, warnings)
    if rooms:
        files[f"{scene.stem}.rooms.json"] = json_lines(rooms)
    entries, photometry = _luminaires(model, scene.stem, warnings)
    if entries:
        files |= {**photometry, f"{scene.stem}.luminaires.json": json_lines(entries)}
        command += ["--luminaires", str(scene.with_suffix(".luminaires.json"))]
    elif rooms:
        command += ["--sky", "overcast=10000"]
    grids = model.properties.radiance.sensor_grids
    if rooms and not grids:
        return files, [*command, "--plane", "floor+0.75", "--rooms", "*", "-o", str(scene.with_suffix(".html"))]
    for grid in grids:
        name = f"{scene.stem}.grids/{grid.identifier}.pts"
        _add(files, name, "".join(" ".join(f"{x:.9g}" for x in [*in_scene(sensor.pos), *in_scene(sensor.dir)]) + "\n"
                                  for sensor in grid.sensors))
        command += ["--points", str(scene.parent / name)]
    return files, [*command, "--honeybee", str(scene.with_suffix(".results"))]


def convert(file: Path, scene: Path) -> Conversion:
    """Write a model as a scene, its rooms, grids of sensors and luminaires.

    Parameters
    ----------
    file : path
        HBJSON of a Model.
    scene : path
        ``.glb`` to write. ``.rooms.json``, ``.luminaires.json``, photometric files and the folder ``.grids`` of
        the same name lie beside it where there are rooms, luminaires and grids.

    Errors: InputError, UsageError, OutputError, ImportError.
    """
    if scene.suffix.lower() != ".glb":
        raise UsageError(f"{scene}: name a .glb file to write")
    warnings: list[str] = []
    try:
        # Honeybee prints what goes wrong, with its stack, before it raises it.
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
            model = _read(file, warnings)
            model.convert_to_units("Meters")
            files, command = _files(model, scene, warnings)
    except ImportError:
        raise
    except Exception as error:  # Honeybee raises what it likes on malformed files
        raise InputError(f"{file}: {one_line(error)}; give an HBJSON file of a whole model") from None
    write_files({scene.parent / name: content for name, content in files.items()})
    return Conversion([command], [], warnings)
