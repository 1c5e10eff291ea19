"""A living room of 6 m x 4.5 m x 2.7 m with six kinds of lamps and a garden outside.

x runs along the window wall (z = 0), y up, z into the room. North is the window wall.
"""

import math

from scene_tools import cloth, furniture, plants, textures
from scene_tools.colour import blackbody_rgb, linear_from_srgb, luminance
from scene_tools.gltf_writer import GltfDocument
from scene_tools.png_writer import write_png
from scene_tools.shapes import (Shape, box, cylinder, grained, grid, lathe, moulding, rectangle, smoothed, sphere,
                                tube)

WIDTH, HEIGHT, DEPTH = 6.0, 2.7, 4.5
WINDOWS = ((0.8, 0.75, 2.3, 2.3), (3.9, 0.75, 5.4, 2.3))  # x0, y0, x1, y1 in the window wall
REVEAL = 0.18   # m, from the wall's inside to the pane
GAP = 0.001     # m, between things and what they stand on
EYE = (5.55, 1.32, 4.1)  # of the first camera; the garden's perspective is drawn for it
FLOOR_TILE = 1.8  # m that the picture of the floor spans

OAK, WALNUT = (0.42, 0.27, 0.14), (0.17, 0.093, 0.05)
TEXTURES = {
    "floor.png": textures.floor, "floor-normals.png": textures.floor_normals,
    "oak.png": lambda: textures.wood(OAK, 81), "walnut.png": lambda: textures.wood(WALNUT, 91),
    "weave-normals.png": textures.weave_normals, "boucle-normals.png": textures.boucle_normals,
    "rug.png": textures.rug, "landscape.png": textures.landscape, "squares.png": textures.squares,
    "botanical.png": textures.botanical, "books.png": textures.book_spines, "lamp-glow.png": textures.lamp_glow,
    "garden.png": textures.garden}


class Room:
    def __init__(self, pictures):
        self.pictures = pictures
        self.document = d = GltfDocument("living-room")
        self.wall_paint = d.matte("wall paint", (0.78, 0.75, 0.69))
        self.accent_paint = d.matte("accent paint", (0.23, 0.29, 0.25))
        self.ceiling_paint = d.matte("ceiling paint", (0.84, 0.84, 0.83))
        self.white_wood = d.glossy("white wood", (0.80, 0.79, 0.76), 0.45)
        self.oak = d.matte("oak", (1, 1, 1), "oak.png")
        self.walnut = d.matte("walnut", (1, 1, 1), "walnut.png")
        self.black_steel = d.glossy("black steel", (0.04, 0.04, 0.045), 0.4)
        self.brass = d.metal("brass", (0.85, 0.62, 0.25), 0.3)
        self.linen = d.matte("linen", (0.72, 0.66, 0.55), normals="weave-normals.png", bumps=0.5)
        self.leaves = d.glossy("leaves", (0.055, 0.115, 0.030), 0.5)
        self.stems = d.matte("stems", (0.13, 0.085, 0.045))
        self.covers = d.glossy("book covers", (1, 1, 1), 0.55, "books.png")
        self.pages = d.matte("pages", (0.74, 0.70, 0.60))
        self.white_ceramic = d.glossy("white ceramic", (0.72, 0.70, 0.66), 0.3)

    def add(self, name, *parts):
        self.document.thing(name, *parts)

    def lamp(self, name, lumen, kelvin, shape):
        """Adds a shape whose front emits, as a light of its own."""
        material = self.document.lamp(name, lumen, shape.area(), blackbody_rgb(kelvin))
        self.add(name, (material, shape))

    def pictured_lamp(self, name, lumen, rgb, shape, picture):
        """The same with a picture of its radiance."""
        mean = _mean_radiance(shape, self.pictures[picture], rgb)
        material = self.document.lamp(name, lumen, shape.area(), rgb, picture, mean)
        self.document.place(name, self.document.mesh(name, (material, shape)), lumen=lumen)


