"""A living room of 6 m x 4.5 m x 2.7 m with six kinds of lamps and daylight.

x runs along the window wall (z = 0), y up, z into the room. North is the window wall.
"""

from scene_tools import furniture, textures
from scene_tools.colour import blackbody_rgb
from scene_tools.gltf_writer import GltfDocument
from scene_tools.png_writer import write_png
from scene_tools.shapes import Shape, box, cylinder, lathe, rectangle, sphere

WIDTH, HEIGHT, DEPTH = 6.0, 2.7, 4.5
WINDOWS = ((1.0, 0.9, 2.6, 2.3), (3.4, 0.9, 5.0, 2.3))  # x0, y0, x1, y1 in the window wall
REVEAL = 0.18   # m, from the wall's inside to the pane
GAP = 0.001     # m, between things and what they stand on

TEXTURES = {"oak-planks.png": textures.planks, "rug.png": textures.rug,
            "landscape.png": textures.landscape, "squares.png": textures.squares}


class Room:
    def __init__(self):
        self.document = d = GltfDocument("living-room")
        self.wall_paint = d.matte("wall paint", (0.78, 0.75, 0.69))
        self.ceiling_paint = d.matte("ceiling paint", (0.84, 0.84, 0.83))
        self.white_wood = d.matte("white wood", (0.80, 0.79, 0.76))
        self.oak = d.matte("oak", (0.45, 0.29, 0.15))
        self.walnut = d.matte("walnut", (0.20, 0.11, 0.06))
        self.black_steel = d.glossy("black steel", (0.04, 0.04, 0.045), 0.4)

    def add(self, name, *parts):
        self.document.thing(name, *parts)

    def lamp(self, name, lumen, kelvin, shape):
        """Adds a shape whose front emits, as a light of its own."""
        material = self.document.lamp(name, lumen, shape.area(), blackbody_rgb(kelvin))
        self.add(name, (material, shape))


def _shell(room):
    d = room.document
    floor = d.matte("oak planks", (0.95, 0.95, 0.95), "oak-planks.png")
    room.add("floor", (floor, rectangle((0, 0, DEPTH), (WIDTH, 0, 0), (0, 0, -DEPTH), uv_scale=1.4)))
    room.add("ceiling", (room.ceiling_paint,
                         rectangle((0, HEIGHT, 0), (WIDTH, 0, 0), (0, 0, DEPTH))))
    holes = [(x0 / WIDTH, y0 / HEIGHT, x1 / WIDTH, y1 / HEIGHT) for x0, y0, x1, y1 in WINDOWS]
    walls = rectangle((0, 0, 0), (WIDTH, 0, 0), (0, HEIGHT, 0), holes)
    walls.add(rectangle((WIDTH, 0, DEPTH), (-WIDTH, 0, 0), (0, HEIGHT, 0)))
    walls.add(rectangle((0, 0, DEPTH), (0, 0, -DEPTH), (0, HEIGHT, 0)))
    walls.add(rectangle((WIDTH, 0, 0), (0, 0, DEPTH), (0, HEIGHT, 0)))
    room.add("walls", (room.wall_paint, walls))


def _windows(room):
    """Reveals, panes that give daylight, and the bars before them."""
    reveals, panes, bars = Shape(), Shape(), Shape()
    for x0, y0, x1, y1 in WINDOWS:
        w, h, out = x1 - x0, y1 - y0, (0, 0, REVEAL)
        reveals.add(rectangle((x0, y0, 0), (w, 0, 0), (0, 0, -REVEAL)))
        reveals.add(rectangle((x0, y1, -REVEAL), (w, 0, 0), out))
        reveals.add(rectangle((x0, y0, 0), (0, 0, -REVEAL), (0, h, 0)))
        reveals.add(rectangle((x1, y0, -REVEAL), out, (0, h, 0)))
        panes.add(rectangle((x0, y0, -REVEAL), (w, 0, 0), (0, h, 0)))
        middle, z = (x0 + x1) / 2, -REVEAL + 0.05
        for x in (x0 + 0.026, middle, x1 - 0.026):
            bars.add(box((0.05, h - 2 * GAP, 0.05), (x, y0 + GAP, z), bevel=0.004))
        for y in (y0 + 2 * GAP, y1 - 0.049 - 2 * GAP):
            bars.add(box((w - 0.01, 0.049, 0.042), (middle, y, z), bevel=0.004))
        bars.add(box((w + 0.12, 0.03, 0.22), (middle, y0 - 0.032, 0.111), bevel=0.005))  # the sill
    room.add("window reveals", (room.white_wood, reveals))
    room.add("window frames", (room.white_wood, bars))
    room.lamp("daylight", 6000, 7500, panes)


def _ceiling_panel(room):
    length, width, high, x, z = 1.2, 0.3, 0.045, 4.1, 1.55
    bottom = HEIGHT - GAP - high
    room.add("ceiling panel housing",
             (room.white_wood, box((length, high, width), (x, bottom, z), without=("-y",))))
    room.lamp("ceiling_panel", 3200, 4000, rectangle(
        (x - length / 2, bottom, z - width / 2), (length, 0, 0), (0, 0, width)))


