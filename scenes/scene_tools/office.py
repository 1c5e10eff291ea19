"""An office of 6 m x 5 m x 2.8 m with two windows to the south, empty and furnished, without lamps, and the
photometric file of a panel for its ceiling; docs/guide/project.md lights it."""

import math

from scene_tools import furniture, plants, textures, workplace
from scene_tools.gltf_writer import GltfDocument
from scene_tools.png_writer import write_png
from scene_tools.shapes import Shape, box, cylinder, moulding, rectangle, rounded_box, tube

WIDTH, DEPTH, HEIGHT = 6.0, 5.0, 2.8
REVEAL, GAP = 0.3, 1e-3
WINDOWS = ((0.6, 0.9, 2.8, 2.5), (3.2, 0.9, 5.4, 2.5))  # x and y from and to
DESK = (1.6, 0.8, 0.73)
PLACES = ((2.6, 1.5, -90), (3.4, 1.5, 90), (2.6, 3.3, -90), (3.4, 3.3, 90))  # x, z, turn
PANEL_LUMENS, PANEL_SIDE = 3600, 0.58


def _shell(document, carpet_texture):
    wall = document.matte("wall", (0.5, 0.5, 0.5))
    # With a texture the factor leaves room for --reflectance: the texture's albedo is 0.4.
    albedo = 0.2 if carpet_texture is None else 0.5
    carpet = document.matte("carpet", (albedo, albedo, albedo), carpet_texture)
    ceiling = document.matte("ceiling", (0.8, 0.8, 0.8))
    document.thing("floor", (carpet, rectangle((0, 0, DEPTH), (WIDTH, 0, 0), (0, 0, -DEPTH))))
    document.thing("ceiling", (ceiling, rectangle((0, HEIGHT, 0), (WIDTH, 0, 0), (0, 0, DEPTH))))
    document.thing("north wall", (wall, rectangle((0, 0, 0), (WIDTH, 0, 0), (0, HEIGHT, 0))))
    document.thing("west wall", (wall, rectangle((0, 0, DEPTH), (0, 0, -DEPTH), (0, HEIGHT, 0))))
    document.thing("east wall", (wall, rectangle((WIDTH, 0, 0), (0, 0, DEPTH), (0, HEIGHT, 0))))
    holes = [((WIDTH - x1) / WIDTH, y0 / HEIGHT, (WIDTH - x0) / WIDTH, y1 / HEIGHT)
             for x0, y0, x1, y1 in WINDOWS]
    document.thing("south wall", (wall, rectangle((WIDTH, 0, DEPTH), (-WIDTH, 0, 0), (0, HEIGHT, 0),
                                                  holes)))


def _windows(document):
    """Reveals, frames and panes of thin glass."""
    reveals, frames, panes = Shape(), Shape(), Shape()
    for x0, y0, x1, y1 in WINDOWS:
        w, h, out, z = x1 - x0, y1 - y0, (0, 0, REVEAL), DEPTH + REVEAL
        reveals.add(rectangle((x0, y0, z), (w, 0, 0), (0, 0, -REVEAL)))
        reveals.add(rectangle((x0, y1, DEPTH), (w, 0, 0), out))
        reveals.add(rectangle((x0, y0, z), (0, 0, -REVEAL), (0, h, 0)))
        reveals.add(rectangle((x1, y0, DEPTH), out, (0, h, 0)))
        panes.add(rectangle((x1, y0, z), (-w, 0, 0), (0, h, 0)))
        for x in (x0 + 0.026, (x0 + x1) / 2, x1 - 0.026):
            frames.add(box((0.05, h - 2 * GAP, 0.05), (x, y0 + GAP, z - 0.05), bevel=0.004))
        for y in (y0 + 2 * GAP, y1 - 0.049 - 2 * GAP):
            frames.add(box((w - 0.01, 0.049, 0.042), ((x0 + x1) / 2, y, z - 0.05), bevel=0.004))
    white = document.matte("window frame", (0.8, 0.8, 0.8))
    document.thing("reveals", (white, reveals))
    document.thing("window frames", (white, frames))
    document.thing("panes", (document.pane("pane", 0.85), panes))


