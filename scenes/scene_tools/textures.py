"""Procedural pictures for the rooms, as rows of sRGB code values; normal maps are rows of plain ones."""

import math
import random

from scene_tools.colour import srgb_from_linear

_CODES = [srgb_from_linear(i / 1023) for i in range(1024)]


def _encoded(rgb):
    return tuple(_CODES[min(1023, max(0, int(c * 1023 + 0.5)))] for c in rgb)


def _noise(seed, columns, rows):
    """Smooth noise in [-1, 1] over the plane, which repeats after so many columns and rows."""
    source = random.Random(seed)
    table = [[source.uniform(-1, 1) for _ in range(columns)] for _ in range(rows)]

    def at(x, y):
        i, j = math.floor(x), math.floor(y)
        u, v = x - i, y - j
        u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
        upper, lower = table[j % rows], table[(j + 1) % rows]
        i0, i1 = i % columns, (i + 1) % columns
        first = upper[i0] + (upper[i1] - upper[i0]) * u
        return first + (lower[i0] + (lower[i1] - lower[i0]) * u - first) * v

    return at


def _layered(seed, columns, rows, octaves, falloff=0.5):
    """Octaves of noise, each twice as fine as the one before; about [-1, 1]."""
    layers = [_noise(seed + k, columns << k, rows << k) for k in range(octaves)]
    weights = [falloff ** k for k in range(octaves)]
    whole = sum(weights)

    def at(x, y):
        return sum(w * layer(x * (1 << k), y * (1 << k))
                   for k, (layer, w) in enumerate(zip(layers, weights))) / whole

    return at


def _normals(heights, strength):
    """The normal map of rows of heights, which repeat; `strength` is of a height of 1 over a texel."""
    rows, columns = len(heights), len(heights[0])
    picture = []
    for y in range(rows):
        above, here, below = heights[y - 1], heights[y], heights[(y + 1) % rows]
        row = []
        for x in range(columns):
            dx = (here[(x + 1) % columns] - here[x - 1]) * 0.5 * strength
            dy = (above[x] - below[x]) * 0.5 * strength  # green points up
            length = math.sqrt(1 + dx * dx + dy * dy)
            row.append((int(127.5 - 127.5 * dx / length + 0.5), int(127.5 - 127.5 * dy / length + 0.5),
                        int(127.5 + 127.5 / length + 0.5)))
        picture.append(row)
    return picture


# Wood

HERRINGBONE_BLOCKS = 24  # widths of a block that the picture of the floor shows


def _herringbone(size, length=6):
    """For each texel of a herringbone floor: (block, along, across), the last two in texels from its borders."""
    cell = size // HERRINGBONE_BLOCKS
    period = 2 * length
    rows = []
    for y in range(size):
        j, fy = divmod(y, cell)
        row = []
        for x in range(size):
            i, fx = divmod(x, cell)
            k = (i - j) % period
            if k < length:  # lies along x
                row.append((((i - k) % HERRINGBONE_BLOCKS, j, 0), k * cell + fx, fy))
            else:
                up = period - 1 - k
                row.append(((i, (j - up) % HERRINGBONE_BLOCKS, 1), up * cell + fy, fx))
        rows.append(row)
    return rows, cell, length * cell


def _blocks(seed=1):
    source = random.Random(seed)
    known = {}

    def of(block):
        if block not in known:
            known[block] = (source.uniform(0.82, 1.12), source.uniform(0, 100), source.uniform(-1, 1),
                            source.uniform(-1, 1))
        return known[block]

    return of


def floor(size=768):
    """Oak blocks in herringbone; repeats in both directions. Albedo about 0.3."""
    cells, cell, length = _herringbone(size)
    grain, bands, of = _layered(11, 64, 64, 2), _layered(21, 32, 32, 2), _blocks()
    rows = []
    for line in cells:
        row = []
        for block, along, across in line:
            tone, offset, hue, _ = of(block)
            fibre = grain(offset + along * 0.045, across * 0.9 + offset * 3)
            band = bands(offset + along * 0.02, across * 0.16 + offset)
            shade = tone * (1 + 0.13 * fibre + 0.17 * band)
            if min(along, across) < 1:
                shade *= 0.5  # the joints
            row.append(_encoded((0.40 * shade, (0.262 + 0.012 * hue) * shade, (0.145 + 0.014 * hue) * shade)))
        rows.append(row)
    return rows