def _mean_radiance(shape, picture, rgb, steps=24):
    """The mean luminance of a picture over a shape, of texels times `rgb`, beside that of `rgb`."""
    rows, columns = len(picture), len(picture[0])
    whole = sum_of_areas = 0.0
    for triangle in shape.triangles:
        one = Shape()
        for i in triangle:
            one.vertex(shape.positions[i], shape.normals[i], shape.uvs[i])
        one.triangles.append((0, 1, 2))
        area, total, count = one.area(), 0.0, 0
        n = steps if area > 0.05 else 2
        for i in range(n):
            for j in range(n - i):
                a, b = (i + 1 / 3) / n, (j + 1 / 3) / n
                u, v = (one.uvs[0][k] + a * (one.uvs[1][k] - one.uvs[0][k]) + b * (one.uvs[2][k] - one.uvs[0][k])
                        for k in range(2))
                texel = picture[int(v * rows) % rows][int(u * columns) % columns]
                total += luminance([linear_from_srgb(t) * c for t, c in zip(texel, rgb)])
                count += 1
        whole += area * total / count
        sum_of_areas += area
    return whole / sum_of_areas / luminance(rgb)


def _shell(room):
    d = room.document
    floor = d.glossy("oak floor", (0.92, 0.92, 0.92), 0.65, "floor.png", "floor-normals.png")
    slab = rectangle((0, 0, DEPTH), (WIDTH, 0, 0), (0, 0, -DEPTH))
    c = math.sqrt(0.5) / FLOOR_TILE  # the herringbone runs along the walls where its blocks lie across them
    slab.uvs = [(c * (p[0] + p[2]), c * (p[2] - p[0])) for p in slab.positions]
    room.add("floor", (floor, slab))
    room.add("ceiling", (room.ceiling_paint,
                         rectangle((0, HEIGHT, 0), (WIDTH, 0, 0), (0, 0, DEPTH))))
    holes = [(x0 / WIDTH, y0 / HEIGHT, x1 / WIDTH, y1 / HEIGHT) for x0, y0, x1, y1 in WINDOWS]
    walls = rectangle((0, 0, 0), (WIDTH, 0, 0), (0, HEIGHT, 0), holes)
    walls.add(rectangle((WIDTH, 0, DEPTH), (-WIDTH, 0, 0), (0, HEIGHT, 0)))
    walls.add(rectangle((WIDTH, 0, 0), (0, 0, DEPTH), (0, HEIGHT, 0)))
    room.add("walls", (room.wall_paint, walls))
    room.add("sofa wall", (room.accent_paint, rectangle((0, 0, DEPTH), (0, 0, -DEPTH), (0, HEIGHT, 0))))


def _mouldings(room):
    """Skirting, the moulding below the ceiling, and panels on the wall behind the sofa."""
    around = [(0, 0, DEPTH), (WIDTH, 0, DEPTH), (WIDTH, 0, 0), (0, 0, 0)]
    board = [(GAP, 0.0), (0.018, 0.0), (0.018, 0.085), (0.014, 0.093), (0.012, 0.105), (0.007, 0.110), (GAP, 0.110)]
    door_from, door_to = DOOR_X - 0.535, DOOR_X + 0.535
    path = [(door_to, GAP, DEPTH), *[(x, GAP, z) for x, _, z in around[1:]], (0, GAP, DEPTH), (door_from, GAP, DEPTH)]
    skirting = moulding(board, path, closed=False)
    crown = [(GAP, 0.0), (0.016, 0.0), (0.020, 0.018), (0.040, 0.036), (0.074, 0.084), (0.090, 0.088), (0.090, 0.104),
             (GAP, 0.104)]
    crown = moulding(crown, [(x, HEIGHT - 0.104 - GAP, z) for x, _, z in around])
    room.add("skirting", (room.white_wood, skirting))
    room.add("crown moulding", (room.ceiling_paint, crown))

    ridge = [(0.0, GAP), (0.026, GAP), (0.020, 0.013), (0.006, 0.013)]
    panels = Shape()
    for z0, z1, y0, y1 in ((0.22, 0.92, 0.30, 2.42), (SOFA_Z - 0.92, SOFA_Z + 0.92, 0.30, 2.42),
                           (3.40, 4.28, 0.30, 2.42)):
        # Seen from the room, +z is to the left.
        panels.add(moulding(ridge, [(0, y0, z1), (0, y0, z0), (0, y1, z0), (0, y1, z1)], (1.0, 0.0, 0.0)))
    room.add("wall panels", (room.accent_paint, panels))


