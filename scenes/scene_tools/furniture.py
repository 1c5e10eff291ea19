"""Furniture: shapes that stand on y = 0 around their own origin.

Parts of one piece run a few millimetres into each other, so that no two faces coincide, and every
part is a closed solid.
"""

import math
import random

from scene_tools.cloth import blanket, cushion, pillow
from scene_tools.shapes import Shape, box, cylinder, grained, grid, lathe, moulding, rounded_box, smoothed, sphere, tube
from scene_tools.textures import BOOK_SPINES


def tapered_leg(height, top=0.024, foot=0.014, splay=(0.0, 0.0)):
    """A turned leg from the floor to y = `height`, its foot moved outwards by `splay`."""
    tilted = foot * math.hypot(*splay) / height  # by which the rim of the foot lies below its centre
    return tube([(splay[0], tilted, splay[1]), (splay[0] * 0.5, height * 0.5, splay[1] * 0.5), (0.0, height, 0.0)],
                [foot, (top + foot) / 2, top], 12)


def table(length, width, height, top=0.032, inset=0.09, splay=0.04):
    """A top with round edges on a frame and four turned legs; `length` along x, and the grain with it."""
    board = rounded_box((length, top, width), (0, height - top, 0), min(0.012, top * 0.4), arc=2)
    shape = grained(board, "x", 1.5)
    for sz in (-1, 1):
        rail = box((length - 2 * inset - 0.03, 0.06, 0.02), (0, height - top - 0.057, sz * (width / 2 - inset)), 0.002)
        shape.add(grained(rail, "x", 1.5, 0.3 * sz))
    for sx in (-1, 1):
        rail = box((0.02, 0.055, width - 2 * inset - 0.03), (sx * (length / 2 - inset), height - top - 0.052, 0), 0.002)
        shape.add(grained(rail, "z", 1.5, 0.7 * sx))
        for sz in (-1, 1):
            leg = tapered_leg(height - top + 0.004, splay=(sx * splay, sz * splay))
            shape.add(grained(leg, "y", 1.5, 0.2 * sx + 0.1 * sz)
                      .moved(sx * (length / 2 - inset), 0, sz * (width / 2 - inset)))
    return shape


def desk(length, width, height, top=0.028, foot=0.05):
    """A top on two steel frames: (top, steel)."""
    board = grained(rounded_box((length, top, width), (0, height - top, 0), 0.006, arc=1), "x", 1.5)
    steel = Shape()
    for sx in (-1, 1):
        x = sx * (length / 2 - 0.10)
        for sz in (-1, 1):
            steel.add(box((foot, height - top + 0.003, foot * 0.6), (x, 0, sz * (width / 2 - 0.06)), 0.003))
        steel.add(box((foot * 0.9, 0.03, width - 0.13), (x, height - top - 0.028, 0), 0.003))
    steel.add(box((length - 0.22, 0.04, 0.018), (0, height - top - 0.045, -width / 2 + 0.07), 0.003))
    return board, steel


def chair():
    """A dining chair that faces +z: (wood, seat)."""
    wood = Shape()
    for sx in (-1, 1):
        wood.add(tapered_leg(0.43, 0.020, 0.012, (sx * 0.025, 0.03)).moved(sx * 0.185, 0, 0.18))
        path = [(sx * 0.20, 0.0025, -0.235), (sx * 0.185, 0.22, -0.195), (sx * 0.18, 0.43, -0.185),
                (sx * 0.175, 0.60, -0.20), (sx * 0.165, 0.78, -0.25)]
        wood.add(tube(path, [0.012, 0.017, 0.019, 0.016, 0.012], 12))
        wood.add(box((0.022, 0.05, 0.34), (sx * 0.185, 0.375, 0.0), 0.004))
    for z in (0.185, -0.185):
        wood.add(box((0.35, 0.048, 0.02), (0, 0.376, z), 0.004))
    wood = grained(wood, "y", 1.5)

    def bent(point):
        return point[0], point[1], point[2] - 0.045 * (1 - (point[0] / 0.20) ** 2)

    for y, z, high in ((0.665, -0.228, 0.115), (0.53, -0.192, 0.035)):
        back = rounded_box((0.37, high, 0.018), (0, y, 0), 0.008, (8, 1, 1), 2, bent)
        wood.add(grained(back, "x", 1.5, y).moved(0, 0, z))
    seat = cushion((0.43, 0.055, 0.42), (0, 0.424, 0.005), 0.024, 0.012)
    return wood, seat


