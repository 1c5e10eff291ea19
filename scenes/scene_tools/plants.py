"""Plants: every leaf and stem is a closed solid."""

import math
import random

from scene_tools.shapes import Shape, cross, grid, lathe, normalised, smoothed, tube


def leaf(base, direction, length, width, droop=0.2, fold=0.15, sections=5, blunt=0.8):
    """A leaf that leaves `base` along a direction: two skins that meet at its rim."""
    direction = normalised(direction)
    side = normalised(cross(direction, (0.02, 1.0, 0.013)))
    up = cross(side, direction)
    rows = []
    for i in range(sections + 1):
        s = i / sections
        half = 0.5 * width * math.sin(math.pi * min(1.0, s ** blunt)) if 0 < i < sections else 0.0
        middle = [b + length * s * d for b, d in zip(base, direction)]
        middle[1] -= droop * length * s * s
        thick = 0.0012 if 0 < i < sections else 0.0
        rim = [[m + sign * half * c + fold * half * u for m, c, u in zip(middle, side, up)] for sign in (-1, 1)]
        above = [m + thick * u for m, u in zip(middle, up)]
        below = [m - thick * u for m, u in zip(middle, up)]
        rows.append([tuple(p) for p in (rim[0], above, rim[1], below)])
    shape = grid(rows, closed=True)
    return smoothed(shape, 60)


def fig_tree(height=1.45, seed=3, leaves=70, spread=0.26):
    """A tree in a tub, which grows from y = 0: (wood, leaves). It leans towards +z, away from a wall."""
    source = random.Random(seed)
    wood, foliage = Shape(), Shape()
    stems = []
    for number in range(3):
        turn = 2 * math.pi * number / 3 + 0.4
        top = (0.11 * math.cos(turn), height * (0.82 + 0.09 * number), 0.11 * math.sin(turn) + 0.06)
        path = []
        for i in range(9):
            t = i / 8
            sway = 0.02 * math.sin(5 * t + turn)
            path.append((top[0] * t ** 1.5 + 0.02 * math.cos(turn) + sway, top[1] * t,
                         top[2] * t ** 1.5 + 0.02 * math.sin(turn) - sway))
        wood.add(tube(path, [0.013 - 0.008 * i / 8 for i in range(9)], 7))
        stems.append(path)
    for number in range(leaves):
        path = stems[number % 3]
        t = 0.36 + 0.64 * (number // 3) / ((leaves - 1) // 3)
        k = min(int(t * 8), 7)
        f = t * 8 - k
        base = [a + (b - a) * f for a, b in zip(path[k], path[k + 1])]
        turn = 2.4 * number + source.uniform(-0.4, 0.4)
        rise = source.uniform(0.05, 0.5) + 0.9 * max(0.0, t - 0.75)
        direction = (math.cos(turn), rise, max(-0.35, math.sin(turn)) + 0.15)
        size = spread * source.uniform(0.75, 1.1) * (1.15 - 0.45 * t)
        foliage.add(leaf(base, direction, size, 0.6 * size, source.uniform(0.15, 0.5), 0.2, 6, 1.25))
    return wood, foliage


def branches(height=0.42, seed=4, stems=6, pairs=8, foot=0.03, size=0.05):
    """Cut branches with round leaves, for a vase: (stems, leaves)."""
    source = random.Random(seed)
    wood, foliage = Shape(), Shape()
    for number in range(stems):
        turn = 2 * math.pi * number / stems + source.uniform(-0.3, 0.3)
        lean, tall = source.uniform(0.25, 0.55), height * source.uniform(0.8, 1.1)
        c, s = math.cos(turn), math.sin(turn)
        path = []
        for i in range(8):
            t = i / 7
            # Stems cross in the neck: they start opposite to where they lean.
            out = -foot * (1 - t) ** 2 + lean * tall * t * t
            path.append((c * out, tall * t, s * out))
        wood.add(tube(path, [0.0022 - 0.0012 * i / 7 for i in range(8)], 5))
        for pair in range(pairs):
            t = 0.52 + 0.48 * pair / (pairs - 1)
            k = min(int(t * 7), 6)
            f = t * 7 - k
            base = [a + (b - a) * f for a, b in zip(path[k], path[k + 1])]
            for sign in (-1, 1):
                around = turn + sign * 1.3 + pair * 1.1
                direction = (math.cos(around), source.uniform(0.1, 0.7), math.sin(around))
                grown = size * source.uniform(0.8, 1.1) * (1.2 - 0.5 * t)
                foliage.add(leaf(base, direction, grown, 0.8 * grown, 0.2, 0.1, 4, 0.9))
    return wood, foliage


def trailing(seed=8, leaves=46, reach=0.16, hang=0.22):
    """Leaves over the rim of a small pot that stands below y = 0: (stems, leaves)."""
    source = random.Random(seed)
    wood, foliage = Shape(), Shape()
    for number in range(leaves):
        turn = 2.4 * number
        out = reach * source.uniform(0.45, 1.0)
        front = max(0.0, math.sin(turn))
        drop = hang * front * source.uniform(0.0, 1.0)
        c, s = math.cos(turn), math.sin(turn)
        tip = (c * out, 0.10 * source.uniform(0.3, 1.0) * (1 - front) - drop + 0.02, s * out)
        bend = (c * out * 0.62, 0.05, s * out * 0.62)
        wood.add(tube([(c * 0.02, -0.02, s * 0.02), bend, tip], 0.0012, 4))
        grown = 0.058 * source.uniform(0.7, 1.1)
        foliage.add(leaf(tip, (c, 0.15 - 0.7 * front, s), grown, 0.75 * grown, 0.3, 0.15, 4, 0.75))
    return wood, foliage


def pot(radius=0.17, height=0.30, thick=0.012, earth=0.03):
    """A pot with earth in it: (pot, earth)."""
    outside = [(0.0, 0.0), (radius * 0.72, 0.0), (radius * 0.76, 0.01), (radius, height - 0.02),
               (radius * 1.03, height - 0.012), (radius * 1.03, height)]
    inside = [(radius * 1.03 - thick, height), (radius - thick, height - 0.02), (radius * 0.9 - thick, height * 0.6),
              (0.0, height * 0.6)]
    within = radius * (0.76 + 0.24 * (height - earth) / height) - thick - 0.004
    soil = lathe([(0.0, height * 0.6 + 0.002), (within * 0.8, height * 0.6 + 0.002), (within, height - earth - 0.01),
                  (within * 0.8, height - earth), (0.0, height - earth + 0.006)], 24)
    return lathe(outside + inside, 40), soil
