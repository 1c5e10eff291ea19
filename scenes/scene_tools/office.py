"""An office of 6 m x 5 m x 2.8 m with two windows to the south, empty and furnished, without lamps, and the
photometric file of a panel for its ceiling; docs/project.md lights it."""

import math

from scene_tools import furniture
from scene_tools.gltf_writer import GltfDocument
from scene_tools.shapes import Shape, box, cylinder, rectangle

WIDTH, DEPTH, HEIGHT = 6.0, 5.0, 2.8
REVEAL, GAP = 0.3, 1e-3
WINDOWS = ((0.6, 0.9, 2.8, 2.5), (3.2, 0.9, 5.4, 2.5))  # x and y from and to
DESK = (1.6, 0.8, 0.73)
PLACES = ((2.6, 1.5, -90), (3.4, 1.5, 90), (2.6, 3.3, -90), (3.4, 3.3, 90))  # x, z, turn
PANEL_LUMENS, PANEL_SIDE = 3600, 0.58


def _shell(document):
    wall = document.matte("wall", (0.5, 0.5, 0.5))
    floor = document.matte("carpet", (0.2, 0.2, 0.2))
    ceiling = document.matte("ceiling", (0.8, 0.8, 0.8))
    document.thing("floor", (floor, rectangle((0, 0, DEPTH), (WIDTH, 0, 0), (0, 0, -DEPTH))))
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


def _door(document):
    wood = document.matte("door", (0.35, 0.22, 0.12))
    document.thing("door", (wood, box((0.95, 2.05, 0.05), (5.2, 0.005, GAP + 0.026), bevel=0.004)))


def _desks(document):
    """Two pairs of desks face to face along the windows, each with a screen and a chair."""
    birch = document.matte("desk", (0.45, 0.40, 0.32))
    dark = document.matte("screen", (0.04, 0.04, 0.04))
    fabric = document.matte("fabric", (0.05, 0.16, 0.24))
    desk = document.mesh("desk", (birch, furniture.table(*DESK, leg=0.05)))
    screen = box((0.6, 0.36, 0.03), (0, 0.12, 0), bevel=0.004)
    screen.add(box((0.05, 0.2, 0.02), (0, 0.008, -0.02))).add(cylinder(0.11, 0.012, 20))
    screen = document.mesh("screen", (dark, screen))
    chair = document.mesh("chair", (fabric, furniture.chair()))
    for number, (x, z, turn) in enumerate(PLACES, 1):
        side = -1 if turn < 0 else 1  # where the chair stands
        document.place(f"desk {number}", desk, (x, GAP, z), turn)
        document.place(f"screen {number}", screen, (x - 0.22 * side, DESK[2] + 2 * GAP, z), turn)
        document.place(f"chair {number}", chair, (x + 0.62 * side, GAP, z), -turn)


def _shelf(document):
    shelf, tops = furniture.shelf(1.6, 1.9, 0.35, 4)
    white = document.matte("shelf", (0.7, 0.7, 0.68))
    binders = [document.matte(f"binder {i}", rgb) for i, rgb in
               enumerate(((0.5, 0.08, 0.06), (0.08, 0.16, 0.35), (0.25, 0.25, 0.25)), 1)]
    rows = [Shape() for _ in binders]
    for level, bottom in enumerate(tops):
        row = furniture.row_of_books(-0.76, (0.3, 0.76, 0.5, 0.1)[level], bottom, 0.05, 0.34, level,
                                     len(binders))
        for shape, more in zip(rows, row):
            shape.add(more)
    mesh = document.mesh("shelf", (white, shelf), *zip(binders, rows))
    document.place("shelf", mesh, (2.2, GAP, 0.06))


def _document(title):
    document = GltfDocument(title)
    _shell(document)
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
    empty = _document("an empty office")
    empty.save(folder / "office-empty.gltf")
    office = _document("an office with four desks")
    for part in (_door, _desks, _shelf):
        part(office)
    office.save(folder / "office.gltf")
    _write_panel(folder / "panel.ies")
