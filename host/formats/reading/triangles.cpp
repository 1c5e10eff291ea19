#include "reading/triangles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "scene/scene_queries.hpp"

namespace photile::reading {

namespace {

bool comes_before(const glm::dvec3& a, const glm::dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Corner numbers from the lexicographically smallest corner on, towards its smaller neighbour.
/// `reversed` tells whether that runs against the polygon's own order.
std::vector<std::uint32_t> canonical_order(std::span<const glm::dvec3> corners, bool& reversed) {
  const auto count = static_cast<std::uint32_t>(corners.size());
  const auto first = static_cast<std::uint32_t>(
      std::min_element(corners.begin(), corners.end(), comes_before) - corners.begin());
  const std::uint32_t next = (first + 1) % count, previous = (first + count - 1) % count;
  reversed = comes_before(corners[previous], corners[next]);
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    order[i] = reversed ? (first + count - i) % count : (first + i) % count;
  }
  return order;
}

/// The polygon's points in a plane, counter-clockwise.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> corners,
                                const std::vector<std::uint32_t>& order) {
  glm::dvec3 normal(0.0);
  const glm::dvec3 origin = corners[order[0]];
  for (std::size_t i = 0; i < order.size(); ++i) {
    normal +=
        glm::cross(corners[order[i]] - origin, corners[order[(i + 1) % order.size()]] - origin);
  }
  const glm::dvec3 size = glm::abs(normal);
  const int dropped = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
  const double sign = normal[dropped] < 0.0 ? -1.0 : 1.0;
  std::vector<glm::dvec2> points;
  points.reserve(order.size());
  for (const std::uint32_t corner : order) {
    points.emplace_back(sign * (corners[corner][u] - origin[u]), corners[corner][v] - origin[v]);
  }
  return points;
}

/// Twice the signed area of a triangle.
double signed_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The concave corners of a polygon, to find out whether one of them lies in a triangle: a k-d tree
/// over all points, each node with the number of concave corners below it.
class ConcaveCorners {
 public:
  explicit ConcaveCorners(const std::vector<glm::dvec2>& points)
      : points_(points),
        is_concave_(points.size(), false),
        order_(points.size()),
        place_(points.size()),
        nodes_(2 * std::bit_ceil(points.size())) {
    std::iota(order_.begin(), order_.end(), 0u);
    build({1, 0, points.size()});
    for (std::uint32_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
  }

  void set(std::uint32_t point, bool concave) {
    if (is_concave_[point] == concave) return;
    is_concave_[point] = concave;
    for (Part part{1, 0, points_.size()};;) {
      nodes_[part.node].concave += concave ? 1u : ~0u;
      if (part.size() == 1) return;
      part = place_[point] < part.middle() ? part.lower() : part.upper();
    }
  }

  /// Whether one lies in the triangle or on it; one that touches it at a corner does not count.
  bool any_in(const std::array<glm::dvec2, 3>& triangle) const {
    const glm::dvec2 low = glm::min(glm::min(triangle[0], triangle[1]), triangle[2]);
    const glm::dvec2 high = glm::max(glm::max(triangle[0], triangle[1]), triangle[2]);
    return any_in({1, 0, points_.size()}, triangle, low, high);
  }

 private:
  struct Part {
    std::size_t node, first, last;
    std::size_t size() const { return last - first; }
    std::size_t middle() const { return first + size() / 2; }
    Part lower() const { return {2 * node, first, middle()}; }
    Part upper() const { return {2 * node + 1, middle(), last}; }
  };
  struct Node {
    glm::dvec2 low, high;
    std::uint32_t concave = 0;
  };

  void build(const Part& part) {
    Node& node = nodes_[part.node];
    node.low = node.high = points_[order_[part.first]];
    for (std::size_t i = part.first; i < part.last; ++i) {
      node.low = glm::min(node.low, points_[order_[i]]);
      node.high = glm::max(node.high, points_[order_[i]]);
    }
    if (part.size() == 1) return;
    const glm::dvec2 size = node.high - node.low;
    const int axis = size.x < size.y ? 1 : 0;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(
        at(part.first), at(part.middle()), at(part.last),
        [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    build(part.lower());
    build(part.upper());
  }

  bool any_in(const Part& part, const std::array<glm::dvec2, 3>& triangle, const glm::dvec2& low,
              const glm::dvec2& high) const {
    const Node& node = nodes_[part.node];
    if (node.concave == 0 || glm::any(glm::greaterThan(node.low, high)) ||
        glm::any(glm::lessThan(node.high, low))) {
      return false;
    }
    const auto& [a, b, c] = triangle;
    if (node.low == node.high) {
      const glm::dvec2 p = node.low;
      return p != a && p != b && p != c && signed_area(a, b, p) >= 0.0 &&
             signed_area(b, c, p) >= 0.0 && signed_area(c, a, p) >= 0.0;
    }
    return any_in(part.lower(), triangle, low, high) || any_in(part.upper(), triangle, low, high);
  }

  const std::vector<glm::dvec2>& points_;
  std::vector<bool> is_concave_;
  std::vector<std::uint32_t> order_;  ///< points as the tree's leaves have them
  std::vector<std::uint32_t> place_;  ///< of a point in order_
  std::vector<Node> nodes_;           ///< the root is 1, the children of n are 2 n and 2 n + 1
};

/// The part of a polygon that no ear has been cut from yet, as a ring of point numbers.
class Ring {
 public:
  explicit Ring(const std::vector<glm::dvec2>& points)
      : points_(points), next_(points.size()), previous_(points.size()), concave_(points) {
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
    for (std::uint32_t i = 0; i < count; ++i) update(i);
  }

  std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }

  double corner_area(std::uint32_t i) const {
    return signed_area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  /// Whether the triangle at corner i lies inside the polygon: only a concave corner can poke into
  /// it.
  bool is_ear(std::uint32_t i) const {
    return corner_area(i) > 0.0 &&
           !concave_.any_in({points_[previous_[i]], points_[i], points_[next_[i]]});
  }

  void remove(std::uint32_t i) {
    const std::uint32_t before = previous_[i], after = next_[i];
    concave_.set(i, false);
    next_[before] = after;
    previous_[after] = before;
    update(before);
    update(after);
  }

 private:
  void update(std::uint32_t i) { concave_.set(i, corner_area(i) <= 0.0); }

  const std::vector<glm::dvec2>& points_;
  std::vector<std::uint32_t> next_, previous_;
  ConcaveCorners concave_;
};

}  // namespace

Triangulation triangulate_polygon(std::span<const glm::dvec3> corners, const Progress& progress) {
  Triangulation result;
  bool reversed = false;
  const std::vector<std::uint32_t> order = canonical_order(corners, reversed);
  const std::vector<glm::dvec2> points = project(corners, order);
  Ring ring(points);
  const auto emit = [&](std::uint32_t i) {
    std::array<std::uint32_t, 3> triangle{order[ring.previous(i)], order[i], order[ring.next(i)]};
    if (reversed) std::swap(triangle[0], triangle[2]);
    result.triangles.push_back(triangle);
  };
  // Cutting an ear of a simple polygon changes whether a corner is an ear at its two neighbours
  // alone (Meisters 1975), so a corner that was none is not asked again before that. In the ring's
  // order, from `current` on.
  std::set<std::uint32_t> unknown;
  const auto ask_all = [&](std::uint32_t from) {
    std::uint32_t i = from;
    do unknown.insert(i);
    while ((i = ring.next(i)) != from);
  };
  std::uint32_t current = 0;
  std::size_t left = points.size(), asked_all_at = left;
  const auto cut = [&] {
    emit(current);
    const std::uint32_t before = ring.previous(current);
    unknown.erase(current);
    ring.remove(current);
    current = ring.next(before);
    unknown.insert({before, current});
    --left;
  };
  ask_all(current);
  // Where a polygon crosses itself, the search for one ear may visit all corners.
  constexpr std::size_t rounds_between_checks = 256;
  for (std::size_t round = 1; left > 3; ++round) {
    if (round % rounds_between_checks == 0) progress.throw_if_cancelled();
    if (!unknown.empty()) {
      const auto found = unknown.lower_bound(current);
      current = found == unknown.end() ? *unknown.begin() : *found;
      if (ring.is_ear(current)) {
        cut();
      } else {
        unknown.erase(current);
        current = ring.next(current);
      }
      continue;
    }
    // Corners on a straight line are no ears; they become ends of other ears. Where none is left,
    // the polygon crosses itself or is flat: all are asked again now and then, and any corner is as
    // good as another between.
    if (2 * left <= asked_all_at) {
      asked_all_at = left;
      ask_all(current);
      continue;
    }
    if (ring.corner_area(current) != 0.0) result.simple = false;
    cut();
  }
  if (points.size() > 3 && ring.corner_area(current) < 0.0) result.simple = false;
  emit(current);
  return result;
}

void SceneOrigin::add(const std::array<glm::dvec3, 3>& corners) {
  if (!std::all_of(corners.begin(), corners.end(), scene::within_limit)) return;
  double longest = 0, squares = 0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
    longest = std::max(longest, glm::dot(edge, edge));
    squares += glm::dot(corners[i], corners[i]);
  }
  const double weight = 1.0 / longest;
  if (!std::isfinite(weight * squares)) return;
  corners_ += 3;
  weight_ += 3.0 * weight;
  sum_ += weight * (corners[0] + corners[1] + corners[2]);
  squares_ += weight * squares;
}

glm::dvec3 SceneOrigin::best() const {
  constexpr double far = 64.0, gain = 16.0;
  if (corners_ == 0) return glm::dvec3(0.0);
  const double mean_square = squares_ / static_cast<double>(corners_);
  if (!(mean_square > far * far)) return glm::dvec3(0.0);
  // Koenig and Huygens: moving the origin to the mean takes its own square off the mean square.
  const glm::dvec3 mean = sum_ / weight_;
  const double gone = weight_ * glm::dot(mean, mean) / static_cast<double>(corners_);
  if (!(mean_square - gone < mean_square / (gain * gain))) return glm::dvec3(0.0);
  return glm::dvec3(glm::vec3(mean));
}

namespace {

/// The fewest triangles of a mesh that is shared: an instance takes about as much of Embree's
/// memory as these, and each ray that meets its box has to be moved into the mesh's space.
constexpr std::ptrdiff_t least_triangles = 64;

/// Triangles that sharing a mesh must save, about a megabyte of Embree's memory: less is not worth
/// the moves, nor the buffers that each mesh takes for itself.
constexpr std::size_t least_saved_triangles = 16'384;

/// Whether the transform is a scale along the axes, then a rotation or mirror, then a translation:
/// the columns of its linear part are at right angles. The inverse of such a transform moves a
/// point with an error of some roundings of its world coordinates, which is what the clearance of
/// host/renderer/trace/surface.cpp allows for; a skew multiplies that error.
bool keeps_right_angles(const glm::dmat4& world) {
  constexpr double tolerance = 1e-5;  // a float matrix of a rotation is not exact
  const glm::dmat3 linear(world);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(linear[i]);
    if (!std::isfinite(length) || !(length > 0)) return false;
    const glm::dvec3& other = linear[(i + 1) % 3];
    if (std::abs(glm::dot(linear[i], other)) > tolerance * length * glm::length(other)) {
      return false;
    }
  }
  return true;
}

std::vector<glm::uvec3> kept_triangles(const LocalMesh& local, const std::vector<bool>& kept) {
  std::vector<glm::uvec3> triangles;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (kept[t]) triangles.push_back(local.triangles[t]);
  }
  return triangles;
}

/// The centre of the triangles' corners: vertices that belong to no triangle may be anything.
glm::dvec3 centre_of(const LocalMesh& local, const std::vector<glm::uvec3>& triangles) {
  glm::dvec3 low = local.positions[triangles.front().x], high = low;
  for (const glm::uvec3& triangle : triangles) {
    for (int c = 0; c < 3; ++c) {
      low = glm::min(low, local.positions[triangle[c]]);
      high = glm::max(high, local.positions[triangle[c]]);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

void InstanceRecorder::record(int mesh, const glm::dmat4& world, std::uint32_t first_triangle,
                              const std::vector<bool>& kept,
                              const std::function<LocalMesh()>& read) {
  if (std::count(kept.begin(), kept.end(), true) < least_triangles) return;
  if (!keeps_right_angles(world)) return;
  const auto [entry, is_new] = meshes_.try_emplace(mesh);
  Mesh& known = entry->second;
  if (is_new) {
    const LocalMesh local = read();
    known.shared.triangles = kept_triangles(local, kept);
    // Around the centre, since small coordinates lose least.
    known.centre = centre_of(local, known.shared.triangles);
    for (const glm::dvec3& position : local.positions) {
      known.shared.vertices.emplace_back(position - known.centre);
    }
    known.kept = kept;
  } else if (known.kept != kept) {
    return;
  }
  glm::dmat4 from_centre = world;
  from_centre[3] = world * glm::dvec4(known.centre, 1.0);
  known.instances.push_back({first_triangle, glm::mat4x3(from_centre)});
}

void InstanceRecorder::finish() {
  for (auto& [number, mesh] : meshes_) {
    const std::size_t instances = std::max<std::size_t>(1, mesh.instances.size());
    if ((instances - 1) * mesh.shared.triangles.size() < least_saved_triangles) continue;
    const auto index = static_cast<std::uint32_t>(scene_.shared_meshes.size());
    scene_.shared_meshes.push_back(std::move(mesh.shared));
    for (const Instance& instance : mesh.instances) {
      scene_.instances.push_back({index, instance.first_triangle, instance.to_world});
    }
  }
  std::sort(scene_.instances.begin(), scene_.instances.end(),
            [](const MeshInstance& a, const MeshInstance& b) {
              return a.first_triangle < b.first_triangle;
            });
  meshes_.clear();
}

}  // namespace photile::reading