def floor_normals(size=768):
    """Blocks with bevelled edges, each tilted by a hair as blocks of real floors are, and fibres."""
    cells, cell, length = _herringbone(size)
    fibres, of = _noise(31, 96, 96), _blocks()
    rows = []
    for line in cells:
        row = []
        for block, along, across in line:
            _, offset, tilt, other = of(block)
            a, b = 0.010 * tilt, 0.012 * other + 0.02 * fibres(offset + along * 0.05, across * 0.8)
            a += 0.22 * ((along < 2) - (along >= length - 2))
            b += 0.22 * ((across < 2) - (across >= cell - 2))
            u, v = (b, a) if block[2] else (a, b)
            row.append((int(127.5 - 127.5 * u + 0.5), int(127.5 + 127.5 * v + 0.5), 254))
        rows.append(row)
    return rows


def wood(colour, seed, size=256, contrast=1.0):
    """Grain along u; repeats in both directions."""
    fibres, bands, warp = _layered(seed, 6, 96, 2), _layered(seed + 10, 3, 12, 3), _layered(seed + 20, 2, 4, 2)
    rows = []
    for y in range(size):
        v, row = y / size, []
        for x in range(size):
            u = x / size
            bend = 0.6 * warp(u * 2, v * 4)
            ring = 0.5 + 0.5 * math.sin(2 * math.pi * (6 * v + bend + 0.35 * bands(u * 3, v * 12)))
            shade = 1 + contrast * (0.10 * fibres(u * 6, v * 96) + 0.16 * bands(u * 3, v * 12)
                                    - 0.16 * ring ** 4)
            row.append(_encoded([c * shade for c in colour]))
        rows.append(row)
    return rows


# Cloth

def weave_normals(size=128, threads=16):
    """A plain weave: threads over and under each other."""
    heights = []
    for y in range(size):
        row = []
        for x in range(size):
            u, v = x * threads / size, y * threads / size
            over = (int(u) + int(v)) % 2
            across = math.sin(math.pi * (u % 1)) if over else math.sin(math.pi * (v % 1))
            along = math.sin(math.pi * (v % 1)) if over else math.sin(math.pi * (u % 1))
            row.append(across ** 0.7 * (0.75 + 0.25 * along))
        heights.append(row)
    return _normals(heights, 0.9)


def boucle_normals(size=192, seed=41):
    """Loops of a coarse wool."""
    noise, fine = _noise(seed, 36, 36), _noise(seed + 1, 72, 72)
    heights = [[1 - abs(noise(x * 36 / size, y * 36 / size)) + 0.35 * fine(x * 72 / size, y * 72 / size)
                for x in range(size)] for y in range(size)]
    return _normals(heights, 1.1)


def rug(width=320, height=448, seed=6):
    """A hand-knotted rug: a field of lozenges that pales towards worn places, and a border."""
    cream, ink, rust = (0.56, 0.50, 0.40), (0.055, 0.075, 0.10), (0.36, 0.13, 0.06)
    worn, knots = _layered(seed, 5, 7, 4), random.Random(seed)
    rows = []
    for y in range(height):
        row = []
        for x in range(width):
            edge = min(x, y, width - 1 - x, height - 1 - y)
            dx, dy = abs((x - width / 2 + 32) % 64 - 32), abs((y - height / 2 + 32) % 64 - 32)
            lozenge = dx + dy
            if edge < 6 or 26 <= edge < 29:
                rgb = ink
            elif edge < 26:
                step = abs((x + y) % 16 - 8) + abs((x - y) % 16 - 8)
                rgb = rust if step < 6 or edge < 9 or edge >= 23 else cream
            elif lozenge < 5 or 19 <= lozenge < 22:
                rgb = rust
            elif 28 <= lozenge < 31:
                rgb = ink
            else:
                rgb = cream
            age = 0.5 + 0.5 * worn(x * 5 / width, y * 7 / height)
            fade = 0.30 * age * age
            knot = knots.uniform(0.90, 1.06) * (0.92 + 0.12 * age)
            row.append(_encoded([(c + (p - c) * fade) * knot for c, p in zip(rgb, cream)]))
        rows.append(row)
    return rows