def _door_and_skirting(document):
    white = document.glossy("white lacquer", (0.72, 0.72, 0.70), 0.45)
    wood = document.glossy("door", (0.35, 0.22, 0.12), 0.5)
    steel = document.metal("steel", (0.56, 0.56, 0.57), 0.4)
    x, z = 5.1, GAP
    leaf = box((0.90, 2.05, 0.045), (x, 0.006, z + 0.024), bevel=0.003)
    section = [(0.0, 0.0), (0.06, 0.0), (0.06, 0.022), (0.0, 0.030)]
    x0, x1 = x - 0.453, x + 0.453
    frame = moulding(section, [(x0, z, z), (x0, 2.06, z), (x1, 2.06, z), (x1, z, z)], (0.0, 0.0, 1.0), closed=False)
    handle = cylinder(0.026, 0.006, 32).turned("x", 90).moved(x - 0.38, 1.02, z + 0.046)
    handle.add(tube([(x - 0.38, 1.02, z + 0.05), (x - 0.38, 1.02, z + 0.10), (x - 0.375, 1.02, z + 0.105),
                               (x - 0.26, 1.02, z + 0.105)], 0.009, 12))
    document.thing("door", (wood, leaf), (white, frame), (steel, handle))
    board = [(GAP, 0.0), (0.014, 0.0), (0.014, 0.075), (0.010, 0.080), (GAP, 0.080)]
    path = [(x0 - 0.063, 0), (0, 0), (0, DEPTH), (WIDTH, DEPTH), (WIDTH, 0), (x1 + 0.063, 0)]
    document.thing("skirting", (white, moulding(board, [(px, GAP, pz) for px, pz in path], closed=False)))


def _below_the_windows(document):
    """Sills and radiators."""
    white = document.glossy("white enamel", (0.74, 0.74, 0.73), 0.4)
    sills = Shape()
    radiator = document.mesh("radiator", (white, workplace.radiator()))
    for number, (x0, y0, x1, _) in enumerate(WINDOWS, 1):
        sills.add(box((x1 - x0 - 2 * GAP, 0.03, REVEAL - 0.06), ((x0 + x1) / 2, y0 + GAP, DEPTH + REVEAL / 2 - 0.065),
                      bevel=0.004))
        document.place(f"radiator {number}", radiator, ((x0 + x1) / 2, 0.16, DEPTH - GAP), 180)
    document.thing("sills", (white, sills))