def sofa(length=2.15, depth=0.92):
    """A sofa that faces +z: (frame, cushions, pillows of one colour, of another, blanket, legs)."""
    half, arm = length / 2, 0.17
    inner = length - 2 * arm
    frame = rounded_box((inner + 0.02, 0.19, depth - 0.04), (0, 0.13, 0.0), 0.03, arc=2)
    frame.add(rounded_box((inner + 0.02, 0.60, 0.20), (0, 0, 0), 0.06, (4, 2, 1), 3).turned("x", -7)
              .moved(0, 0.16, -depth / 2 + 0.14))
    legs = Shape()
    for sx in (-1, 1):
        frame.add(rounded_box((arm, 0.47, depth), (sx * (half - arm / 2), 0.12, 0), 0.055, (1, 2, 3), 3))
        for sz in (-1, 1):
            legs.add(tapered_leg(0.135, 0.026, 0.016, (sx * 0.02, sz * 0.02))
                     .moved(sx * (half - 0.12), 0, sz * (depth / 2 - 0.12)))
    seats = Shape()
    width = inner / 3
    for i in (-1, 0, 1):
        seats.add(cushion((width - 0.006, 0.17, 0.70), (i * width, 0.305, 0.115), 0.045, 0.028, seed=i + 2))
        seats.add(cushion((width - 0.008, 0.42, 0.17), (0, 0, 0), 0.065, 0.035, axis=2, seed=i + 5)
                  .turned("x", -14).moved(i * width, 0.475, -0.165))
    first, second = Shape(), Shape()
    for shape, x, z, turn, lean, side, seed in ((first, -0.70, 0.075, 16, -24, 0.46, 1),
                                                (second, -0.40, 0.17, -10, -30, 0.40, 2),
                                                (first, 0.66, 0.085, -18, -24, 0.46, 3)):
        shape.add(pillow(side, 0.17, seed).turned("x", lean).turned("y", turn).moved(x, 0.70 if side > 0.42 else 0.68, z))
    x0, top = half - arm / 2, 0.595
    outline = [(x0 + arm / 2 + 0.004, y) for y in (0.26, 0.34, 0.42, 0.50, 0.54)]
    outline += [(x0 + 0.04 + 0.05 * math.cos(a), top - 0.05 + 0.05 * math.sin(a)) for a in (0.35, 0.8, 1.25)]
    outline += [(x0 + 0.02, top + 0.003), (x0 - 0.02, top + 0.003)]
    outline += [(x0 - 0.04 - 0.05 * math.cos(a), top - 0.05 + 0.05 * math.sin(a)) for a in (1.25, 0.8)]
    outline += [(x0 - arm / 2 - 0.004, y) for y in (0.545, 0.52)]
    throw = blanket(0.42, outline[::-1]).turned("y", 90).moved(0, 0, 0.08)
    return frame, seats, first, second, throw, legs


def armchair():
    """An easy chair that faces +z: (wood, cushions)."""
    wood, cushions = Shape(), Shape()
    for sx in (-1, 1):
        x = sx * 0.335
        wood.add(tube([(x * 1.03, 0.002, 0.36), (x, 0.30, 0.325), (x, 0.545, 0.30)], [0.013, 0.019, 0.017], 12))
        wood.add(tube([(x * 1.03, 0.005, -0.40), (x, 0.30, -0.31), (x, 0.54, -0.33)], [0.013, 0.019, 0.015], 12))
        arm = rounded_box((0.062, 0.024, 0.72), (x, 0.538, 0.0), 0.011, (1, 1, 6), 2,
                          lambda p: (p[0], p[1] + 0.025 * (p[2] / 0.36) ** 2, p[2]))
        wood.add(grained(arm, "z", 1.5, 0.4 * sx))
        wood.add(tube([(x, 0.285, 0.325), (x, 0.225, -0.30)], 0.016, 10))
    for y, z in ((0.27, 0.31), (0.225, -0.27)):
        wood.add(tube([(-0.335, y, z), (0.335, y, z)], 0.015, 10))
    cushions.add(cushion((0.60, 0.15, 0.66), (0, 0, 0), 0.045, 0.03, seed=11).turned("x", 5).moved(0, 0.29, 0.035))
    cushions.add(cushion((0.59, 0.58, 0.15), (0, 0, 0), 0.055, 0.04, axis=2, seed=12).turned("x", -19)
                 .moved(0, 0.40, -0.215))
    for sx in (-1, 1):
        wood.add(tube([(sx * 0.2, 0.24, -0.27), (sx * 0.2, 0.60, -0.405), (sx * 0.19, 0.86, -0.50)],
                      [0.013, 0.014, 0.010], 10))
    wood.add(tube([(-0.21, 0.84, -0.492), (0.21, 0.84, -0.492)], 0.011, 8))
    return grained(wood, "y", 1.5), cushions


