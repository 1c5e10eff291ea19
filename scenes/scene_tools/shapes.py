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
