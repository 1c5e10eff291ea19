"""Furniture for the living room: shapes that stand on y = 0 around their own origin.

Parts of one piece run a few millimetres into each other, so that no two faces coincide, and every
part is a closed solid.
"""

import random

from scene_tools.shapes import Shape, box, cylinder, lathe


def table(length, width, height, top=0.03, leg=0.06, inset=0.05):
    """A top and four legs; `length` along x."""
    shape = box((length, top, width), (0, height - top, 0), bevel=0.004)
    for sx in (-1, 1):
        for sz in (-1, 1):
            shape.add(box((leg, height - top + 0.005, leg),
                          (sx * (length / 2 - inset), 0, sz * (width / 2 - inset))))
    return shape


def chair():
    """A dining chair that faces +z."""
    shape = box((0.44, 0.035, 0.44), (0, 0.43, 0), bevel=0.01)
    for sx in (-1, 1):
        shape.add(box((0.035, 0.435, 0.035), (sx * 0.19, 0, 0.19)))
        shape.add(box((0.036, 0.92, 0.036), (sx * 0.19, 0, -0.19)))
    for height in (0.56, 0.68, 0.80):
        shape.add(box((0.36, 0.07, 0.018), (0, height, -0.19)))
    return shape


def sofa(length=2.1, depth=0.9):
    """Frame and cushions of a sofa that faces +z: (frame, cushions, pillows)."""
    half = length / 2
    frame = box((length - 0.02, 0.30, depth - 0.02), (0, 0.06, 0), bevel=0.02)
    frame.add(box((length - 0.03, 0.72, 0.18), (0, 0.07, -depth / 2 + 0.105), bevel=0.03))
    for sx in (-1, 1):
        frame.add(box((0.18, 0.50, depth), (sx * (half - 0.09), 0.065, 0), bevel=0.03))
        for sz in (-1, 1):
            frame.add(cylinder(0.025, 0.08, 12).moved(sx * (half - 0.1), 0, sz * (depth / 2 - 0.1)))
    cushions, pillows = Shape(), Shape()
    width = (length - 0.36) / 3
    for i in (-1, 0, 1):
        cushions.add(box((width - 0.01, 0.13, 0.66), (i * width, 0.362, 0.09), bevel=0.03))
        cushions.add(box((width - 0.01, 0.36, 0.14), (0, 0, 0), bevel=0.04)
                     .turned("x", -12).moved(i * width, 0.51, -0.13))
    for sx, turn in ((-1, 25), (1, -20)):
        pillows.add(box((0.38, 0.38, 0.12), bevel=0.05).turned("x", -22).turned("y", -sx * turn)
                    .moved(sx * (half - 0.42), 0.52, 0.10))
    return frame, cushions, pillows


def shelf(width=1.4, height=2.0, depth=0.30, boards=5):
    """An open shelf that faces +z, its back at z = 0: (shelf, heights of the boards' tops)."""
    thick = 0.022
    shape = Shape()
    for sx in (-1, 1):
        shape.add(box((thick, height, depth), (sx * (width - thick) / 2, 0, depth / 2), bevel=0.002))
    shape.add(box((width - thick, height - 0.03, 0.008), (0, 0.01, 0.006)))
    tops = []
    for i in range(boards + 1):
        bottom = 0.06 + i * (height - 0.10) / boards
        shape.add(box((width - 2 * thick + 0.006, thick, depth - 0.02), (0, bottom, depth / 2 + 0.003),
                      bevel=0.002))
        tops.append(bottom + thick)
    return shape, tops[:-1]


def row_of_books(first, last, bottom, depth_from, height, seed, colours):
    """Books along x between two positions on a board, as one shape per colour."""
    random_source = random.Random(seed)
    shapes = [Shape() for _ in range(colours)]
    x = first
    while True:
        thick = random_source.uniform(0.018, 0.045)
        tall, deep = height * random_source.uniform(0.7, 0.95), random_source.uniform(0.15, 0.20)
        if x + thick > last:
            return shapes
        shapes[random_source.randrange(colours)].add(
            box((thick, tall, deep), (x + thick / 2, bottom + 0.001, depth_from + deep / 2)))
        x += thick + 0.0015


def vase():
    """A round-bellied vase with a wall of 6 mm, 0.32 m high."""
    outside = [(0.0, 0.0), (0.050, 0.0), (0.075, 0.03), (0.100, 0.08), (0.108, 0.13), (0.098, 0.18),
               (0.070, 0.225), (0.043, 0.255), (0.036, 0.28), (0.042, 0.305), (0.052, 0.32)]
    inside = [(0.046, 0.32), (0.036, 0.303), (0.030, 0.28), (0.037, 0.255), (0.064, 0.222),
              (0.092, 0.178), (0.102, 0.13), (0.094, 0.082), (0.070, 0.036), (0.048, 0.008),
              (0.0, 0.008)]
    return lathe(outside + inside, 36)


def bowl():
    """A shallow bowl, 0.28 m wide."""
    outside = [(0.0, 0.0), (0.06, 0.0), (0.065, 0.008), (0.105, 0.03), (0.130, 0.055), (0.140, 0.08)]
    inside = [(0.134, 0.08), (0.124, 0.058), (0.100, 0.036), (0.062, 0.014), (0.0, 0.012)]
    return lathe(outside + inside, 32)


def lamp_shade(bottom_radius, top_radius, height, thick=0.004, segments=32):
    """An open cone of a shade, standing on y = 0."""
    return lathe([(bottom_radius - thick, 0.0), (bottom_radius, 0.0), (top_radius, height),
                  (top_radius - thick, height), (bottom_radius - thick, 0.0)], segments)


def picture_frame(width, height, bar=0.04, depth=0.03):
    """Four bars around an opening of width x height, facing +z, the back at z = 0."""
    shape = Shape()
    for sy in (-1, 1):
        shape.add(box((width + 2 * bar, bar, depth), (0, sy * (height + bar) / 2 - bar / 2, depth / 2),
                      bevel=0.004))
    for sx in (-1, 1):
        shape.add(box((bar, height + 0.006, depth - 0.006),
                      (sx * (width + bar) / 2, -height / 2 - 0.003, depth / 2), bevel=0.003))
    return shape


def picture(width, height):
    """The canvas behind a frame's opening, facing +z at z = 0; its texture upright and whole."""
    w, h = width / 2 + 0.005, height / 2 + 0.005
    return Shape().polygon([(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)],
                           [(0, 1), (1, 1), (1, 0), (0, 0)])