def _floor_lamp(room):
    x, z = 0.45, 0.55
    stand = cylinder(0.15, 0.025, 32).add(cylinder(0.012, 1.36, 12).moved(0, 0.02, 0))
    room.add("floor lamp stand", (room.black_steel, stand.moved(x, GAP, z)))
    linen = room.document.matte("linen", (0.82, 0.76, 0.64))
    room.add("floor lamp shade", (linen, furniture.lamp_shade(0.24, 0.17, 0.32).moved(x, 1.32, z)))
    room.lamp("floor_lamp", 1050, 2700, sphere(0.045, 16, 8).moved(x, 1.43, z))


def _sconces(room):
    """Two up-lights above the sofa, each a light of its own."""
    for name, z in (("sconce_left", 3.35), ("sconce_right", 1.25)):
        size, x, y = (0.10, 0.16, 0.22), 0.052, 1.62
        room.add(name.replace("_", " ") + " body",
                 (room.white_wood, box(size, (x, y, z), without=("+y",))))
        room.lamp(name, 400, 3000, rectangle((x - size[0] / 2, y + size[1], z + size[2] / 2),
                                             (size[0], 0, 0), (0, 0, -size[2])))


def _sofa_corner(room):
    d = room.document
    frame, cushions, pillows = furniture.sofa()
    grey, teal = d.matte("grey wool", (0.36, 0.36, 0.35)), d.matte("teal wool", (0.05, 0.22, 0.24))
    fabric = d.matte("light wool", (0.48, 0.47, 0.44))
    sofa = d.mesh("sofa", (grey, frame), (fabric, cushions), (teal, pillows))
    d.place("sofa", sofa, (0.50, GAP, 2.3), 90)

    woven = d.matte("rug", (0.95, 0.95, 0.95), "rug.png")
    rug = box((1.5, 0.010, 2.5), without=("+y",))
    top = Shape().polygon([(-0.75, 0.010, 1.25), (0.75, 0.010, 1.25), (0.75, 0.010, -1.25),
                           (-0.75, 0.010, -1.25)], [(0, 1), (1, 1), (1, 0), (0, 0)])
    room.add("rug", (room.walnut, rug.moved(1.95, GAP, 2.3)), (woven, top.moved(1.95, GAP, 2.3)))

    stand = 0.010 + 2 * GAP
    d.place("coffee table", d.mesh("coffee table", (room.oak, furniture.table(1.1, 0.6, 0.42))),
            (1.95, stand, 2.3), 90)
    ceramic = d.glossy("blue ceramic", (0.05, 0.13, 0.30), 0.25)
    on_table = stand + 0.42 + GAP
    room.add("vase", (ceramic, furniture.vase().moved(1.88, on_table, 2.62)))
    celadon = d.matte("celadon", (0.42, 0.55, 0.44))
    room.add("bowl", (celadon, furniture.bowl().moved(2.0, on_table, 2.05)))


def _dining_table(room):
    d = room.document
    x, z = 4.1, 1.55
    d.place("dining table", d.mesh("dining table", (room.oak, furniture.table(1.5, 0.85, 0.74))),
            (x, GAP, z))
    chair = d.mesh("chair", (room.white_wood, furniture.chair()))
    for number, (dx, dz, turn) in enumerate(((-0.38, -0.55, 0), (0.38, -0.58, 4),
                                             (-0.38, 0.58, 184), (0.40, 0.70, 162)), 1):
        d.place(f"chair {number}", chair, (x + dx, GAP, z + dz), turn)


def _shelf(room):
    d = room.document
    shelf, tops = furniture.shelf()
    colours = ((0.45, 0.08, 0.05), (0.07, 0.14, 0.30), (0.55, 0.45, 0.28), (0.08, 0.24, 0.14),
               (0.70, 0.68, 0.62))
    covers = [d.matte(f"book cover {i}", rgb) for i, rgb in enumerate(colours, 1)]
    books = [Shape() for _ in colours]
    for level, bottom in enumerate(tops):
        last = (0.66, 0.30, 0.66, 0.10, 0.45)[level]
        row = furniture.row_of_books(-0.66, last, bottom, 0.03, 0.30, level, len(colours))
        for shape, more in zip(books, row):
            shape.add(more)
    mesh = d.mesh("shelf", (room.walnut, shelf), *zip(covers, books))
    d.place("shelf", mesh, (WIDTH - 0.02, GAP, 1.15), -90)  # before the skirting