def carpet(size=256, tiles=2, seed=7):
    """Square tiles of loop pile, every other one turned; repeats in both directions. Its mean albedo is 0.4."""
    loops, stripes = random.Random(seed), _noise(seed, 48, 48)
    tones = [random.Random(seed + k).uniform(-0.02, 0.02) for k in range(tiles * tiles)]
    one = size // tiles
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            i, j = x // one, y // one
            u, v = (x, y) if (i + j) % 2 else (y, x)
            level = 0.40 * (1 + tones[i + tiles * j] + 0.10 * stripes(u * 48 / size, v * 6 / size)
                            + loops.uniform(-0.24, 0.24))
            row.append(_encoded((level * 0.95, level, level * 1.06)))
        rows.append(row)
    return rows


# Pictures

def landscape(width=288, height=192):
    """A painting: a lake between hills at dusk, in broad strokes."""
    air, brush, ridge = _layered(51, 4, 6, 4), _layered(52, 12, 60, 2), _layered(53, 6, 1, 5)
    hills = ((0.44, 0.13, (0.30, 0.30, 0.36)), (0.52, 0.11, (0.17, 0.20, 0.24)), (0.585, 0.07, (0.065, 0.085, 0.08)))
    rows = []
    for y in range(height):
        v, row = y / height, []
        for x in range(width):
            u = x / width
            stroke = brush(u * 12, v * 60)
            level = v if v < 0.63 else 1.26 - v + 0.012 * brush(u * 5, v * 60)  # the lake mirrors
            glow = math.exp(-((level - 0.50) / 0.20) ** 2 - ((u - 0.63) / 0.5) ** 2)
            cloud = max(0.0, air(u * 4, level * 9))
            rgb = [0.20 + 0.46 * glow + 0.20 * cloud, 0.27 + 0.19 * glow + 0.12 * cloud,
                   0.36 - 0.14 * glow + 0.10 * cloud]
            for k, (height_of, swing, tone) in enumerate(hills):
                if level > height_of - swing * ridge(u * 2.0 + 1.7 * k, 0.5 + k):
                    rgb = list(tone)
            if v > 0.63:
                rgb = [c * 0.78 + d for c, d in zip(rgb, (0.01, 0.015, 0.02))]
            if v > 0.86 + 0.05 * ridge(u * 3, 0.2):
                rgb = [0.10, 0.085, 0.035] if stroke > 0 else [0.055, 0.06, 0.03]
            row.append(_encoded([min(0.8, c * (1 + 0.16 * stroke)) for c in rgb]))
        rows.append(row)
    return rows


def squares(width=144, height=192, seed=5):
    """A painting: fields of colour on a pale ground, with soft borders and a grain."""
    source, grain = random.Random(seed), _layered(61, 18, 24, 3)
    palette = ((0.52, 0.13, 0.06), (0.60, 0.36, 0.09), (0.07, 0.13, 0.20), (0.16, 0.24, 0.18),
               (0.62, 0.55, 0.44), (0.60, 0.55, 0.44))
    fields = [[source.choice(palette) for _ in range(3)] for _ in range(4)]
    rows = []
    for y in range(height):
        row = []
        for x in range(width):
            edge = 1.4 * grain(x / 8, y / 8)
            inside = 10 < x < width - 10 and 10 < y < height - 10
            px, py = (x - 10 + edge) % 41.4, (y - 10 + edge) % 43
            rgb = (0.66, 0.62, 0.54)
            if inside and 2 < px < 39 and 2 < py < 41:
                rgb = fields[min(3, int((y - 10) / 43))][min(2, int((x - 10) / 41.4))]
            shade = 1 + 0.14 * grain(x / 5 + 7, y / 3)
            row.append(_encoded([min(0.8, c * shade) for c in rgb]))
        rows.append(row)
    return rows