def _desks(document):
    """Two pairs of desks face to face along the windows, each with what its owner needs."""
    birch = document.glossy("desk", (1, 1, 1), 0.5, "birch.png")
    steel = document.glossy("grey steel", (0.30, 0.30, 0.31), 0.5)
    black = document.glossy("black plastic", (0.035, 0.035, 0.037), 0.5)
    glass = document.glossy("screen", (0.012, 0.012, 0.014), 0.25)
    light = document.glossy("light plastic", (0.58, 0.58, 0.57), 0.5)
    aluminium = document.metal("aluminium", (0.68, 0.68, 0.69), 0.4)
    fabric = document.matte("fabric", (0.05, 0.16, 0.24))
    white = document.glossy("white case", (0.70, 0.70, 0.69), 0.45)
    paper = document.matte("paper", (0.78, 0.78, 0.75))
    red = document.glossy("red ceramic", (0.42, 0.07, 0.045), 0.3)
    ochre = document.matte("notebook", (0.50, 0.30, 0.06))
    top, frame = furniture.desk(*DESK)
    desk = document.mesh("desk", (birch, top), (steel, frame))
    case, panel = workplace.monitor()
    screen = document.mesh("screen", (black, case), (glass, panel))
    plastic, metal, cloth = workplace.office_chair()
    chair = document.mesh("chair", (black, plastic), (aluminium, metal), (fabric, cloth))
    body, keys = workplace.keyboard()
    typing = document.mesh("keyboard", (light, body), (black, keys))
    pointing = document.mesh("mouse", (black, workplace.mouse()))
    drawers, handles = workplace.pedestal()
    pedestal = document.mesh("pedestal", (white, drawers), (steel, handles))
    sheet = document.mesh("papers", (paper, box((0.21, 0.008, 0.297))))
    book = document.mesh("notebook", (ochre, box((0.15, 0.010, 0.21), bevel=0.002)))
    mug = document.mesh("mug", (red, furniture.mug()))
    lamp = document.mesh("reading lamp", (steel, workplace.reading_lamp()))

    for number, (x, z, turn) in enumerate(PLACES, 1):
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

        def put(name, mesh, along, towards, height=DESK[2] + 2 * GAP, twist=0.0):
            """On the desk: along it, and from its middle towards who sits there."""
            document.place(f"{name} {number}", mesh, (x + c * along + s * towards, height, z - s * along + c * towards),
                           turn + twist)

        document.place(f"desk {number}", desk, (x, GAP, z), turn)
        put("screen", screen, 0.0, -0.20, twist=(2, -4, 0, 3)[number - 1])
        if number in (2, 3):
            put("second screen", screen, (0.0, 0.64, -0.64, 0.0)[number - 1], -0.16, twist=(0, -16, 16, 0)[number - 1])
        put("keyboard", typing, -0.03, 0.16, twist=(-2, 3, 0, 2)[number - 1])
        put("mouse", pointing, 0.29, 0.17, twist=(8, -12, 5, 14)[number - 1])
        put("pedestal", pedestal, 0.50, 0.04, GAP)
        put("chair", chair, (0.02, -0.05, 0.0, 0.06)[number - 1], (0.62, 0.66, 0.60, 0.70)[number - 1], GAP,
            180 + (6, -14, 0, 22)[number - 1])
        put("papers", sheet, -0.48, 0.10, twist=(5, -9, 12, 3)[number - 1])
        put("notebook", book, (-0.36, 0.48, -0.30, 0.50)[number - 1], (-0.18, 0.10, -0.2, 0.12)[number - 1],
            twist=(20, 8, -15, -6)[number - 1])
        put("mug", mug, (0.46, -0.30, 0.40, -0.40)[number - 1], -0.08, twist=50 * number)
        if number in (1, 4):
            put("reading lamp", lamp, -0.62, -0.25, twist=-20)


def _storage(document):
    shelf, tops = furniture.shelf(1.6, 1.9, 0.35, 4)
    white = document.glossy("shelf", (0.70, 0.70, 0.68), 0.45)
    colours = (document.matte("binder 1", (0.10, 0.20, 0.26)), document.matte("binder 2", (0.52, 0.52, 0.49)))
    label = document.matte("label", (0.80, 0.80, 0.78))
    cases, labels = (Shape(), Shape()), Shape()
    covers, pages = Shape(), Shape()
    for level, (bottom, kind) in enumerate(zip(tops, "abab")):
        if kind == "a":
            *more, tags = workplace.binders(-0.76, (0.45, 0, 0.76, 0)[level], bottom, 0.03, level + 2)
            for target, part in zip(cases, more):
                target.add(part)
            labels.add(tags)
        else:
            first, last = ((0, 0), (-0.30, 0.62), (0, 0), (-0.76, 0.10))[level]
            for target, part in zip((covers, pages), furniture.row_of_books(first, last, bottom, 0.05, 0.34, level + 4)):
                target.add(part)
    mesh = document.mesh("shelf", (white, shelf), *zip(colours, cases), (label, labels),
                         (document.glossy("book covers", (1, 1, 1), 0.55, "books.png"), covers), (label, pages))
    document.place("shelf", mesh, (1.55, GAP, 0.018))
    green = document.glossy("leaves", (0.055, 0.115, 0.030), 0.5)
    stem = document.matte("stems", (0.13, 0.085, 0.045))
    terracotta = document.matte("terracotta", (0.36, 0.15, 0.08))
    pot, earth = plants.pot(0.07, 0.13, 0.006, 0.012)
    stems, leaves = plants.trailing()
    at = (1.55 + 0.52, tops[3] + 2 * GAP, 0.018 + 0.18)
    document.thing("small plant", (terracotta, pot.moved(*at)), (stem, earth.moved(*at)),
                   (stem, stems.moved(at[0], at[1] + 0.118, at[2])), (green, leaves.moved(at[0], at[1] + 0.118, at[2])))
    pot, earth = plants.pot(0.20, 0.36)
    wood, leaves = plants.fig_tree(1.45, 5, 80, 0.27)
    at = (0.52, GAP, 0.52)
    document.thing("tree", (document.glossy("planter", (0.62, 0.61, 0.58), 0.4), pot.moved(*at)), (stem, earth.moved(*at)),
                   (stem, wood.moved(at[0], 0.335, at[2])), (green, leaves.moved(at[0], 0.335, at[2])))