def _windows(room):
    """Reveals, panes that show the garden, the bars before them, and sills."""
    reveals, panes, bars = Shape(), Shape(), Shape()
    # The garden is a plane; from the eye, panes show parts of it in one scale.
    left, right = WINDOWS[0][0], WINDOWS[-1][2]
    low, high = WINDOWS[0][1], WINDOWS[0][3]
    for x0, y0, x1, y1 in WINDOWS:
        w, h, out = x1 - x0, y1 - y0, (0, 0, REVEAL)
        reveals.add(rectangle((x0, y0, 0), (w, 0, 0), (0, 0, -REVEAL)))
        reveals.add(rectangle((x0, y1, -REVEAL), (w, 0, 0), out))
        reveals.add(rectangle((x0, y0, 0), (0, 0, -REVEAL), (0, h, 0)))
        reveals.add(rectangle((x1, y0, -REVEAL), out, (0, h, 0)))
        pane = rectangle((x0, y0, -REVEAL), (w, 0, 0), (0, h, 0))
        pane.uvs = [(0.02 + 0.96 * (p[0] - left) / (right - left), 0.98 - 0.96 * (p[1] - low) / (high - low))
                    for p in pane.positions]
        panes.add(pane)
        middle, z = (x0 + x1) / 2, -REVEAL + 0.05
        for x in (x0 + 0.031, middle, x1 - 0.031):
            bars.add(box((0.06, h - 2 * GAP, 0.05), (x, y0 + GAP, z), bevel=0.005))
        for y in (y0 + 2 * GAP, y1 - 0.060 - 2 * GAP):
            bars.add(box((w - 0.01, 0.060, 0.042), (middle, y, z), bevel=0.005))
        bars.add(box((w - 0.01, 0.026, 0.030), (middle, y0 + h * 0.70, z), bevel=0.004))
        for x in (x0 + w / 4 + 0.015, x1 - w / 4 - 0.015):
            bars.add(box((0.022, h * 0.30, 0.026), (x, y0 + h * 0.70 + 0.006, z), bevel=0.004))
        bars.add(box((w - 2 * GAP, 0.028, 0.150), (middle, y0 + 0.0015, -0.026), bevel=0.005))  # the sill
    room.add("window reveals", (room.white_wood, reveals))
    room.add("window frames", (room.white_wood, bars))
    room.pictured_lamp("daylight", 1200, (1.0, 1.0, 1.0), panes, "garden.png")


def _curtains(room):
    d = room.document
    cloth_of = d.matte("curtain", (0.60, 0.54, 0.44))
    high, rod_y, z = 2.425, 2.442, 0.105
    hanging = [d.mesh(f"curtain {k}", (cloth_of, cloth.curtain(0.36, high - 0.015, 4, 0.036, seed=k))) for k in (1, 2)]
    rods = Shape()
    for number, (x0, _, x1, _) in enumerate(WINDOWS):
        first, last = x0 - 0.27, x1 + 0.27
        d.place(f"curtain {2 * number + 1}", hanging[0], (x0 - 0.06, 0.015, z))
        d.place(f"curtain {2 * number + 2}", hanging[1], (x1 + 0.06, 0.015, z), 180)
        rods.add(tube([(first, rod_y, z), (last, rod_y, z)], 0.012, 16))
        for x in (first - 0.012, last + 0.012):
            rods.add(sphere(0.022, 20, 10).moved(x, rod_y, z))
        for x in (first + 0.03, last - 0.03):
            rods.add(tube([(x, rod_y, GAP), (x, rod_y, z - 0.004)], 0.007, 10))
            rods.add(cylinder(0.022, 0.006, 20).turned("x", 90).moved(x, rod_y, GAP + 0.0003))
    room.add("curtain rods", (room.brass, rods))