def _desk(room):
    d = room.document
    x, z = 4.3, 4.12
    d.place("desk", d.mesh("desk", (room.walnut, furniture.table(1.4, 0.68, 0.73, leg=0.05))),
            (x, GAP, z), 180)
    d.place("desk chair", d.json["nodes"][_node_of(d, "chair 1")]["mesh"], (x - 0.1, GAP, z - 0.55), 12)

    top = 0.73 + 2 * GAP
    lx, lz = x + 0.5, z + 0.15
    arm = cylinder(0.08, 0.02, 24).add(cylinder(0.008, 0.42, 10).moved(0, 0.015, 0))
    arm.add(cylinder(0.007, 0.26, 10).turned("z", 90).moved(0.005, 0.43, 0))
    room.add("desk lamp stand", (room.black_steel, arm.moved(lx, top, lz)))
    # A bell, open below; the disc inside it shines downwards.
    bell = lathe([(0.071, 0.0), (0.075, 0.0), (0.055, 0.06), (0.022, 0.10), (0.0, 0.10)], 24)
    bell.add(lathe([(0.0, 0.094), (0.019, 0.094), (0.051, 0.058), (0.071, 0.0)], 24))
    room.add("desk lamp bell", (room.black_steel, bell.moved(lx - 0.26, top + 0.33, lz)))
    disc = lathe([(0.0, 0.0), (0.045, 0.0)], 24)
    room.lamp("desk_lamp", 470, 3000, disc.moved(lx - 0.26, top + 0.37, lz))
    paper = d.matte("paper", (0.82, 0.81, 0.78))
    room.add("papers", (paper, box((0.21, 0.012, 0.297), (0, 0, 0)).turned("y", 8)
                        .moved(x - 0.05, top, z - 0.08)))


def _node_of(document, name):
    return next(i for i, node in enumerate(document.json["nodes"]) if node["name"] == name)


def _pictures(room):
    d = room.document
    for name, texture, size, at, turn in (
            ("landscape", "landscape.png", (1.0, 0.75), (GAP, 1.65, 2.3), 90),
            ("squares", "squares.png", (0.6, 0.8), (4.2, 1.72, DEPTH - GAP), 180)):
        canvas = d.matte(name + " canvas", (0.95, 0.95, 0.95), texture)
        mesh = d.mesh(name, (room.black_steel, furniture.picture_frame(*size)),
                      (canvas, furniture.picture(*size).moved(0, 0, 0.012)))
        d.place(name, mesh, at, turn)
    silver = d.metal("silver", (0.92, 0.92, 0.90), 0.0)
    mesh = d.mesh("mirror", (room.oak, furniture.picture_frame(0.7, 1.3)),
                  (silver, furniture.picture(0.7, 1.3).moved(0, 0, 0.012)))
    d.place("mirror", mesh, (WIDTH - GAP, 1.25, 3.05), -90)

    # A small fitting; the light itself sits below it, where nothing covers it.
    spot = (1.15, HEIGHT - 0.13, 2.3)
    fitting = cylinder(0.035, 0.11, 20).moved(spot[0], HEIGHT - 0.11 - GAP, spot[2])
    room.add("picture spot fitting", (room.black_steel, fitting))
    d.spot("picture_spot", spot, (0.0, 1.65, 2.3), 700, blackbody_rgb(3000), 15, 28)


def _door_and_skirting(room):
    d = room.document
    wall = DEPTH - GAP
    door = box((0.86, 2.03, 0.04), (1.2, 0.005, wall - 0.02), bevel=0.003)
    for y in (0.2, 1.1):
        door.add(box((0.56, 0.72, 0.012), (1.2, y, wall - 0.043), bevel=0.004))
    frame = Shape()
    for sx in (-1, 1):
        frame.add(box((0.07, 2.08, 0.06), (1.2 + sx * 0.47, GAP, wall - 0.03), bevel=0.004))
    frame.add(box((1.02, 0.07, 0.056), (1.2, 2.045, wall - 0.029), bevel=0.004))
    room.add("door", (room.white_wood, door), (room.oak, frame))
    room.add("door knob", (d.metal("brass", (0.85, 0.62, 0.25), 0.3),
                           sphere(0.028, 20, 10).moved(1.52, 1.02, wall - 0.075)))
    board, thick = 0.07, 0.014
    skirting = Shape()
    for z, x0, x1 in ((GAP + thick / 2, 0.02, WIDTH - 0.02),
                      (wall - thick / 2, 0.02, 0.68), (wall - thick / 2, 1.72, WIDTH - 0.02)):
        skirting.add(box((x1 - x0, board, thick), ((x0 + x1) / 2, GAP, z), bevel=0.003))
    for x in (GAP + thick / 2, WIDTH - GAP - thick / 2):
        skirting.add(box((thick, board, DEPTH - 0.04), (x, GAP, DEPTH / 2), bevel=0.003))
    room.add("skirting", (room.white_wood, skirting))


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in TEXTURES.items():
        write_png(folder / name, make())
    room = Room()
    for part in (_shell, _windows, _ceiling_panel, _floor_lamp, _sconces, _sofa_corner,
                 _dining_table, _shelf, _desk, _pictures, _door_and_skirting):
        part(room)
    room.document.camera("towards the sofa", (5.6, 1.55, 3.55), (1.1, 0.95, 1.55), 52, 1.5)
    room.document.camera("towards the desk", (0.55, 1.6, 0.75), (4.9, 1.0, 3.1), 50, 1.5)
    room.document.save(folder / "living-room.gltf")