def botanical(width=144, height=192):
    """A print: a fern on cream paper."""
    paper, green = (0.66, 0.62, 0.52), (0.06, 0.11, 0.06)
    picture = [[paper] * width for _ in range(height)]

    def dab(x, y, radius, rgb):
        for j in range(int(y - radius), int(y + radius) + 2):
            for i in range(int(x - radius), int(x + radius) + 2):
                if 0 <= i < width and 0 <= j < height and math.hypot(i - x, j - y) <= radius:
                    picture[j][i] = rgb

    for k in range(120):
        t = k / 119
        x, y = width * (0.46 + 0.10 * math.sin(2.2 * t)), height * (0.90 - 0.76 * t)
        dab(x, y, 1.1, green)
        if k % 7 or t < 0.12:
            continue
        reach = 50 * math.sin(math.pi * min(1.0, (1 - t) * 0.9 + 0.03)) ** 0.8
        for sign in (-1, 1):
            for m in range(int(reach * 2)):
                s = m / (reach * 2)
                px, py = x + sign * reach * s, y - 22 * s + 12 * s * s
                dab(px, py, 0.6 + 2.4 * (1 - s) * (0.5 + 0.5 * math.sin(m * 1.1)) ** 2, green)
    return [[_encoded(rgb) for rgb in row] for row in picture]


BOOK_SPINES = 32


