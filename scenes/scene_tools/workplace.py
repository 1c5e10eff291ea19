"""Things of an office: shapes that stand on y = 0 around their own origin, closed as those of furniture.py."""

import math
import random

from scene_tools.cloth import cushion
from scene_tools.shapes import Shape, box, cylinder, lathe, rounded_box, smoothed, grid, tube


def office_chair():
    """A swivel chair that faces +z: (plastic, metal, cloth)."""
    plastic, metal, cloth = Shape(), Shape(), Shape()
    for number in range(5):
        turn = 72 * number + 18
        arm = tube([(0, 0.105, 0), (0.14, 0.098, 0), (0.295, 0.072, 0)], [0.024, 0.021, 0.015], 12)
        wheel = cylinder(0.029, 0.020, 24).moved(0, 0.002, 0).turned("x", 90)
        wheel.add(cylinder(0.029, 0.020, 24).moved(0, -0.022, 0).turned("x", 90))
        fork = tube([(0.295, 0.032, 0), (0.295, 0.075, 0)], 0.009, 10)
        metal.add(arm.turned("y", turn))
        plastic.add(wheel.moved(0.295, 0.029, 0).add(fork).turned("y", turn))
    plastic.add(cylinder(0.034, 0.10, 24).moved(0, 0.075, 0))
    metal.add(cylinder(0.020, 0.22, 24).moved(0, 0.17, 0))
    plastic.add(rounded_box((0.22, 0.045, 0.24), (0, 0.385, -0.02), 0.014))
    plastic.add(rounded_box((0.45, 0.016, 0.44), (0, 0.425, 0.0), 0.007, arc=1))
    cloth.add(cushion((0.49, 0.075, 0.48), (0, 0.438, 0.01), 0.034, 0.012))

    def bent(p):
        return p[0], p[1], p[2] + 0.06 * (p[0] / 0.23) ** 2 + 0.035 * math.cos(2.4 * p[1] / 0.27)

    back = rounded_box((0.46, 0.54, 0.05), (0, 0, 0), 0.023, (6, 6, 1), 2, bent)
    cloth.add(back.turned("x", -8).moved(0, 0.55, -0.245))
    plastic.add(tube([(0, 0.40, -0.10), (0, 0.405, -0.24), (0, 0.46, -0.285), (0, 0.80, -0.302)],
                     [0.020, 0.020, 0.018, 0.014], 12))
    for sx in (-1, 1):
        plastic.add(tube([(sx * 0.20, 0.418, -0.02), (sx * 0.275, 0.43, -0.02), (sx * 0.285, 0.50, -0.03),
                          (sx * 0.285, 0.645, -0.03)], [0.014, 0.015, 0.015, 0.013], 12))
        plastic.add(rounded_box((0.075, 0.028, 0.25), (sx * 0.28, 0.64, 0.0), 0.012))
    return plastic, metal, cloth


def monitor(width=0.61, height=0.35):
    """A screen that faces +z: (case, panel)."""
    case = rounded_box((width, height, 0.022), (0, 0, 0), 0.006, arc=1)
    case.add(rounded_box((width * 0.45, height * 0.5, 0.03), (0, height * 0.2, -0.018), 0.010, arc=1))
    panel = box((width - 0.016, height - 0.024, 0.003), (0, 0.016, 0.0102))
    for shape in (case, panel):
        shape.positions = shape.turned("x", -4).moved(0, 0.13, 0.0).positions
        shape.normals = shape.turned("x", -4).normals
    case.add(rounded_box((0.06, 0.24, 0.018), (0, 0.008, -0.045), 0.006, arc=1))
    case.add(rounded_box((0.26, 0.012, 0.19), (0, 0, -0.03), 0.005, arc=1))
    return case, panel


def keyboard():
    """Its front side towards +z: (body, keys). 14 mm high, so that it lies below points 2 cm over a desk."""
    body = box((0.435, 0.008, 0.135), (0, 0, 0), 0.002)
    keys = Shape()
    for row, first in enumerate((0.0, 0.0, 0.25, 0.35, 0.6)):
        z = (row - 2) * 0.0245
        for k in range(14 if row < 4 else 3):
            wide, x = 0.0255, -0.205 + (k + first * 0.4) * 0.0295 + 0.004
            if row == 4:
                wide, x = ((0.085, -0.158), (0.15, -0.01), (0.105, 0.147))[k]
            if x + wide / 2 < 0.213:
                keys.add(box((wide, 0.0065, 0.0205), (x, 0.0075, z)))
    return body, keys


def mouse():
    return rounded_box((0.058, 0.026, 0.10), (0, 0, 0), 0.012, (3, 1, 3), 2,
                       lambda p: (p[0] * (1 - 0.1 * (p[2] / 0.05) ** 2),
                                  p[1] * (1 - 0.35 * (p[2] / 0.05) ** 2) if p[1] > 0 else p[1], p[2]))


