"""Seven small scenes, each for one thing that light does; docs/measured/gallery.md shows them."""

import itertools
import math

from scene_tools.colour import blackbody_rgb
from scene_tools.gltf_writer import GltfDocument
from scene_tools.shapes import Shape, box, cylinder, lathe, normalised, rectangle, sphere

WHITE, GREY, OAK = (0.75, 0.75, 0.75), (0.4, 0.4, 0.4), (0.45, 0.3, 0.18)
WARM, COOL = blackbody_rgb(3000), blackbody_rgb(6500)
ASPECT = 4 / 3


def _disc(centre, radius, segments=24):
    """Looks down."""
    corners = [(centre[0] + radius * math.cos(2 * math.pi * i / segments), centre[1],
                centre[2] + radius * math.sin(2 * math.pi * i / segments))
               for i in range(segments)]
    return Shape().polygon(corners)


def _lamp(document, name, lumen, shape, rgb):
    document.thing(name, (document.lamp(name, lumen, shape.area(), rgb), shape))


def _corner(document, floor, wall, size=2.0):
    """A floor and the wall behind it."""
    half = size / 2
    document.thing("floor", (floor, rectangle((-half, 0, half), (size, 0, 0), (0, 0, -size))))
    document.thing("wall", (wall, rectangle((-half, 0, -half), (size, 0, 0), (0, size, 0))))


def _torus(ring_radius, tube_radius, segments=64, tube_segments=24):
    """Standing on the floor, about the y axis."""
    profile = []
    for i in range(tube_segments + 1):
        angle = 2 * math.pi * (i % tube_segments) / tube_segments - math.pi / 2
        profile.append((ring_radius + tube_radius * math.cos(angle),
                        tube_radius + tube_radius * math.sin(angle)))
    return lathe(profile, segments)


def glass_sphere(path):
    document = GltfDocument("caustic of a glass sphere")
    _corner(document, document.matte("floor", OAK), document.matte("wall", WHITE))
    document.thing("sphere", (document.glass("glass", 1.5), sphere(0.2, 64, 32).moved(0, 0.2, 0)))
    _lamp(document, "lamp", 2000, _disc((-0.5, 1.6, 0.2), 0.08), WARM)
    document.camera("camera", (0.15, 0.75, 1.25), (0.05, 0.15, -0.05), 42, ASPECT)
    document.save(path)


def metal_ring(path):
    document = GltfDocument("caustic of a metal ring")
    _corner(document, document.matte("floor", WHITE), document.matte("wall", GREY))
    ring = lathe([(0.3, 0.0), (0.3, 0.16), (0.29, 0.16), (0.29, 0.0)], 96)
    document.thing("ring", (document.metal("gold", (0.95, 0.72, 0.35), 0.0), ring.moved(0, -1e-3, 0)))
    document.thing("band", (document.metal("steel", (0.6, 0.6, 0.62), 0.35),
                            _torus(0.12, 0.025).moved(0.55, 1e-3, 0.15)))
    _lamp(document, "lamp", 2000, _disc((-0.7, 1.0, -0.1), 0.06), COOL)
    document.camera("camera", (0.2, 0.9, 1.1), (0.1, 0.0, 0.0), 42, ASPECT)
    document.save(path)


