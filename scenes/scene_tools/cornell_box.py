"""The Cornell box from its measurements: as OBJ, as glTF, and as glTF with glass and a mirror."""

import math

from scene_tools import cornell_data as data
from scene_tools.colour import luminance, spectrum_to_rgb
from scene_tools.gltf_writer import GltfDocument
from scene_tools.shapes import Shape, sphere

LUMEN = 1000.0  # of the lamp; the published emission has no absolute scale
LUMEN_PER_WATT = 683.0

SPHERE_RADIUS = 0.0825  # as high as the short block whose place it takes
SPHERE_GAP = 0.0005     # between sphere and floor
MIRROR_TURN = -25.0     # degrees


def _lamp_spectrum(wavelength):
    points = sorted(data.LIGHT.items())
    for (w0, v0), (w1, v1) in zip(points, points[1:]):
        if w0 <= wavelength <= w1:
            return v0 + (v1 - v0) * (wavelength - w0) / (w1 - w0)
    raise ValueError(wavelength)


LAMP = [_lamp_spectrum(w) for w in data.WAVELENGTHS]


def lamp_rgb():
    """Colour of the lamp, its luminance 1."""
    rgb = spectrum_to_rgb(data.WAVELENGTHS, LAMP)
    return tuple(c / luminance(rgb) for c in rgb)


def reflectance_rgb(spectrum):
    """RGB that turns the lamp's RGB into the RGB of the light that it reflects: under this lamp
    the first reflection has exactly the measured colour."""
    reflected = spectrum_to_rgb(data.WAVELENGTHS, [r * e for r, e in zip(spectrum, LAMP)])
    lamp = spectrum_to_rgb(data.WAVELENGTHS, LAMP)
    return tuple(min(max(r / e, 0.0), 1.0) for r, e in zip(reflected, lamp))


def _metres(corners):
    return [tuple(c / 1000.0 for c in corner) for corner in corners]


def _polygons(*polygons):
    shape = Shape()
    for polygon in polygons:
        shape.polygon(_metres(polygon))
    return shape


def _ceiling():
    """The ceiling around the lamp, in four pieces that meet it corner to corner."""
    outer, inner = data.CEILING, data.LAMP
    return _polygons(*((outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i])
                       for i in range(4)))


def _block(top, height):
    """A block without its bottom: it stands on the floor, with which a bottom would coincide."""
    upper = [(x, height, z) for x, z in top]
    lower = [(x, 0.0, z) for x, z in top]
    sides = [(upper[i], lower[i], lower[(i + 1) % 4], upper[(i + 1) % 4]) for i in range(4)]
    return _polygons(upper, *sides)


def _sphere():
    corners, _ = data.SHORT_BLOCK
    x, z = (sum(c[i] for c in corners) / 4000.0 for i in (0, 1))
    return sphere(SPHERE_RADIUS, 64, 32).moved(x, SPHERE_RADIUS + SPHERE_GAP, z)


def _mirror_block():
    """The tall block, turned about its middle so that its front shows a wall of the box: in the
    place where the real one stands it would mirror the dark before the open side."""
    corners, height = data.TALL_BLOCK
    x, z = (sum(c[i] for c in corners) / 4 for i in (0, 1))
    turn = math.radians(MIRROR_TURN)
    turned = [(x + math.cos(turn) * (cx - x) - math.sin(turn) * (cz - z),
               z + math.sin(turn) * (cx - x) + math.cos(turn) * (cz - z)) for cx, cz in corners]
    return _block(turned, height)


def _parts():
    """(name, material, shape) of everything that both versions have."""
    return [("floor", "white", _polygons(data.FLOOR)), ("ceiling", "white", _ceiling()),
            ("back wall", "white", _polygons(data.BACK_WALL)),
            ("right wall", "green", _polygons(data.RIGHT_WALL)),
            ("left wall", "red", _polygons(data.LEFT_WALL)),
            ("lamp", "lamp", _polygons(data.LAMP))]


def _blocks():
    return [("short block", "white", _block(*data.SHORT_BLOCK)),
            ("tall block", "white", _block(*data.TALL_BLOCK))]


def _albedos():
    return {"white": reflectance_rgb(data.WHITE), "green": reflectance_rgb(data.GREEN),
            "red": reflectance_rgb(data.RED)}


def _write_obj(path):
    """OBJ and MTL. OBJ knows watts only, so the lamp gives its lumens at 683 lm/W."""
    lines, count = ["# The Cornell box, metres, y up; see ../README.md", f"mtllib {path.stem}.mtl"], 0
    for name, material, shape in _parts() + _blocks():
        lines += [f"o {name.replace(' ', '_')}", f"usemtl {material}"]
        lines += ["v %.4f %.4f %.4f" % p for p in shape.positions]
        lines += ["f %d %d %d" % tuple(count + i + 1 for i in t) for t in shape.triangles]
        count += len(shape.positions)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")

    lines = ["# Reflectances: see ../README.md"]
    for name, rgb in _albedos().items():
        lines += [f"newmtl {name}", "Kd %.4f %.4f %.4f" % rgb, "illum 1"]
    area = _polygons(data.LAMP).area()
    watt = LUMEN / LUMEN_PER_WATT
    emission = tuple(watt / (math.pi * area) * c for c in lamp_rgb())
    lines += [f"# {watt:.4f} W, weighted with luminance: W/(m2 sr)", "newmtl lamp", "Kd 0 0 0",
              "Ke %.4f %.4f %.4f" % emission, "illum 1"]
    path.with_suffix(".mtl").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"{path.name}: {sum(1 for p in _parts() + _blocks() for _ in p[2].triangles)} triangles")


def _write_gltf(path, specular):
    document = GltfDocument(path.stem)
    materials = {name: document.matte(name, rgb) for name, rgb in _albedos().items()}
    materials["lamp"] = document.lamp("lamp", LUMEN, _polygons(data.LAMP).area(), lamp_rgb())
    parts = _parts()
    if specular:
        materials["glass"] = document.glass("glass", 1.5)
        materials["mirror"] = document.metal("mirror", (0.9, 0.9, 0.9), 0.0)
        parts += [("glass sphere", "glass", _sphere()),
                  ("mirror block", "mirror", _mirror_block())]
    else:
        parts += _blocks()
    for name, material, shape in parts:
        document.thing(name, (materials[material], shape))
    position = _metres([data.CAMERA])[0]
    degrees = 2 * math.degrees(math.atan(0.5 * data.FILM_SIZE / data.FOCAL_LENGTH))
    document.camera("camera", position, (position[0], position[1], 0.0), degrees, 1.0)
    document.save(path)


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    _write_obj(folder / "cornell-box.obj")
    _write_gltf(folder / "cornell-box.gltf", specular=False)
    _write_gltf(folder / "cornell-box-specular.gltf", specular=True)