def shelf(width=1.4, height=2.0, depth=0.30, boards=5, thick=0.024):
    """An open shelf that faces +z, its back at z = 0: (shelf, heights of the boards' tops)."""
    shape = Shape()
    for sx in (-1, 1):
        side = box((thick, height, depth), (sx * (width - thick) / 2, 0, depth / 2), bevel=0.003)
        shape.add(grained(side, "y", 1.5, 0.4 * sx))
    back = box((width - thick, height - 0.03, 0.008), (0, 0.01, 0.006))
    shape.add(grained(back, "y", 1.5, 0.9))
    tops = []
    for i in range(boards + 1):
        bottom = 0.06 + i * (height - 0.10) / boards
        board = box((width - 2 * thick + 0.006, thick, depth - 0.02), (0, bottom, depth / 2 + 0.003), bevel=0.003)
        shape.add(grained(board, "x", 1.5, 0.23 * i))
        tops.append(bottom + thick)
    plinth = box((width - 2 * thick + 0.004, 0.055, 0.018), (0, 0.006, depth - 0.04))
    shape.add(grained(plinth, "x", 1.5, 0.6))
    return shape, tops[:-1]


def book(thick, tall, deep, spine):
    """A book that stands with its spine at z = deep, along x in the middle: (cover, pages)."""
    board = 0.0028
    u0, u1 = (spine + 0.06) / BOOK_SPINES, (spine + 0.94) / BOOK_SPINES
    # A band around the pages, seen from above: outside, then inside, with the spine bent outwards.
    h, bend = thick / 2, 0.12 * thick
    outside = [(-h, 0.0), (-h, deep - bend), (-0.5 * h, deep - 0.3 * bend), (0.5 * h, deep - 0.3 * bend),
               (h, deep - bend), (h, 0.0)]
    inside = [(h - board, 0.0), (h - board, deep - 0.010), (board - h, deep - 0.010), (board - h, 0.0)]
    loop = outside + inside
    cover = grid([[(x, y, z) for x, z in loop] for y in (0.0, tall)], closed=True)
    for ends in (0.0, tall):
        # Between the six points outside and the four inside, of which two are met twice.
        rows = [[(x, ends, z) for x, z in outside], [(*inside[k][:1], ends, inside[k][1]) for k in (3, 2, 2, 1, 1, 0)]]
        cover.add(grid(rows if ends else rows[::-1]))
    cover = smoothed(cover, 45)
    cover.uvs = [(u0 + (u1 - u0) * (0.5 + p[0] / thick), 0.93 * (1 - p[1] / tall)) if n[2] > 0.4 and p[2] > 0.5 * deep
                 else ((spine + 0.5) / BOOK_SPINES, 0.97) for p, n in zip(cover.positions, cover.normals)]
    pages = box((thick - 2 * board + 0.0006, tall - 0.008, deep - 0.014), (0, 0.004, (deep - 0.014) / 2 + 0.003))
    return cover, pages


def row_of_books(first, last, bottom, back, height, seed, depth=(0.15, 0.20)):
    """Books along x between two positions on a board: (covers, pages). Those of one height are one solid, whose
    picture tells them apart; a last one leans on the others."""
    source = random.Random(seed)
    covers, pages = Shape(), Shape()
    x = first
    while x + 0.05 < last:
        count = source.randrange(2, 6)
        thick = min(count * source.uniform(0.024, 0.034), last - x)
        tall, deep, spine = height * source.uniform(0.68, 0.95), source.uniform(*depth), source.randrange(BOOK_SPINES)
        rows = box((thick, tall, deep), (0, 0, deep / 2))
        u0, u1 = spine / BOOK_SPINES, (spine + count) / BOOK_SPINES
        rows.uvs = [(u0 + (u1 - u0) * (0.5 + p[0] / thick), 0.93 * (1 - p[1] / tall)) if n[2] > 0.5 else (u0 + 0.016, 0.97)
                    for p, n in zip(rows.positions, rows.normals)]
        covers.add(rows.moved(x + thick / 2, bottom + 0.001, back))
        pages.add(box((thick - 0.006, 0.0015, deep - 0.012), (x + thick / 2, bottom + tall + 0.0008, back + deep / 2 - 0.004)))
        x += thick + 0.0012
    tall, lean = height * 0.7, 9
    c, s = math.cos(math.radians(lean)), math.sin(math.radians(lean))
    for target, part in zip((covers, pages), book(0.028, tall, depth[0], source.randrange(BOOK_SPINES))):
        target.add(part.moved(0.014, 0, 0).turned("z", lean).moved(x + tall * s + 0.002, bottom + 0.001, back))
    return covers, pages


