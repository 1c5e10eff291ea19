// Vectors, matrices of columns as WebGL has them, and the surfaces that walking and pointing meet.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]];
const normalized = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const luminanceOf = (c) => 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];

function product(a, b) {
  const result = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let i = 0; i < 4; ++i) {
        result[4 * column + row] += a[4 * i + row] * b[4 * column + i];
      }
    }
  }
  return result;
}

/// Of a camera with unit axes: `back` points away from where it looks.
function viewMatrix(eye, right, up, back) {
  return new Float32Array([right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2],
                           up[2], back[2], 0, -dot(right, eye), -dot(up, eye), -dot(back, eye),
                           1]);
}

function perspective(verticalAngle, aspect, near, far) {
  const f = 1 / Math.tan(verticalAngle / 2);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (near + far) / (near - far), -1,
                           0, 0, (2 * near * far) / (near - far), 0]);
}

/// Triangles by the cells of a grid on the ground that their boxes meet.
class Surfaces {
  ///   positions   three numbers a vertex
  ///   indices     three a triangle
  constructor(positions, indices) {
    this.positions = positions;
    this.indices = indices;
    this.low = [Infinity, Infinity, Infinity];
    this.high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < positions.length; ++i) {
      this.low[i % 3] = Math.min(this.low[i % 3], positions[i]);
      this.high[i % 3] = Math.max(this.high[i % 3], positions[i]);
    }
    const size = [this.high[0] - this.low[0], this.high[2] - this.low[2]];
    this.cell = Math.max(0.25, Math.max(...size) / 128);
    this.columns = Math.floor(size[0] / this.cell) + 1;
    this.rows = Math.floor(size[1] / this.cell) + 1;
    const counts = new Uint32Array(this.columns * this.rows + 1);
    const eachCell = (visit) => {
      for (let t = 0; t < indices.length / 3; ++t) {
        const corners = this.corners(t);
        const xs = corners.map((c) => c[0]), zs = corners.map((c) => c[2]);
        const [left, top] = this.cellAt(Math.min(...xs), Math.min(...zs));
        const [right, bottom] = this.cellAt(Math.max(...xs), Math.max(...zs));
        for (let row = top; row <= bottom; ++row) {
          for (let column = left; column <= right; ++column) visit(row * this.columns + column, t);
        }
      }
    };
    eachCell((cell) => ++counts[cell + 1]);
    for (let i = 1; i < counts.length; ++i) counts[i] += counts[i - 1];
    this.first = counts;
    this.members = new Uint32Array(counts[counts.length - 1]);
    const next = counts.slice();
    eachCell((cell, t) => { this.members[next[cell]++] = t; });
  }

  corner(triangle, i) {
    const at = 3 * this.indices[3 * triangle + i];
    return [this.positions[at], this.positions[at + 1], this.positions[at + 2]];
  }
  corners(triangle) { return [0, 1, 2].map((i) => this.corner(triangle, i)); }

  cellAt(x, z) {
    return [clamp(Math.floor((x - this.low[0]) / this.cell), 0, this.columns - 1),
            clamp(Math.floor((z - this.low[2]) / this.cell), 0, this.rows - 1)];
  }

  /// Calls visit(triangle) for those whose cells meet a rectangle of the ground; some come twice.
  around(x, z, reach, visit) {
    const [left, top] = this.cellAt(x - reach, z - reach);
    const [right, bottom] = this.cellAt(x + reach, z + reach);
    for (let row = top; row <= bottom; ++row) {
      for (let column = left; column <= right; ++column) {
        const cell = row * this.columns + column;
        for (let i = this.first[cell]; i < this.first[cell + 1]; ++i) visit(this.members[i]);
      }
    }
  }

  /// The nearest triangle that a ray meets: {triangle, distance, u, v}; null where there is none.
  ///   accepts(triangle, facing)   whether it counts; facing is below 0 where its front is seen
  meet(origin, direction, accepts = () => true) {
    let nearest = null;
    const test = (t) => {
      const a = this.corner(t, 0);
      const ab = subtract(this.corner(t, 1), a), ac = subtract(this.corner(t, 2), a);
      const p = cross(direction, ac);
      const determinant = dot(ab, p);
      if (Math.abs(determinant) < 1e-14) return;
      const offset = subtract(origin, a);
      const u = dot(offset, p) / determinant;
      if (u < 0 || u > 1) return;
      const q = cross(offset, ab);
      const v = dot(direction, q) / determinant;
      if (v < 0 || u + v > 1) return;
      const distance = dot(ac, q) / determinant;
      if (distance < 1e-4 || (nearest && distance >= nearest.distance)) return;
      if (accepts(t, -determinant)) nearest = {triangle: t, distance, u, v};
    };
    // Cells along the ray's shadow on the ground, half a cell a step.
    const flat = Math.hypot(direction[0], direction[2]);
    if (flat < 1e-6) {
      this.around(origin[0], origin[2], 0, test);
      return nearest;
    }
    const far = Math.hypot(...subtract(this.high, this.low)) +
                Math.hypot(...subtract(origin, scaled(add(this.low, this.high), 0.5)));
    const step = this.cell / (2 * flat);
    let before = -1;
    for (let along = 0; along < far + step; along += step) {
      if (nearest && nearest.distance < along - 2 * step) break;
      const x = origin[0] + along * direction[0], z = origin[2] + along * direction[2];
      const [column, row] = this.cellAt(x, z);
      if (row * this.columns + column === before) continue;
      before = row * this.columns + column;
      this.around(x, z, this.cell / 2, test);
    }
    return nearest;
  }
}

/// The point of a triangle nearest to p (Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
function nearestPoint(p, [a, b, c]) {
  const ab = subtract(b, a), ac = subtract(c, a), ap = subtract(p, a);
  const d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = subtract(p, b), d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return add(a, scaled(ab, d1 / (d1 - d3)));
  const cp = subtract(p, c), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return add(a, scaled(ac, d2 / (d2 - d6)));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return add(b, scaled(subtract(c, b), (d4 - d3) / (d4 - d3 + d5 - d6)));
  }
  const sum = va + vb + vc;
  return add(a, add(scaled(ab, vb / sum), scaled(ac, vc / sum)));
}