def _ceiling_panel(room):
    """A panel that hangs above the dining table."""
    length, width, x, z, bottom = 1.3, 0.20, 4.45, TABLE_Z, 1.86
    rim = [(0.0, 0.0), (0.012, 0.0), (0.012, 0.045), (0.0, 0.045)]
    path = [(x - length / 2 - 0.012, bottom, z + width / 2 + 0.012), (x + length / 2 + 0.012, bottom, z + width / 2 + 0.012),
            (x + length / 2 + 0.012, bottom, z - width / 2 - 0.012), (x - length / 2 - 0.012, bottom, z - width / 2 - 0.012)]
    frame = grained(moulding(rim, path), "x", 1.5)
    top = box((length + 0.004, 0.012, width + 0.004), (x, bottom + 0.026, z))
    room.add("ceiling panel frame", (room.oak, frame.add(grained(top, "x", 1.5))))
    cables, canopy = Shape(), box((0.7, 0.028, 0.06), (x, HEIGHT - 0.028 - GAP, z), bevel=0.004)
    for sx in (-1, 1):
        cables.add(tube([(x + sx * 0.45, bottom + 0.036, z), (x + sx * 0.30, HEIGHT - 0.026, z)], 0.0022, 8))
    room.add("ceiling panel cables", (room.black_steel, cables.add(canopy)))
    room.lamp("ceiling_panel", 1600, 3500, rectangle(
        (x - length / 2 - 0.001, bottom + 0.008, z - width / 2 - 0.001), (length + 0.002, 0, 0), (0, 0, width + 0.002)))


def _floor_lamp(room):
    """A drum of linen on a tripod, closed by discs above and below: all of it glows, the discs most."""
    x, z, foot = 0.50, 0.52, 1.30
    wood, metal = furniture.tripod(foot - 0.012)
    room.add("floor lamp stand", (room.walnut, wood.moved(x, GAP, z)), (room.brass, metal.moved(x, GAP, z)))
    room.pictured_lamp("floor_lamp", 1050, blackbody_rgb(2700), furniture.glowing_drum(0.235, 0.195, 0.33)
                       .moved(x, foot, z), "lamp-glow.png")


def _sconces(room):
    """Two up-lights beside the picture, each a light of its own: half bowls of brass."""
    outline = [(math.cos(math.pi * k / 24), math.sin(math.pi * k / 24)) for k in range(25)]
    for name, z in (("sconce_left", SOFA_Z + 1.08), ("sconce_right", SOFA_Z - 1.08)):
        y, high, wide = 1.62, 0.15, 0.085
        rings = []
        for k in range(7):
            t = k / 6
            r = wide * (0.30 + 0.70 * math.sin(math.pi / 2 * t) ** 0.8)
            ring = [(0.0015 + r * b, high * t, r * a) for a, b in outline]
            rings.append(ring)
        body = smoothed(grid(rings, closed=True), 40).polygon(rings[0][::-1])
        room.add(name.replace("_", " ") + " body", (room.brass, body.moved(0, y, z)))
        room.lamp(name, 400, 3000, Shape().polygon(rings[-1]).moved(0, y, z))