def book_spines(width=512, height=128, seed=9):
    """Spines beside each other, each with bands and a title; the last sixteenth of the height is cover alone."""
    source = random.Random(seed)
    palette = ((0.36, 0.06, 0.04), (0.05, 0.09, 0.18), (0.40, 0.28, 0.12), (0.05, 0.13, 0.09), (0.52, 0.47, 0.38),
               (0.10, 0.09, 0.09), (0.45, 0.16, 0.05), (0.16, 0.20, 0.24), (0.30, 0.09, 0.12), (0.58, 0.55, 0.48))
    one = width // BOOK_SPINES
    rows = [[None] * width for _ in range(height)]
    for number in range(BOOK_SPINES):
        cover = palette[number % len(palette)]
        cover = tuple(min(0.7, c * source.uniform(0.8, 1.2)) for c in cover)
        dark = sum(cover) < 0.9
        ink = (0.50, 0.36, 0.14) if dark and source.random() < 0.6 else (0.6, 0.57, 0.5) if dark else (0.09, 0.06, 0.05)
        bands = [source.randrange(6, 14), source.randrange(88, 108)]
        first, last = 22 + source.randrange(8), 60 + source.randrange(22)
        letters = [source.random() < 0.72 for _ in range(height)]
        for y in range(height):
            for x in range(one):
                rgb = cover
                if y < height * 15 // 16:
                    if any(b <= y < b + 2 for b in bands):
                        rgb = ink
                    elif first <= y < last and one * 0.3 < x < one * 0.7 and letters[y // 2 * 2]:
                        rgb = ink
                round_off = 0.45 if x == 0 else 0.8 if x in (1, one - 1) else 1.0
                rows[y][number * one + x] = _encoded([c * round_off for c in rgb])
    return rows


# Light

def lamp_glow(width=2, height=16):
    """What parts of the floor lamp emit beside its discs: the upper rows are the discs, the others its side from the
    top down, brightest at the height of the bulb and redder away from it."""
    rows = []
    for y in range(height):
        t = (y - 4.8) / 10.4  # along the side
        near = math.exp(-((t - 0.55) / 0.42) ** 2)
        level = 0.035 + 0.085 * near
        side = (level, level * (0.88 + 0.10 * near), level * (0.70 + 0.22 * near))
        rows.append([_encoded((1.0, 1.0, 1.0) if y < 3 else side)] * width)
    return rows


def garden(scale=1.0, seed=71):
    """What two windows show: lawn, borders, trees and hills below an evening sky, as radiance relative to white.

    It is a plane behind the garden; far things are painted before near ones, on a canvas of 640 x 224 that is
    `scale` as large while it is painted, and half as large as that in the end.
    """
    width, height = int(640 * scale), int(224 * scale)
    source = random.Random(seed)
    clouds, far, leaves = _layered(seed, 8, 6, 5), _layered(seed + 1, 12, 1, 5), _layered(seed + 2, 64, 22, 3)
    horizon = 0.70  # of the height, from the top
    picture = []
    for y in range(height):
        v, row = y / height, []
        for x in range(width):
            u = x / width
            t = max(0.0, 1 - v / horizon)  # 0 at the horizon, 1 at the top
            warm = math.exp(-((u - 0.30) / 0.45) ** 2) * math.exp(-t * 2.4)
            rgb = [0.30 + 0.62 * warm - 0.08 * t, 0.42 + 0.30 * warm - 0.06 * t, 0.66 - 0.06 * warm - 0.02 * t]
            cloud = max(0.0, clouds(u * 8, v * 9) - 0.02) * 1.5
            lit = min(1.0, cloud) * (0.4 + 0.6 * t)
            rgb = [c + (d - c) * lit for c, d in zip(rgb, (0.98, 0.80 + 0.05 * t, 0.74 + 0.10 * t))]
            for k, (level, swing, tone) in enumerate(((0.60, 0.10, (0.27, 0.34, 0.42)), (0.65, 0.07, (0.15, 0.22, 0.22)))):
                if v > level - swing * far(u * 6 + 3 * k, 0.5 + k):
                    rgb = list(tone)
            if v > horizon:
                depth = (v - horizon) / (1 - horizon)
                stripe = 0.5 + 0.5 * math.sin(40 * u / (0.25 + depth))
                shade = 0.7 + 0.5 * depth + 0.10 * stripe + 0.22 * leaves(u * 64, v * 44)
                rgb = [0.085 * shade, 0.150 * shade, 0.030 * shade]
            row.append(rgb)
        picture.append(row)

    def dab(x, y, radius, rgb):
        x, y, radius = x * scale, y * scale, radius * scale
        for j in range(max(0, int(y - radius)), min(height, int(y + radius) + 2)):
            reach = radius * radius - (j - y) ** 2
            if reach < 0:
                continue
            reach = math.sqrt(reach)
            for i in range(max(0, int(x - reach)), min(width, int(x + reach) + 1)):
                picture[j][i] = rgb

    def crown(x, y, wide, high, tone, dabs, size):
        """Dabs of leaves, darker below and to the right, where the evening sun does not reach."""
        for _ in range(dabs):
            a, r = source.uniform(0, 2 * math.pi), math.sqrt(source.random())
            px, py = math.cos(a) * r, math.sin(a) * r
            light = max(0.25, 0.75 - 0.40 * py - 0.32 * px + source.uniform(-0.22, 0.22))
            dab(x + px * wide, y + py * high, size * source.uniform(0.6, 1.3), [c * light for c in tone])

    def trunk(x, foot, top, wide, tone):
        x, foot, top, wide = x * scale, foot * scale, top * scale, wide * scale
        for y in range(int(top), int(foot)):
            for i in range(int(x - wide), int(x + wide) + 1):
                if 0 <= i < width and 0 <= y < height:
                    picture[y][i] = [c * (1.2 if i < x else 0.7) for c in tone]

    ground = horizon * 224
    for _ in range(26):  # the far edge of the garden
        x = source.uniform(0, 640)
        tall = source.uniform(14, 34)
        crown(x, ground - tall * 0.5, tall * 0.7, tall * 0.6, (0.07, 0.13, 0.055), 130, 2.2)
    for x, tall, wide in ((70, 140, 62), (232, 104, 44), (395, 150, 66), (548, 120, 52)):
        trunk(x, ground + 9, ground - tall * 0.6, 3.0, (0.10, 0.07, 0.05))
        middle = ground - tall * 0.66
        crown(x, middle, wide * 0.92, tall * 0.34, (0.07, 0.12, 0.04), 900, 2.4)  # what is seen between the boughs
        for number in range(16):
            turn, out = 2.4 * number, math.sqrt((number + 0.5) / 16)
            crown(x + wide * 0.82 * out * math.cos(turn), middle + tall * 0.32 * out * math.sin(turn), wide * 0.34,
                  tall * 0.12, (0.15 - 0.02 * out, 0.23 - 0.02 * out, 0.06), 170, 1.7)
    x = -10.0
    while x < 650:  # the border of flowers
        tall = source.uniform(9, 20)
        crown(x, ground + 14 - tall * 0.4, tall * 0.8, tall * 0.6, (0.10, 0.19, 0.05), 120, 1.8)
        petal = source.choice(((0.55, 0.16, 0.22), (0.62, 0.50, 0.16), (0.60, 0.52, 0.58), (0.35, 0.18, 0.45)))
        for _ in range(22):
            dab(x + source.uniform(-0.8, 0.8) * tall, ground + 14 - tall * source.uniform(0.1, 0.95), 1.0, petal)
        x += tall * 0.9
    return [[_encoded([0.25 * sum(four) for four in zip(*(picture[y + j][x + i] for i in (0, 1) for j in (0, 1)))])
             for x in range(0, width, 2)] for y in range(0, height, 2)]