def _tiled(corner, u, v, columns, rows, joint=0.008):
    """Tiles of two kinds by turns, and the joints between them, each a shape. `joint` is metres wide."""
    along, across = math.hypot(*u), math.hypot(*v)
    half_u, half_v = joint / 2 / along, joint / 2 / across
    holes = [(column / columns + half_u, row / rows + half_v, (column + 1) / columns - half_u, (row + 1) / rows - half_v)
             for row, column in itertools.product(range(rows), range(columns))]
    tiles = (Shape(), Shape())
    for number, (u0, v0, u1, v1) in enumerate(holes):
        tiles[(number // columns + number % columns) % 2].polygon(
            [tuple(c + a * p + b * q for c, p, q in zip(corner, u, v)) for a, b in ((u0, v0), (u1, v0), (u1, v1), (u0, v1))])
    return (*tiles, rectangle(corner, u, v, holes))


# Plane waves of the pool: length in metres, direction in degrees from x towards z, height in metres, phase in radians.
WAVES = ((0.9, 20, 0.02, 0.3), (0.65, -35, 0.012, 1.7), (0.5, 75, 0.008, 4.0), (0.42, 130, 0.006, 2.2))


def _water(corner, size, columns, rows):
    """A waved sheet about the height of `corner`, seen from above, with the normals of its waves."""
    shape = Shape()
    for row, column in itertools.product(range(rows + 1), range(columns + 1)):
        x, z = corner[0] + size[0] * column / columns, corner[2] - size[1] * row / rows
        y, slope_x, slope_z = corner[1], 0.0, 0.0
        for length, degrees, height, phase in WAVES:
            k, angle = 2 * math.pi / length, math.radians(degrees)
            at = k * (x * math.cos(angle) + z * math.sin(angle)) + phase
            y += height * math.sin(at)
            slope_x += height * k * math.cos(angle) * math.cos(at)
            slope_z += height * k * math.sin(angle) * math.cos(at)
        shape.vertex((round(x, 6), round(y, 6), round(z, 6)),
                     [round(c, 6) for c in normalised((-slope_x, 1.0, -slope_z))])
    for row, column in itertools.product(range(rows), range(columns)):
        a = row * (columns + 1) + column
        shape.triangles += [(a, a + 1, a + columns + 2), (a, a + columns + 2, a + columns + 1)]
    return shape


def pool(path):
    """A basin of 2.4 m x 1.8 m x 0.9 m in a yard, lit by --sun alone. The water ends within the walls of the basin."""
    document = GltfDocument("water over tiles under the sun")
    ground, wall = document.matte("ground", (0.55, 0.5, 0.42)), document.matte("wall", WHITE)
    light, dark, joint = (document.matte(name, rgb) for name, rgb in (
        ("light tile", (0.5, 0.68, 0.72)), ("dark tile", (0.25, 0.48, 0.58)), ("joint", (0.7, 0.7, 0.68))))
    document.thing("ground", (ground, rectangle((-2.2, 0, 1.8), (4.4, 0, 0), (0, 0, -3.6),
                                                [(1 / 4.4, 0.25, 3.4 / 4.4, 0.75)])))
    document.thing("back wall", (wall, rectangle((-2.2, 0, -1.8), (4.4, 0, 0), (0, 1.5, 0))))
    document.thing("right wall", (wall, rectangle((2.2, 0, -1.8), (0, 0, 3.6), (0, 1.5, 0))))
    sides = (("floor", (-1.2, -0.9, 0.9), (2.4, 0, 0), (0, 0, -1.8), 12, 9),
             ("far side", (-1.2, -0.9, -0.9), (2.4, 0, 0), (0, 0.9, 0), 12, 4),
             ("right side", (1.2, -0.9, -0.9), (0, 0, 1.8), (0, 0.9, 0), 9, 4),
             ("near side", (1.2, -0.9, 0.9), (-2.4, 0, 0), (0, 0.9, 0), 12, 4),
             ("left side", (-1.2, -0.9, 0.9), (0, 0, -1.8), (0, 0.9, 0), 9, 4))
    for name, corner, u, v, columns, rows in sides:
        for kind, material, shape in zip(("light", "dark", "joints"), (light, dark, joint),
                                         _tiled(corner, u, v, columns, rows)):
            document.thing(f"{name}, {kind}", (material, shape))
    document.thing("water", (document.glass("water", 1.33), _water((-1.202, -0.1, 0.902), (2.404, 1.804), 96, 72)))
    document.camera("camera", (0.5, 1.5, 1.9), (-0.1, -0.4, -0.2), 48, ASPECT)
    document.camera("under water", (-0.95, -0.28, 0.75), (0.4, -0.85, -0.4), 50, ASPECT)
    document.save(path)


def glossy_floor(path):
    document = GltfDocument("a window in a glossy floor")
    wall = document.matte("wall", WHITE)
    floor = document.glossy("polished stone", (0.2, 0.19, 0.18), 0.3)
    document.thing("floor", (floor, rectangle((-2, 0, 2), (4, 0, 0), (0, 0, -4))))
    document.thing("back wall", (wall, rectangle((-2, 0, -2), (4, 0, 0), (0, 2.5, 0),
                                                 [(0.35, 0.32, 0.65, 0.84)])))
    document.thing("left wall", (wall, rectangle((-2, 0, 2), (0, 0, -4), (0, 2.5, 0))))
    document.thing("right wall", (wall, rectangle((2, 0, -2), (0, 0, 4), (0, 2.5, 0))))
    document.thing("front wall", (wall, rectangle((2, 0, 2), (-4, 0, 0), (0, 2.5, 0))))
    document.thing("ceiling", (wall, rectangle((-2, 2.5, -2), (4, 0, 0), (0, 0, 4))))
    document.thing("block", (document.matte("blue", (0.15, 0.25, 0.5)),
                             box((0.5, 0.6, 0.5), (1.1, 1e-3, -0.9))))
    _lamp(document, "window", 4000, rectangle((-0.6, 0.8, -2), (1.2, 0, 0), (0, 1.3, 0)), COOL)
    document.camera("camera", (0.3, 1.5, 1.8), (0, 0.55, -1.2), 55, ASPECT)
    document.save(path)


def sun_and_sky(path):
    """Lit by --sun and --sky alone."""
    document = GltfDocument("a room lit by sun and sky")
    wall, floor = document.matte("wall", WHITE), document.matte("floor", OAK)
    document.thing("floor", (floor, rectangle((-2, 0, 2), (4, 0, 0), (0, 0, -4))))
    document.thing("back wall", (wall, rectangle((-2, 0, -2), (4, 0, 0), (0, 2.5, 0))))
    document.thing("left wall", (wall, rectangle((-2, 0, 2), (0, 0, -4), (0, 2.5, 0))))
    document.thing("right wall", (wall, rectangle((2, 0, -2), (0, 0, 4), (0, 2.5, 0),
                                                  [(0.2, 0.35, 0.75, 0.85)])))
    document.thing("front wall", (wall, rectangle((2, 0, 2), (-4, 0, 0), (0, 2.5, 0))))
    document.thing("ceiling", (wall, rectangle((-2, 2.5, -2), (4, 0, 0), (0, 0, 4))))
    document.thing("table", (document.matte("red", (0.5, 0.12, 0.1)),
                             cylinder(0.45, 0.72, 32).moved(-0.6, 1e-3, -0.8)))
    document.camera("camera", (1.2, 1.6, 1.8), (-0.6, 0.7, -1.0), 60, ASPECT)
    document.save(path)


def downlights(path):
    """Three lamps with a photometric file of their own, close to a wall."""
    document = GltfDocument("downlights with a photometric file")
    _corner(document, document.matte("floor", OAK), document.matte("wall", WHITE), 4.0)
    for i, x in enumerate((-1.0, 0.0, 1.0)):
        document.spot(f"downlight {i + 1}", (x, 2.6, -1.75), (x, 0, -1.75), 100, WARM, 60, 80)
        light = document.json["nodes"][-1]
        light["extras"] = {"photile_ies": "downlight.ies"}
    document.camera("camera", (0, 1.5, 1.9), (0, 1.25, -2), 52, ASPECT)
    document.save(path)
    _write_photometry(path.parent / "downlight.ies")


def _write_photometry(path):
    """LM-63-2002, one axis of symmetry: a beam of 24 degrees with a faint ring at 40."""
    angles = [2.5 * i for i in range(37)]
    candela = [900 * math.exp(-(a / 14) ** 2) + 130 * math.exp(-((a - 40) / 5) ** 2) for a in angles]
    lines = ["IESNA:LM-63-2002", "[TEST] none: made by scenes/make_scenes.py",
             "[MANUFAC] photile", "TILT=NONE", f"1 -1 1 {len(angles)} 1 1 2 0 0 0", "1 1 10",
             " ".join(f"{a:g}" for a in angles), "0", " ".join(f"{c:.1f}" for c in candela)]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def coloured_lamps(path):
    document = GltfDocument("coloured lamps")
    _corner(document, document.matte("floor", WHITE), document.matte("wall", WHITE))
    document.thing("post", (document.matte("post", WHITE),
                            box((0.2, 0.7, 0.2), (0.0, 1e-3, -0.35))))
    for name, x, rgb in (("red", -0.6, (1, 0.05, 0.02)), ("green", 0.0, (0.05, 1, 0.1)),
                         ("blue", 0.6, (0.05, 0.1, 1))):
        _lamp(document, name, 120, sphere(0.06, 24, 12).moved(x, 0.6, 0.35), rgb)
    document.camera("camera", (0, 1.1, 2.4), (0, 0.4, -0.3), 42, ASPECT)
    document.save(path)


SCENES = {"glass-sphere": glass_sphere, "metal-ring": metal_ring, "pool": pool, "glossy-floor": glossy_floor,
          "sun-and-sky": sun_and_sky, "downlights": downlights, "coloured-lamps": coloured_lamps}


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, scene in SCENES.items():
        scene(folder / f"{name}.gltf")