def pile_of_books(count, seed, width=0.16, length=0.23):
    """Books that lie on each other, their spines towards +z: (covers, pages, height)."""
    source = random.Random(seed)
    covers, pages, y = Shape(), Shape(), 0.0
    for number in range(count):
        thick, scale = source.uniform(0.02, 0.036), 1 - 0.08 * number
        turn = source.uniform(-9, 9)
        parts = book(thick, length * scale, width * scale, source.randrange(BOOK_SPINES))
        for target, part in zip((covers, pages), parts):
            target.add(part.moved(0, -length * scale / 2, -width * scale / 2).turned("z", 90)
                       .moved(0, y + thick / 2, 0).turned("y", turn))
        y += thick + 0.001
    return covers, pages, y


def sideboard(width=1.6, height=0.72, depth=0.42, doors=3):
    """A low cupboard that faces +z, its back at z = 0: (wood, knobs)."""
    legs = 0.16
    wood = grained(box((width, height - legs, depth - 0.02), (0, legs, (depth - 0.02) / 2 + 0.002), 0.004), "x", 1.5)
    one = (width - 0.03) / doors
    knobs = Shape()
    for i in range(doors):
        x = (i - (doors - 1) / 2) * one
        door = box((one - 0.008, height - legs - 0.04, 0.02), (x, legs + 0.02, depth - 0.012), 0.003)
        wood.add(grained(door, "y", 1.5, 0.31 * (i + 1)))
        knobs.add(sphere(0.013, 16, 8).moved(x + one / 2 - 0.06, legs + (height - legs) * 0.62, depth + 0.010))
    for sx in (-1, 1):
        for z in (0.06, depth - 0.07):
            leg = tapered_leg(legs + 0.004, 0.020, 0.012, (sx * 0.03, 0.0)).moved(sx * (width / 2 - 0.12), 0, z)
            wood.add(grained(leg, "y", 1.5))
    return wood, knobs


def vase():
    """A round-bellied vase with a wall of 6 mm, 0.32 m high."""
    outside = [(0.0, 0.0), (0.050, 0.0), (0.075, 0.03), (0.100, 0.08), (0.108, 0.13), (0.098, 0.18),
               (0.070, 0.225), (0.043, 0.255), (0.036, 0.28), (0.042, 0.305), (0.052, 0.32)]
    inside = [(0.046, 0.32), (0.036, 0.303), (0.030, 0.28), (0.037, 0.255), (0.064, 0.222),
              (0.092, 0.178), (0.102, 0.13), (0.094, 0.082), (0.070, 0.036), (0.048, 0.008),
              (0.0, 0.008)]
    return lathe(outside + inside, 48)


def glass_vase(height=0.24, radius=0.062):
    """A blown vase of clear glass with a thick foot and a wall of 4 mm."""
    outside, inside = [], []
    for i in range(13):
        t = i / 12
        r = radius * (0.70 + 0.42 * math.sin(math.pi * min(1.0, t * 1.12 + 0.02)) ** 1.3 + 0.20 * t ** 4)
        outside.append((r, 0.004 + (height - 0.004) * t))
        if t > 0.1:
            inside.append((r - 0.004, 0.004 + (height - 0.004) * t))
    foot = [(0.0, 0.0), (outside[0][0] - 0.004, 0.0)]
    return lathe(foot + outside + inside[::-1] + [(0.5 * inside[0][0], inside[0][1] - 0.006),
                                                  (0.0, inside[0][1] - 0.008)], 48, 50)


def bowl():
    """A shallow bowl, 0.28 m wide."""
    outside = [(0.0, 0.0), (0.06, 0.0), (0.065, 0.008), (0.105, 0.03), (0.130, 0.055), (0.140, 0.08)]
    inside = [(0.134, 0.08), (0.124, 0.058), (0.100, 0.036), (0.062, 0.014), (0.0, 0.012)]
    return lathe(outside + inside, 40)