def pedestal(width=0.40, height=0.56, depth=0.56, drawers=3):
    """Drawers on castors that face +z: (case, handles)."""
    case, handles = box((width, height - 0.04, depth), (0, 0.04, 0), 0.004), Shape()
    one = (height - 0.06) / drawers
    for i in range(drawers):
        y = 0.05 + i * one
        case.add(box((width - 0.012, one - 0.006, 0.016), (0, y, depth / 2 + 0.005), 0.002))
        handles.add(tube([(-0.07, y + one * 0.72, depth / 2 + 0.030), (0.07, y + one * 0.72, depth / 2 + 0.030)], 0.005, 10))
        for sx in (-1, 1):
            handles.add(tube([(sx * 0.055, y + one * 0.72, depth / 2 + 0.010),
                              (sx * 0.055, y + one * 0.72, depth / 2 + 0.0305)], 0.004, 8))
    for sx in (-1, 1):
        for sz in (-1, 1):
            handles.add(cylinder(0.018, 0.043, 16).moved(sx * (width / 2 - 0.05), 0, sz * (depth / 2 - 0.05)))
    return case, handles


def reading_lamp():
    """A lamp of two arms that is off; its head towards +x: all of one piece."""
    shape = cylinder(0.085, 0.016, 40)
    shape.add(tube([(0, 0.014, 0), (-0.06, 0.36, 0)], 0.006, 10)).add(tube([(-0.06, 0.358, 0.0), (0.22, 0.46, 0)], 0.006, 10))
    head = lathe([(0.0, 0.012), (0.052, 0.008), (0.060, 0.0), (0.064, 0.0), (0.056, 0.028), (0.024, 0.044), (0.0, 0.048)], 32)
    return shape.add(head.turned("z", -10).moved(0.235, 0.428, 0))


def binders(first, last, bottom, back, seed):
    """Lever arch files along x on a board: (cases of one colour, of another, labels)."""
    source = random.Random(seed)
    shapes = (Shape(), Shape())
    labels, x, run = Shape(), first, 0
    while x + 0.078 < last:
        if run == 0:
            which, run = source.randrange(2), source.randrange(2, 5)
        run -= 1
        wide = 0.075 if source.random() < 0.7 else 0.052
        at = (x + wide / 2, bottom + 0.001, back + 0.145)
        shapes[which].add(box((wide, 0.315, 0.285), at, 0.003))
        labels.add(box((wide * 0.62, 0.15, 0.0012), (at[0], at[1] + 0.11, at[2] + 0.1426)))
        x += wide + 0.0016
    return shapes[0], shapes[1], labels


def radiator(length=1.6, height=0.56, depth=0.09):
    """A panel with upright grooves that faces +z, its back at z = 0."""
    outline = []
    pitch, count = 0.04, int(length / 0.04)
    for k in range(count):
        x = -length / 2 + k * pitch
        outline += [(x + 0.003, depth), (x + 0.024, depth), (x + 0.028, depth - 0.008), (x + 0.036, depth - 0.008)]
    outline = [(-length / 2, 0.02)] + [(-length / 2, depth - 0.006)] + outline + [(length / 2, depth - 0.006), (length / 2, 0.02)]
    front = [[(x, y, z) for x, z in outline] for y in (0.0, height)]
    back = [[(x, y, 0.02) for x, _ in outline] for y in (0.0, height)]
    shape = grid([front[0], front[1]])
    shape.add(grid([back[1], back[0]])).add(grid([front[1], back[1]])).add(grid([back[0], front[0]]))
    shape = smoothed(shape, 30)
    for sx in (-1, 1):
        shape.add(box((0.03, 0.06, 0.024), (sx * length * 0.35, height * 0.75, 0.0125)))
    return shape


def waste_basket():
    return lathe([(0.0, 0.0), (0.105, 0.0), (0.135, 0.30), (0.132, 0.30), (0.102, 0.004), (0.0, 0.004)], 40)


def wall_clock(radius=0.15):
    """Facing +z, its back at z = 0: (rim, face, hands)."""
    rim = lathe([(radius - 0.006, 0.0), (radius, 0.0), (radius, 0.03), (radius - 0.010, 0.034), (radius - 0.012, 0.012),
                 (radius - 0.006, 0.0)], 64)
    face = lathe([(0.0, 0.004), (radius - 0.007, 0.004), (radius - 0.007, 0.010), (0.0, 0.010)], 64)
    hands = Shape()
    for turn, long, y in ((-62, 0.075, 0.0), (118, 0.11, 0.0025)):
        hands.add(box((0.007, long, 0.002), (0, -0.015, 0.013 + y)).turned("z", turn))
    for k in range(12):
        hands.add(box((0.005, 0.016, 0.0012), (0, radius - 0.034, 0.0106)).turned("z", 30 * k))
    return rim.turned("x", 90), face.turned("x", 90), hands


def coat_stand(height=1.72):
    shape = cylinder(0.17, 0.016, 40).add(tube([(0, 0.014, 0), (0, height, 0)], 0.014, 16))
    for k in range(6):
        hook = tube([(0.010, height - 0.12, 0), (0.07, height - 0.10, 0), (0.10, height - 0.03, 0)], 0.006, 8)
        shape.add(hook.turned("y", 60 * k))
    return shape