def _sofa_corner(room):
    d = room.document
    frame, seats, first, second, throw, legs = furniture.sofa()
    wool = d.matte("light wool", (0.46, 0.43, 0.37), normals="boucle-normals.png", bumps=0.7)
    teal = d.matte("teal wool", (0.035, 0.145, 0.155), normals="boucle-normals.png", bumps=0.6)
    ochre = d.matte("ochre wool", (0.48, 0.26, 0.065), normals="boucle-normals.png", bumps=0.6)
    rust = d.matte("rust wool", (0.34, 0.115, 0.05), normals="boucle-normals.png", bumps=0.8)
    for shape in (frame, seats):
        shape.uvs = [(u * 4, v * 4) for u, v in shape.uvs]
    sofa = d.mesh("sofa", (wool, frame), (wool, seats), (teal, first), (ochre, second), (rust, throw),
                  (room.walnut, grained(legs, "y", 1.5)))
    d.place("sofa", sofa, (0.56, GAP, SOFA_Z), 90)

    woven = d.matte("rug", (0.95, 0.95, 0.95), "rug.png")
    wide, long, thick = 1.75, 2.45, 0.012
    at = (1.98, GAP, 2.68)
    rug = box((wide, thick, long), without=("+y",))
    top = Shape().polygon([(-wide / 2, thick, long / 2), (wide / 2, thick, long / 2), (wide / 2, thick, -long / 2),
                           (-wide / 2, thick, -long / 2)], [(0, 1), (1, 1), (1, 0), (0, 0)])
    room.add("rug", (room.linen, rug.moved(*at)), (woven, top.moved(*at)))

    stand = thick + 2 * GAP
    d.place("coffee table", d.mesh("coffee table", (room.walnut, furniture.table(1.15, 0.62, 0.40))),
            (1.90, stand, SOFA_Z), 90)
    on_table = stand + 0.40 + GAP
    glass = d.glass("glass", 1.5)
    vase = furniture.glass_vase()
    at = (1.80, on_table, SOFA_Z - 0.18)
    room.add("glass vase", (glass, vase.moved(*at)))
    stems, leaves = plants.branches()
    sage = d.matte("eucalyptus", (0.17, 0.235, 0.165))
    room.add("branches", (room.stems, stems.moved(at[0], on_table + 0.020, at[2])),
             (sage, leaves.moved(at[0], on_table + 0.020, at[2])))
    covers, pages, high = furniture.pile_of_books(2, 3, 0.19, 0.26)
    place = (2.02, on_table, SOFA_Z + 0.26)
    room.add("books on the table", (room.covers, covers.turned("y", 70).moved(*place)),
             (room.pages, pages.turned("y", 70).moved(*place)))
    celadon = d.glossy("celadon", (0.30, 0.42, 0.34), 0.25)
    room.add("mug", (celadon, furniture.mug().turned("y", 40).moved(1.74, on_table, SOFA_Z + 0.16)))

    wood, cushions = furniture.armchair()
    cushions.uvs = [(u * 4, v * 4) for u, v in cushions.uvs]
    d.place("armchair", d.mesh("armchair", (room.walnut, wood), (ochre, cushions)), (1.62, GAP, 0.86), 12)


def _console(room):
    """A narrow table below a round mirror, and a tree in a pot beside it."""
    d = room.document
    x = 3.22
    d.place("console", d.mesh("console", (room.walnut, furniture.table(0.82, 0.26, 0.80, inset=0.05, splay=0.012))),
            (x, GAP, 0.20))
    silver = d.metal("silver", (0.92, 0.92, 0.90), 0.0)
    glass, rim = furniture.round_mirror(0.33)
    room.add("mirror", (silver, glass.moved(x, 1.62, GAP)), (room.brass, rim.moved(x, 1.62, GAP)))
    on = 0.80 + 2 * GAP
    stick, wax = furniture.candle(0.16)
    short, wax2 = furniture.candle(0.10)
    room.add("candlesticks", (room.brass, stick.moved(x + 0.20, on, 0.20).add(short.moved(x + 0.29, on, 0.16))),
             (room.pages, wax.moved(x + 0.20, on, 0.20).add(wax2.moved(x + 0.29, on, 0.16))))
    ceramic = d.glossy("blue ceramic", (0.05, 0.13, 0.30), 0.25)
    room.add("vase", (ceramic, furniture.vase().moved(x - 0.18, on, 0.20)))

    at = (2.62, GAP, 0.50)
    pot, earth = plants.pot(0.165, 0.30)
    wood, leaves = plants.fig_tree(1.35, leaves=54, spread=0.29)
    room.add("tree", (room.white_ceramic, pot.moved(*at)),
             (d.matte("earth", (0.045, 0.030, 0.020)), earth.moved(*at)),
             (room.stems, wood.moved(at[0], 0.275, at[2])), (room.leaves, leaves.moved(at[0], 0.275, at[2])))


