"""Triangle meshes: quads, boxes, solids of revolution. Metres, y up, wound outwards."""

import math


def _subtract(a, b):
    return tuple(p - q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalised(v):
    length = math.sqrt(sum(c * c for c in v))
    return tuple(c / length for c in v)


class Shape:
    """Triangles with a normal and a texture coordinate per vertex."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.triangles = [], [], [], []

    def vertex(self, position, normal, uv=(0.0, 0.0)):
        self.positions.append(tuple(position))
        self.normals.append(tuple(normal))
        self.uvs.append(tuple(uv))
        return len(self.positions) - 1

    def polygon(self, corners, uvs=None):
        """A flat convex polygon, counter-clockwise seen from its front."""
        normal = normalised(cross(_subtract(corners[1], corners[0]),
                                  _subtract(corners[2], corners[0])))
        uvs = uvs or [(0.0, 0.0)] * len(corners)
        first = len(self.positions)
        for corner, uv in zip(corners, uvs):
            self.vertex(corner, normal, uv)
        for i in range(1, len(corners) - 1):
            self.triangles.append((first, first + i, first + i + 1))
        return self

    def add(self, other):
        first = len(self.positions)
        self.positions += other.positions
        self.normals += other.normals
        self.uvs += other.uvs
        self.triangles += [tuple(first + i for i in t) for t in other.triangles]
        return self

    def moved(self, x, y, z):
        return self._mapped(lambda p: (p[0] + x, p[1] + y, p[2] + z), lambda n: n)

    def turned(self, axis, degrees):
        """Turned counter-clockwise about the axis 'x', 'y' or 'z' through the origin."""
        i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

        def turn(p):
            q = list(p)
            q[i], q[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
            return tuple(q)

        return self._mapped(turn, turn)

    def _mapped(self, of_position, of_normal):
        result = Shape()
        result.positions = [of_position(p) for p in self.positions]
        result.normals = [of_normal(n) for n in self.normals]
        result.uvs, result.triangles = list(self.uvs), list(self.triangles)
        return result

    def area(self):
        """Square metres."""
        total = 0.0
        for a, b, c in self.triangles:
            p, q, r = self.positions[a], self.positions[b], self.positions[c]
            n = cross(_subtract(q, p), _subtract(r, p))
            total += 0.5 * math.sqrt(sum(x * x for x in n))
        return total


def rectangle(corner, u, v, holes=(), uv_scale=1.0):
    """The parallelogram corner + a u + b v, seen from the side of u x v, without some holes.

    `holes` are (a0, b0, a1, b1) in [0,1] along u and v. Cut along every hole's sides, so that its
    triangles meet corner to corner. Texture coordinates are metres times `uv_scale`.
    """
    def cuts(first, last):
        return sorted({0.0, 1.0, *(h[first] for h in holes), *(h[last] for h in holes)})

    def point(a, b):
        return tuple(c + a * p + b * q for c, p, q in zip(corner, u, v))

    length_u, length_v = math.hypot(*u) * uv_scale, math.hypot(*v) * uv_scale
    shape = Shape()
    rows, columns = cuts(1, 3), cuts(0, 2)
    for b0, b1 in zip(rows, rows[1:]):
        for a0, a1 in zip(columns, columns[1:]):
            if any(h[0] <= a0 and a1 <= h[2] and h[1] <= b0 and b1 <= h[3] for h in holes):
                continue
            corners = [(a0, b0), (a1, b0), (a1, b1), (a0, b1)]
            shape.polygon([point(a, b) for a, b in corners],
                          [(a * length_u, b * length_v) for a, b in corners])
    return shape


def box(size, bottom_centre=(0.0, 0.0, 0.0), bevel=0.0, without=()):
    """A box standing on `bottom_centre`; its edges cut off by `bevel` metres where that is not 0.

    `without` names faces left out: "+x", "-x", "+y", ... (plain boxes only).
    """
    half = [s / 2 for s in size]
    centre = (bottom_centre[0], bottom_centre[1] + half[1], bottom_centre[2])

    def at(*signed):
        return tuple(c + s for c, s in zip(centre, signed))

    def face_corners(axis, sign):
        """Corners of one face, counter-clockwise from outside, pulled in by the bevel."""
        i, j = (axis + 1) % 3, (axis + 2) % 3
        result = []
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            p = [0.0] * 3
            p[axis] = sign * half[axis]
            p[i], p[j] = a * (half[i] - bevel), b * (half[j] - bevel)
            result.append(at(*p))
        return result if sign > 0 else result[::-1]

    shape = Shape()
    for axis in range(3):
        for sign in (1, -1):
            if ("+" if sign > 0 else "-") + "xyz"[axis] in without:
                continue
            corners = face_corners(axis, sign)
            i, j = [k for k in range(3) if k != axis]
            shape.polygon(corners, [(p[i], p[j]) for p in corners])
    if bevel > 0.0:
        _add_bevels(shape, half, bevel, at)
    return shape


def _add_bevels(shape, half, bevel, at):
    """The 12 edge strips and 8 corner triangles between the faces of a bevelled box."""
    def corner(signs, axis):
        """The face corner near the box corner `signs` that lies on the face of `axis`."""
        return at(*(s * (h if k == axis else h - bevel)
                    for k, (s, h) in enumerate(zip(signs, half))))

    def outwards(corners, signs):
        normal = cross(_subtract(corners[1], corners[0]), _subtract(corners[2], corners[0]))
        facing = sum(n * s for n, s in zip(normal, signs))
        return corners if facing > 0 else corners[::-1]

    both = (-1, 1)
    for along in range(3):
        i, j = (along + 1) % 3, (along + 2) % 3
        for si in both:
            for sj in both:
                low, high = [0] * 3, [0] * 3
                low[along], high[along] = -1, 1
                low[i] = high[i] = si
                low[j] = high[j] = sj
                direction = [0] * 3
                direction[i], direction[j] = si, sj
                shape.polygon(outwards([corner(low, i), corner(high, i), corner(high, j),
                                        corner(low, j)], direction))
    for sx in both:
        for sy in both:
            for sz in both:
                signs = (sx, sy, sz)
                shape.polygon(outwards([corner(signs, axis) for axis in range(3)], signs))


def lathe(profile, segments=24, crease_degrees=40.0):
    """The solid that a profile of (radius, height) sweeps about the y axis.

    The profile runs so that the outside is on its right: upwards along the outside. Radii of 0
    close it. Normals are smooth around, and along the profile where it bends by less than
    `crease_degrees`.
    """
    directions = []  # unit outward normals (radial, height) of the profile's pieces
    for (r0, h0), (r1, h1) in zip(profile, profile[1:]):
        length = math.hypot(r1 - r0, h1 - h0)
        directions.append(((h1 - h0) / length, -(r1 - r0) / length))
    smallest_cosine = math.cos(math.radians(crease_degrees))

    def normal_at(piece, point):
        """Normal of a piece at its end `point`: mixed with the neighbour's unless they crease."""
        other = point - 1 if point == piece else point
        if 0 <= other < len(directions):
            a, b = directions[piece], directions[other]
            if a[0] * b[0] + a[1] * b[1] >= smallest_cosine:
                mixed = (a[0] + b[0], a[1] + b[1])
                length = math.hypot(*mixed)
                return mixed[0] / length, mixed[1] / length
        return directions[piece]

    def ring(shape, point, normal, v):
        radius, height = profile[point]
        indices = []
        for s in range(segments + 1):
            # The last direction is the first again, to the bit: the solid is closed.
            angle = 2 * math.pi * (s % segments) / segments
            c, sn = math.cos(angle), math.sin(angle)
            indices.append(shape.vertex((radius * c, height, -radius * sn),
                                        (normal[0] * c, normal[1], -normal[0] * sn),
                                        (s / segments, v)))
        return indices

    shape = Shape()
    for piece in range(len(profile) - 1):
        low = ring(shape, piece, normal_at(piece, piece), piece / (len(profile) - 1))
        high = ring(shape, piece + 1, normal_at(piece, piece + 1), (piece + 1) / (len(profile) - 1))
        for s in range(segments):
            a, b, c, d = low[s], low[s + 1], high[s + 1], high[s]
            if profile[piece][0] > 0:
                shape.triangles.append((a, b, c) if profile[piece + 1][0] > 0 else (a, b, d))
            if profile[piece + 1][0] > 0:
                shape.triangles.append((a, c, d))
    return shape


def cylinder(radius, height, segments=16):
    return lathe([(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)], segments)


def sphere(radius, segments=24, rings=12):
    """Centred at the origin."""
    profile = [(radius * math.sin(math.pi * i / rings), -radius * math.cos(math.pi * i / rings))
               for i in range(rings + 1)]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    return lathe(profile, segments)


def smoothed(shape, crease_degrees=40.0):
    """The same triangles, with the mean normal of those that meet at a corner and bend by less than a crease."""
    facing, at_corner = [], {}
    for triangle in shape.triangles:
        a, b, c = (shape.positions[i] for i in triangle)
        facing.append(cross(_subtract(b, a), _subtract(c, a)))  # as long as twice its area
        for corner in (a, b, c):
            at_corner.setdefault(corner, []).append(len(facing) - 1)
    limit = math.cos(math.radians(crease_degrees))
    units = [normalised(n) for n in facing]
    result, known = Shape(), {}
    for triangle, own in zip(shape.triangles, units):
        corners = []
        for i in triangle:
            position, total = shape.positions[i], [0.0, 0.0, 0.0]
            for other in at_corner[position]:
                if sum(p * q for p, q in zip(own, units[other])) >= limit:
                    total = [t + c for t, c in zip(total, facing[other])]
            vertex = (position, tuple(round(c, 5) for c in normalised(total)), shape.uvs[i])
            if vertex not in known:
                known[vertex] = result.vertex(*vertex)
            corners.append(known[vertex])
        result.triangles.append(tuple(corners))
    return result


def grained(shape, axis="x", scale=1.0, offset=0.0):
    """The same shape with texture coordinates in metres times `scale` and u along an axis, as wood is cut."""
    along = "xyz".index(axis)
    result = Shape().add(shape)
    for i, (position, normal) in enumerate(zip(shape.positions, shape.normals)):
        facing = max((a for a in range(3) if a != along), key=lambda a: abs(normal[a]))
        across = 3 - along - facing
        result.uvs[i] = (position[along] * scale + offset, position[across] * scale + offset * 0.37)
    return result


def grid(points, uv_scale=1.0, closed=False):
    """Quads between rows of points. Seen from the front, rows run to the right and follow each other upwards.

    `closed` joins the last column to the first. Texture coordinates are columns and rows, from 0 to `uv_scale`.
    """
    shape = Shape()
    rows, columns = len(points) - 1, len(points[0]) - (0 if closed else 1)

    def corner(r, c):
        return points[r][c % len(points[r])], (c / columns * uv_scale, r / rows * uv_scale)

    for r in range(rows):
        for c in range(columns):
            quad = [corner(r, c), corner(r, c + 1), corner(r + 1, c + 1), corner(r + 1, c)]
            for triangle in ((0, 1, 2), (0, 2, 3)):
                three = [quad[i] for i in triangle]
                if len({p for p, _ in three}) < 3:
                    continue  # of a row or column that runs together
                first = len(shape.positions)
                for position, uv in three:
                    shape.vertex(position, (0.0, 1.0, 0.0), uv)
                shape.triangles.append((first, first + 1, first + 2))
    return shape


def rounded_box(size, bottom_centre=(0.0, 0.0, 0.0), radius=0.03, steps=(1, 1, 1), arc=2, warp=None,
                uv_scale=1.0):
    """A box whose edges are arcs of `radius`, in `steps` along each axis between them.

    `warp` moves a point: it gets and returns coordinates from the centre of the box.
    """
    half = [s / 2 for s in size]
    centre = (bottom_centre[0], bottom_centre[1] + half[1], bottom_centre[2])
    ticks = []
    for h, count in zip(half, steps):
        inner = h - radius
        corner = [radius * math.tan(math.pi / 4 * i / arc) for i in range(1, arc + 1)]
        middle = [inner * (2 * i / count - 1) for i in range(count + 1)]
        middle[-1] = inner
        ticks.append([-inner - c for c in reversed(corner)] + middle + [inner + c for c in corner])

    def moved(point):
        base = [max(-(h - radius), min(h - radius, p)) for p, h in zip(point, half)]
        offset = [p - b for p, b in zip(point, base)]
        length = math.sqrt(sum(o * o for o in offset))
        found = tuple(b + o * radius / length for b, o in zip(base, offset))
        found = warp(found) if warp else found
        return tuple(c + f for c, f in zip(centre, found))

    shape = Shape()
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for sign in (1, -1):
            points = []
            for b in ticks[j]:
                row = []
                for a in ticks[i] if sign > 0 else reversed(ticks[i]):
                    p = [0.0] * 3
                    p[axis], p[i], p[j] = sign * ticks[axis][-1], a, b
                    row.append(moved(p))
                points.append(row)
            shape.add(grid(points))
    shape = smoothed(shape, 60)
    for n, (p, normal) in enumerate(zip(shape.positions, shape.normals)):
        facing = max(range(3), key=lambda a: abs(normal[a]))
        a, b = [p[k] for k in range(3) if k != facing]
        shape.uvs[n] = (a * uv_scale, b * uv_scale)
    return shape


def _along(path):
    """Directions at the points of a path, and two more that are carried along it without a turn."""
    tangents = []
    for i in range(len(path)):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        tangents.append(normalised(_subtract(after, before)))
    hint = (0.0, 0.0, 1.0) if abs(tangents[0][2]) < 0.9 else (1.0, 0.0, 0.0)
    frames = []
    for t in tangents:
        side = normalised(cross(hint, t))
        hint = cross(t, side)
        frames.append((side, hint))
    return frames


def tube(path, radius, segments=8):
    """A closed round rod along points; `radius` is one number, or one for each of them."""
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(path)
    rings = []
    for point, r, (side, up) in zip(path, radii, _along(path)):
        ring = []
        for s in range(segments):
            c, sn = math.cos(2 * math.pi * s / segments), math.sin(2 * math.pi * s / segments)
            ring.append(tuple(p + r * (c * a + sn * b) for p, a, b in zip(point, side, up)))
        rings.append(ring)
    rings = [[tuple(path[0])] * segments, *rings, [tuple(path[-1])] * segments]
    return smoothed(grid(rings, closed=True), 50)


def moulding(profile, path, up=(0.0, 1.0, 0.0), closed=True):
    """A bar of constant section along a path of right angles, mitred at its corners.

    The profile is a polygon of (to the left of the path, along `up`), counter-clockwise, that can be seen whole from
    its first point. The path lies at right angles to `up`.
    """
    def left(a, b):
        return normalised(cross(up, _subtract(b, a)))

    count = len(path)
    sections = []
    for i, point in enumerate(path):
        sides = []
        if closed or i > 0:
            sides.append(left(path[i - 1], point))
        if closed or i < count - 1:
            sides.append(left(point, path[(i + 1) % count]))
        mitre = [sum(c) for c in zip(*sides)] if sides[0] != sides[-1] else sides[0]
        sections.append([tuple(p + a * m + b * u for p, m, u in zip(point, mitre, up)) for a, b in profile])
    if closed:
        sections.append(sections[0])
    # Rows run around the profile, so that columns are steps of the path.
    around = [[section[k % len(profile)] for section in sections] for k in range(len(profile) + 1)]
    shape = grid([list(reversed(row)) for row in around])
    if not closed:
        shape.polygon(sections[0][:1] + sections[0][:0:-1]).polygon(sections[-1])
    return smoothed(shape, 35)