def _walls(document):
    """A white board, panels that take sound, a clock, a coat stand and baskets."""
    steel = document.metal("brushed steel", (0.58, 0.58, 0.59), 0.4)
    board = document.glossy("white board", (0.76, 0.76, 0.76), 0.25)
    frame, sheet = furniture.picture_frame(1.7, 1.0, 0.018, 0.020), furniture.picture(1.7, 1.0)
    for part in sheet:
        part.positions = [(x, y, z + 0.004) for x, y, z in part.positions]
    tray = box((0.6, 0.012, 0.06), (0.0, -0.54, 0.031), bevel=0.003)
    document.place("white board", document.mesh("white board", (steel, frame.add(tray)), (board, sheet[0].add(sheet[1]))),
                   (WIDTH - GAP, 1.50, 2.50), -90)
    felt = [document.matte("felt", (0.30, 0.32, 0.33)), document.matte("ochre felt", (0.46, 0.30, 0.10))]
    for number, (x, wide, which) in enumerate(((2.78, 0.56, 0), (3.38, 0.56, 1), (3.98, 0.56, 0)), 1):
        panel = rounded_box((wide, 1.2, 0.04), (x, 0.90, GAP + 0.0205), 0.012)
        document.thing(f"felt panel {number}", (felt[which], panel))
    rim, face, hands = workplace.wall_clock()
    document.place("clock", document.mesh("clock", (document.glossy("black rim", (0.03, 0.03, 0.03), 0.4), rim.add(hands)),
                                          (document.matte("dial", (0.78, 0.78, 0.76)), face)), (3.38, 2.38, GAP))
    document.thing("coat stand", (document.glossy("black steel", (0.04, 0.04, 0.045), 0.4),
                                  workplace.coat_stand().moved(5.72, GAP, 0.42)))
    basket = document.mesh("basket", (document.glossy("grey plastic", (0.12, 0.12, 0.125), 0.5), workplace.waste_basket()))
    for number, (x, z) in enumerate(((2.05, 2.52), (3.95, 2.36)), 1):
        document.place(f"basket {number}", basket, (x, GAP, z))


def _document(title, carpet_texture=None):
    document = GltfDocument(title)
    _shell(document, carpet_texture)
    _windows(document)
    document.camera("from the windows", (0.45, 1.6, 4.7), (4.1, 0.85, 1.2), 58, 1.5)
    return document


def _write_panel(path):
    """LM-63-2002: a square panel behind prisms, which dim it towards the horizon. Its luminance falls from 6,400
    cd/m2 below it to 1,400 at 65 degrees."""
    angles = [2.5 * i for i in range(37)]
    shape = [math.cos(math.radians(a)) ** 2.75 for a in angles]
    peak = PANEL_LUMENS * (2.75 + 1) / (2 * math.pi)
    lines = ["IESNA:LM-63-2002", "[TEST] none: made by scenes/make_scenes.py", "[MANUFAC] photile",
             "[LUMINAIRE] square panel behind prisms", "TILT=NONE",
             f"1 -1 1 {len(angles)} 1 1 2 {PANEL_SIDE} {PANEL_SIDE} 0", "1 1 30",
             " ".join(f"{a:g}" for a in angles), "0",
             " ".join(f"{peak * s:.1f}" for s in shape)]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in {"carpet.png": textures.carpet, "books.png": textures.book_spines,
                       "birch.png": lambda: textures.wood((0.47, 0.40, 0.30), 101, contrast=0.6)}.items():
        write_png(folder / name, make())
    empty = _document("an empty office")
    empty.save(folder / "office-empty.gltf")
    office = _document("an office with four desks", "carpet.png")
    for part in (_door_and_skirting, _below_the_windows, _desks, _storage, _walls):
        part(office)
    office.camera("from the door", (5.45, 1.45, 0.55), (1.6, 1.05, 4.2), 60, 1.5)
    office.save(folder / "office.gltf")
    _write_panel(folder / "panel.ies")