def _dining_table(room):
    d = room.document
    x, z = 4.45, TABLE_Z
    d.place("dining table", d.mesh("dining table", (room.oak, furniture.table(1.55, 0.86, 0.74))), (x, GAP, z))
    wood, seat = furniture.chair()
    seat.uvs = [(u * 4, v * 4) for u, v in seat.uvs]
    blue = d.matte("blue wool", (0.10, 0.15, 0.19), normals="boucle-normals.png", bumps=0.6)
    room.chair = d.mesh("chair", (room.oak, wood), (blue, seat))
    for number, (dx, dz, turn) in enumerate(((-0.36, -0.52, 0), (0.38, -0.50, 3),
                                             (-0.36, 0.56, 183), (0.40, 0.72, 158)), 1):
        d.place(f"chair {number}", room.chair, (x + dx, GAP, z + dz), turn)
    on = 0.74 + 2 * GAP
    room.add("bowl", (room.white_ceramic, furniture.bowl().moved(x - 0.22, on, z + 0.04)))
    fruit = d.glossy("lemons", (0.62, 0.42, 0.05), 0.4)
    lemons = Shape()
    for dx, dy, dz, turn in ((0.05, 0.052, 0.03, 20), (-0.055, 0.052, 0.02, 140), (0.0, 0.055, -0.06, 80), (0.0, 0.098, 0.0, 50)):
        one = lathe([(0.034 * math.sin(math.pi * k / 10) ** 0.9 if 0 < k < 10 else 0.0, -0.042 * math.cos(math.pi * k / 10))
                     for k in range(11)], 20)
        lemons.add(one.turned("z", 90).turned("y", turn).moved(x - 0.22 + dx, on + dy, z + 0.04 + dz))
    room.add("lemons", (fruit, lemons))


def _shelf(room):
    d = room.document
    shelf, tops = furniture.shelf(0.98, 2.05, 0.30, 5)
    covers, pages = Shape(), Shape()
    for level, (bottom, first, last) in enumerate(zip(tops, (-0.45, -0.10, -0.45, -0.45, -0.08),
                                                      (0.30, 0.36, 0.0, 0.34, 0.36))):
        for target, more in zip((covers, pages), furniture.row_of_books(first, last, bottom, 0.035, 0.32, level + 3)):
            target.add(more)
    for level, x in ((1, -0.30), (2, 0.27)):
        more = furniture.pile_of_books(3, 5 + level)
        for target, part in zip((covers, pages), more):
            target.add(part.moved(x, tops[level] + GAP, 0.16))
    pot, earth = plants.pot(0.065, 0.12, 0.006, 0.012)
    stems, leaves = plants.trailing()
    at = (-0.28, tops[4] + GAP, 0.17)
    ceramic = d.glossy("terracotta", (0.36, 0.14, 0.075), 0.5)
    small = furniture.vase()
    small.positions = [tuple(0.75 * c for c in p) for p in small.positions]
    mesh = d.mesh("shelf", (room.walnut, shelf), (room.covers, covers), (room.pages, pages),
                  (ceramic, pot.moved(*at)), (room.stems, earth.moved(*at)),
                  (room.stems, stems.moved(at[0], at[1] + 0.108, at[2])),
                  (room.leaves, leaves.moved(at[0], at[1] + 0.108, at[2])),
                  (room.white_ceramic, small.moved(0.33, tops[0] + GAP, 0.15)))
    d.place("shelf", mesh, (0.022, GAP, 3.94), 90)  # before the skirting