def mug():
    """A mug with its handle towards +x."""
    outside = [(0.0, 0.0), (0.036, 0.0), (0.040, 0.004), (0.040, 0.092)]
    inside = [(0.0365, 0.092), (0.0365, 0.008), (0.0, 0.007)]
    path = [(0.039 + 0.026 * math.sin(math.pi * i / 8), 0.048 + 0.026 * math.cos(math.pi * i / 8), 0.0)
            for i in range(9)]
    return lathe(outside + inside, 32).add(tube(path, 0.0042, 8))


def candle(height=0.16):
    """A candlestick and its candle: (stick, candle)."""
    stick = lathe([(0.0, 0.0), (0.042, 0.0), (0.042, 0.006), (0.012, 0.014), (0.008, height * 0.5),
                   (0.010, height * 0.9), (0.020, height), (0.0, height)], 32)
    wax = lathe([(0.0, 0.0), (0.011, 0.0), (0.009, 0.2), (0.004, 0.205), (0.0, 0.205)], 20)
    return stick, wax.moved(0, height + 0.0005, 0)


def glowing_drum(bottom_radius, top_radius, height, segments=48):
    """A closed drum that stands on y = 0. Texture coordinates: v = 0.06 on the discs above and below, and from 0.3
    at the top to 0.95 at the bottom of its side."""
    side = lathe([(bottom_radius, 0.0), (top_radius, height)], segments)
    side.uvs = [(0.5, 0.95 - 0.65 * v) for _, v in side.uvs]
    discs = lathe([(0.0, 0.0), (bottom_radius, 0.0)], segments)
    discs.add(lathe([(top_radius, height), (0.0, height)], segments))
    discs.uvs = [(0.5, 0.06)] * len(discs.uvs)
    return side.add(discs)


def tripod(height, spread=0.24, segments=12):
    """Three legs that meet below y = height: (wood, metal)."""
    wood, metal = Shape(), Shape()
    for number in range(3):
        turn = 2 * math.pi * number / 3 + 0.5
        c, s = math.cos(turn), math.sin(turn)
        leg = tube([(spread * c, 0.002, spread * s), (0.020 * c, height - 0.03, 0.020 * s)], [0.010, 0.014], segments)
        wood.add(grained(leg, "y", 1.5, 0.3 * number))
    metal.add(cylinder(0.040, 0.055, 32).moved(0, height - 0.055, 0))
    return wood, metal


_FRAME = [(0.0, 0.0), (0.0, 0.016), (0.004, 0.023), (0.012, 0.026), (0.022, 0.023), (0.027, 0.015), (0.030, 0.014),
          (0.030, 0.0)]


def picture_frame(width, height, bar=0.035, depth=0.028):
    """A frame around an opening of width x height, facing +z, the back at z = 0."""
    w, h = width / 2 + bar, height / 2 + bar
    profile = [(a / 0.030 * bar, b / 0.026 * depth) for a, b in _FRAME]
    # The profile's first side is the outer one; seen along the path its inside is to the left.
    return moulding([(a, b) for a, b in reversed(profile)], [(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)],
                    (0.0, 0.0, 1.0))


def picture(width, height, thick=0.004):
    """The picture behind a frame's opening, facing +z, its back at z = 0: (picture, its back and sides)."""
    w, h = width / 2 + 0.004, height / 2 + 0.004
    front = Shape().polygon([(-w, -h, thick), (w, -h, thick), (w, h, thick), (-w, h, thick)],
                            [(0, 1), (1, 1), (1, 0), (0, 0)])
    return front, box((2 * w, 2 * h, thick), (0, -h, thick / 2), without=("+z",))


def round_mirror(radius, bar=0.022, segments=96):
    """A round mirror and its rim, facing +z, the back at z = 0: (mirror, rim)."""
    rim = [(radius + 0.004, 0.0), (radius + bar, 0.0), (radius + bar, 0.018), (radius + bar * 0.6, 0.025),
           (radius, 0.022), (radius - 0.004, 0.014), (radius - 0.004, 0.008), (radius + 0.004, 0.0)]
    glass = lathe([(0.0, 0.0095), (radius, 0.0095), (radius, 0.012), (0.0, 0.012)], segments)
    return glass.turned("x", 90), lathe(rim, segments).turned("x", 90)
