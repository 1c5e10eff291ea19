"""Soft things: cushions, pillows, curtains, a blanket. All are closed."""

import math
import random

from scene_tools.shapes import Shape, grid, rounded_box, smoothed


def cushion(size, bottom_centre=(0.0, 0.0, 0.0), radius=0.05, swell=0.03, axis=1, steps=5, seed=0):
    """A filled cushion whose two large sides, at right angles to an axis, swell outwards."""
    half = [s / 2 for s in size]
    i, j = [k for k in range(3) if k != axis]
    phases = [random.Random(seed * 7 + k).uniform(0, 6.28) for k in range(4)]

    def warp(point):
        p = list(point)
        u, v = p[i] / half[i], p[j] / half[j]
        full = max(0.0, 1 - u * u) * max(0.0, 1 - v * v)
        dents = 0.12 * (math.sin(5 * u + phases[0]) * math.sin(4 * v + phases[1]))
        p[axis] += p[axis] / half[axis] * swell * full * (1 + dents)
        # The sides are drawn in between the corners, and out by the filling.
        t = p[axis] / half[axis]
        p[i] += 0.15 * swell * u * (1 - v * v) * (1 - t * t)
        p[j] += 0.15 * swell * v * (1 - u * u) * (1 - t * t)
        return tuple(p)

    counts = [steps if k != axis else 1 for k in range(3)]
    return rounded_box(size, bottom_centre, radius, counts, 2, warp)


def pillow(side=0.44, thick=0.17, seed=0, steps=10):
    """A throw pillow around the origin that faces +z: thin at its seam, its corners drawn out."""
    source = random.Random(seed)
    waves = [(source.uniform(2, 5), source.uniform(2, 5), source.uniform(0, 6.28)) for _ in range(3)]
    skins = []
    for sign in (1, -1):
        rows = []
        for r in range(steps + 1):
            v = math.sin(math.pi / 2 * (2 * r / steps - 1))
            row = []
            for c in range(steps + 1):
                u = math.sin(math.pi / 2 * (2 * c / steps - 1))
                x = u * side / 2 * (1 - 0.07 * (1 - v * v))
                y = v * side / 2 * (1 - 0.07 * (1 - u * u))
                full = max(0.0, (1 - u * u) * (1 - v * v)) ** 0.42
                dents = sum(0.035 * math.sin(a * u + b * v + p) for a, b, p in waves)
                on_seam = r in (0, steps) or c in (0, steps)
                row.append((x, y, 0.0 if on_seam else sign * thick / 2 * full * (1 + dents)))
            rows.append(row if sign > 0 else row[::-1])
        skins.append(smoothed(grid(rows, 2.0), 70))
    return skins[0].add(skins[1])


def curtain(width, height, folds=6, depth=0.035, thick=0.004, seed=0, across=10, down=6):
    """Cloth in folds that hangs from y = height to y = 0, along x around the origin."""
    source = random.Random(seed)
    phase, second = source.uniform(0, 6.28), source.uniform(0, 6.28)
    columns = folds * across
    front, back = [], []
    for r in range(down + 1):
        t = r / down  # 0 at the hem, 1 at the rod
        loose = 1.0 - 0.55 * t ** 1.5
        centre = []
        for c in range(columns + 1):
            s = c / columns
            turn = 2 * math.pi * folds * s + phase + 0.5 * math.sin(2 * math.pi * s + second) * (1 - t)
            swell = 1 + 0.3 * math.sin(2 * math.pi * 1.7 * s + second)
            z = depth * loose * swell * (math.sin(turn) + 0.18 * math.sin(2 * turn + second))
            x = (s - 0.5) * width * (1 + 0.05 * (1 - t)) + 0.2 * width / folds * loose * 0.35 * math.sin(2 * turn)
            centre.append((x, z))
        rows = ([], [])
        for c, (x, z) in enumerate(centre):
            before, after = centre[max(c - 1, 0)], centre[min(c + 1, columns)]
            dx, dz = after[0] - before[0], after[1] - before[1]
            length = math.hypot(dx, dz)
            nx, nz = -dz / length, dx / length
            for row, sign in zip(rows, (0.5, -0.5)):
                row.append((x + sign * thick * nx, height * t, z + sign * thick * nz))
        front.append(rows[0])
        back.append(rows[1])
    loops = [f + b[::-1] for f, b in zip(front, back)]
    shape = smoothed(grid(loops, closed=True), 60)
    shape.add(smoothed(grid([back[0], front[0]]), 60)).add(smoothed(grid([front[-1], back[-1]]), 60))
    for n, p in enumerate(shape.positions):
        shape.uvs[n] = (p[0] * 3.0, p[1] * 3.0)
    return shape


def blanket(width, outline, thick=0.012, across=10, seed=5):
    """Cloth of some width along x, laid over an outline of (z, y): its lower side lies on the outline."""
    source = random.Random(seed)
    waves = [source.uniform(0, 6.28) for _ in range(3)]
    lower, upper = [], []
    for k, (z, y) in enumerate(outline):
        before, after = outline[max(k - 1, 0)], outline[min(k + 1, len(outline) - 1)]
        dz, dy = after[0] - before[0], after[1] - before[1]
        length = math.hypot(dz, dy)
        nz, ny = -dy / length, dz / length
        rows = ([], [])
        for c in range(across + 1):
            u = c / across - 0.5
            lift = 0.004 * (1 + math.sin(9 * u + waves[0] + 0.6 * k)) + 0.003 * (1 + math.sin(15 * u + waves[1]))
            x = u * width * (1 + 0.03 * math.sin(0.7 * k + waves[2]))
            for row, out in zip(rows, (lift * 0.3, thick + lift)):
                row.append((x, y + ny * out, z + nz * out))
        lower.append(rows[0])
        upper.append(rows[1])
    # Seen along +z the outline runs to the right; its outside is above.
    loops = [u + l[::-1] for u, l in zip(upper, lower)]
    shape = smoothed(grid([row[::-1] for row in loops], closed=True), 75)
    shape.add(smoothed(grid([upper[0], lower[0]]), 60))
    shape.add(smoothed(grid([lower[-1], upper[-1]]), 60))
    for n, p in enumerate(shape.positions):
        shape.uvs[n] = (p[0] * 4.0, (p[1] + p[2]) * 4.0)
    return shape