def _desk(room):
    d = room.document
    x, z = 1.85, 4.12
    d.place("desk", d.mesh("desk", (room.walnut, furniture.table(1.30, 0.62, 0.73))), (x, GAP, z), 180)
    d.place("desk chair", room.chair, (x - 0.12, GAP, z - 0.50), 10)

    top = 0.73 + 2 * GAP
    lx, lz = x + 0.46, z + 0.14
    steel = cylinder(0.085, 0.018, 40)
    steel.add(tube([(0, 0.016, 0), (0, 0.40, 0)], 0.007, 12))
    steel.add(sphere(0.014, 16, 8).moved(0, 0.40, 0))
    steel.add(tube([(0.06, 0.415, 0.0), (-0.26, 0.445, -0.02)], 0.006, 12))
    room.add("desk lamp stand", (room.brass, steel.moved(lx, top, lz)))
    # A bell, open below; the disc inside it shines downwards.
    bell = lathe([(0.077, 0.0), (0.080, 0.0), (0.074, 0.035), (0.056, 0.068), (0.026, 0.094), (0.018, 0.115),
                  (0.0, 0.115)], 40)
    bell.add(lathe([(0.0, 0.090), (0.023, 0.089), (0.052, 0.066), (0.071, 0.034), (0.077, 0.0)], 40))
    room.add("desk lamp bell", (room.black_steel, bell.moved(lx - 0.26, top + 0.335, lz - 0.02)))
    disc = lathe([(0.0, 0.0), (0.060, 0.0)], 32)
    room.lamp("desk_lamp", 470, 3000, disc.moved(lx - 0.26, top + 0.352, lz - 0.02))
    room.add("papers", (d.matte("paper", (0.80, 0.79, 0.75)),
                        box((0.21, 0.012, 0.297), (0, 0, 0)).turned("y", 8).moved(x - 0.10, top, z - 0.08)))
    covers, pages, _ = furniture.pile_of_books(4, 12)
    room.add("books on the desk", (room.covers, covers.turned("y", 190).moved(x - 0.46, top, z + 0.06)),
             (room.pages, pages.turned("y", 190).moved(x - 0.46, top, z + 0.06)))


def _sideboard(room):
    d = room.document
    wood, knobs = furniture.sideboard()
    d.place("sideboard", d.mesh("sideboard", (room.walnut, wood), (room.brass, knobs)), (WIDTH - 0.022, GAP, 2.45), -90)
    covers, pages, _ = furniture.pile_of_books(3, 21)
    at = (WIDTH - 0.24, 0.72 + 2 * GAP, 2.05)
    room.add("books on the sideboard", (room.covers, covers.turned("y", -80).moved(*at)),
             (room.pages, pages.turned("y", -80).moved(*at)))


