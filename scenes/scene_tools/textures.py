"""Procedural pictures for the living room, as rows of sRGB code values."""

import math
import random

from scene_tools.colour import srgb_from_linear


def _encoded(rgb):
    return tuple(srgb_from_linear(c) for c in rgb)


def planks(size=256, across=4, seed=1):
    """Oak boards along v, four across; repeats in both directions. Albedo about 0.3."""
    random_source = random.Random(seed)
    boards = [(random_source.uniform(0.8, 1.15), random_source.randrange(size)) for _ in range(across)]
    grain = [random_source.uniform(-1, 1) for _ in range(size)]
    width = size // across
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            tone, end = boards[x // width]
            wave = math.sin(2 * math.pi * (3 * y / size + grain[x] * 0.08)) * 0.05
            shade = tone * (1 + 0.12 * grain[x] + wave)
            if x % width == 0 or (y - end) % size == 0:
                shade *= 0.45  # the joints
            row.append(_encoded((0.42 * shade, 0.27 * shade, 0.15 * shade)))
        rows.append(row)
    return rows


def rug(width=96, height=160):
    """A woven rug with a border and a field of diamonds."""
    wool, blue, ochre = (0.55, 0.49, 0.40), (0.06, 0.11, 0.22), (0.48, 0.26, 0.07)
    rows = []
    for y in range(height):
        row = []
        for x in range(width):
            edge = min(x, y, width - 1 - x, height - 1 - y)
            diamond = abs((x + 8) % 16 - 8) + abs((y + 8) % 16 - 8)
            if edge < 4 or 8 <= edge < 10:
                rgb = blue
            elif edge < 8:
                rgb = ochre
            else:
                rgb = blue if 7 <= diamond <= 8 else ochre if diamond < 3 else wool
            thread = 0.94 if (x + y) % 2 else 1.0
            row.append(_encoded([c * thread for c in rgb]))
        rows.append(row)
    return rows


def landscape(width=128, height=96):
    """A painting: hills in three tones under an evening sky."""
    hills = ((0.62, 0.05, 3.0, (0.20, 0.25, 0.30)), (0.72, 0.06, 5.0, (0.10, 0.18, 0.12)),
             (0.86, 0.04, 2.0, (0.05, 0.08, 0.03)))
    rows = []
    for y in range(height):
        v, row = y / height, []
        for x in range(width):
            u = x / width
            rgb = (0.75 - 0.35 * (0.6 - v), 0.35 + 0.3 * (0.6 - v), 0.18 + 0.6 * (0.6 - v))
            if math.hypot(u - 0.68, (v - 0.5) * height / width) < 0.07:
                rgb = (0.80, 0.60, 0.25)
            for level, swing, waves, tone in hills:
                if v > level + swing * math.sin(waves * 2 * u + 9 * level):
                    rgb = tone
            row.append(_encoded(rgb))
        rows.append(row)
    return rows


def squares(width=96, height=128, seed=5):
    """A painting: a grid of colour fields on a pale ground."""
    random_source = random.Random(seed)
    palette = ((0.60, 0.10, 0.05), (0.70, 0.45, 0.08), (0.08, 0.18, 0.35), (0.10, 0.30, 0.20),
               (0.70, 0.66, 0.58))
    fields = [[random_source.choice(palette) for _ in range(6)] for _ in range(8)]
    rows = []
    for y in range(height):
        row = []
        for x in range(width):
            inside = 2 <= x % 16 < 15 and 2 <= y % 16 < 15
            row.append(_encoded(fields[y // 16][x // 16] if inside else (0.72, 0.70, 0.64)))
        rows.append(row)
    return rows