def _pictures(room):
    d = room.document
    canvases = {}
    frames = (("landscape", "landscape.png", (1.20, 0.80), (GAP, 1.62, SOFA_Z), 90, room.walnut),
              ("squares", "squares.png", (0.60, 0.80), (1.85, 1.62, DEPTH - GAP), 180, room.oak),
              ("fern", "botanical.png", (0.36, 0.48), (2.62, 1.68, DEPTH - GAP), 180, room.black_steel),
              ("second fern", "botanical.png", (0.36, 0.48), (WIDTH - GAP, 1.55, 2.05), -90, room.oak),
              ("third fern", "botanical.png", (0.36, 0.48), (WIDTH - GAP, 1.55, 2.75), -90, room.oak))
    for name, texture, size, at, turn, frame_material in frames:
        if texture not in canvases:
            canvases[texture] = d.matte(texture[:-4] + " canvas", (0.95, 0.95, 0.95), texture)
        front, rest = furniture.picture(*size)
        frame = furniture.picture_frame(*size)
        mesh = d.mesh(name, (frame_material, grained(frame, "x", 1.5)), (canvases[texture], front.moved(0, 0, 0.006)),
                      (room.pages, rest.moved(0, 0, 0.006)))
        d.place(name, mesh, at, turn)

    # A small fitting; the light itself sits before it, where nothing covers it.
    spot, target = (1.30, HEIGHT - 0.20, SOFA_Z), (0.0, 1.62, SOFA_Z)
    fitting = cylinder(0.045, 0.018, 32).moved(spot[0] + 0.05, HEIGHT - 0.018 - GAP, spot[2])
    fitting.add(tube([(spot[0] + 0.05, HEIGHT - 0.02, spot[2]), (spot[0] + 0.05, HEIGHT - 0.16, spot[2])], 0.006, 12))
    away = math.degrees(math.atan2(spot[0], spot[1] - target[1]))
    head = cylinder(0.034, 0.12, 32).turned("z", -away).moved(spot[0] + 0.012, spot[1] + 0.008, spot[2])
    room.add("picture spot fitting", (room.black_steel, fitting.add(head)))
    d.spot("picture_spot", spot, target, 700, blackbody_rgb(3000), 15, 28)


def _door(room):
    wall = DEPTH - GAP
    door = box((0.86, 2.03, 0.04), (DOOR_X, 0.005, wall - 0.02), bevel=0.003)
    ridge = [(0.0, 0.0), (0.0, 0.006), (0.008, 0.010), (0.018, 0.008), (0.028, 0.0)]
    for y0, y1 in ((0.20, 0.92), (1.08, 1.88)):
        x0, x1, z = DOOR_X - 0.29, DOOR_X + 0.29, wall - 0.0395
        door.add(moulding(ridge[::-1], [(x1, y0, z), (x0, y0, z), (x0, y1, z), (x1, y1, z)], (0.0, 0.0, -1.0)))
    # An architrave, mitred, without a piece on the floor.
    section = [(0.0, 0.0), (0.07, 0.0), (0.07, 0.016), (0.06, 0.020), (0.012, 0.030), (0.0, 0.030)]
    x0, x1 = DOOR_X - 0.505, DOOR_X + 0.505
    frame = moulding(section, [(x1, GAP, wall), (x1, 2.105, wall), (x0, 2.105, wall), (x0, GAP, wall)],
                     (0.0, 0.0, -1.0), closed=False)
    room.add("door", (room.white_wood, door), (room.white_wood, frame))
    knob = lathe([(0.0, 0.0), (0.026, 0.0), (0.026, 0.005), (0.010, 0.010), (0.010, 0.032), (0.024, 0.042),
                  (0.029, 0.055), (0.022, 0.068), (0.0, 0.072)], 32).turned("x", -90)
    room.add("door knob", (room.brass, knob.moved(DOOR_X - 0.37, 1.02, wall - 0.040)))


DOOR_X, SOFA_Z, TABLE_Z = 4.9, 2.12, 1.36


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {name: make() for name, make in TEXTURES.items()}
    for name, picture in pictures.items():
        write_png(folder / name, picture)
    room = Room(pictures)
    for part in (_shell, _mouldings, _windows, _curtains, _ceiling_panel, _floor_lamp, _sconces, _sofa_corner,
                 _console, _dining_table, _shelf, _desk, _sideboard, _pictures, _door):
        part(room)
    room.document.camera("towards the sofa", EYE, (1.2, 1.22, 1.2), 48, 1.5)
    room.document.camera("towards the desk", (3.35, 1.35, 0.55), (2.35, 1.1, 4.3), 52, 1.5)
    room.document.save(folder / "living-room.gltf")
