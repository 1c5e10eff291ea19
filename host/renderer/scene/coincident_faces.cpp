#include "scene/coincident_faces.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/box_tree.hpp"
#include "geometry/triangle_distance.hpp"

namespace photile::scene {
namespace {

/// Planes agree up to this, over the largest coordinate of their triangles: half of what rays start
/// above a surface (trace/surface.hpp), and several roundings.
constexpr double rounding_per_coordinate = 0x1p-20;
/// Of the normals of triangles in one plane. Those of small triangles are less certain than their
/// planes.
constexpr double least_cosine = 1 - 1e-4;

using Corners = geometry::TriangleCorners;
using Polygon = std::vector<glm::dvec3>;

double rounding_of(const Corners& corners) {
  double largest = 0;
  for (const glm::dvec3& corner : corners) {
    largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
  }
  return rounding_per_coordinate * largest;
}

/// A triangle in its plane.
struct Face {
  explicit Face(const Corners& triangle) : corner(triangle), rounding(rounding_of(triangle)) {
    normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    for (std::size_t i = 0; i < 3; ++i) {
      inwards[i] = glm::normalize(glm::cross(normal, corner[(i + 1) % 3] - corner[i]));
    }
  }

  /// Metres to the inside of edge `i`.
  double inside(std::size_t i, const glm::dvec3& point) const {
    return glm::dot(inwards[i], point - corner[i]);
  }

  /// How far the corners of the other lie off this plane, at most.
  double off_plane(const Corners& other) const {
    double most = 0;
    for (const glm::dvec3& point : other) {
      most = std::max(most, std::abs(glm::dot(normal, point - corner[0])));
    }
    return most;
  }

  /// Whether the other lies beyond one of the edges, up to rounding.
  bool is_apart_from(const Corners& other, double margin) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (inside(i, other[0]) <= margin && inside(i, other[1]) <= margin &&
          inside(i, other[2]) <= margin) {
        return true;
      }
    }
    return false;
  }

  Corners corner;
  double rounding;  ///< metres
  glm::dvec3 normal{0.0};
  std::array<glm::dvec3, 3> inwards{};  ///< unit, in the plane, per edge
};

/// Whether two triangles in about one plane share an area: two convex figures are apart where an
/// edge of one of them divides them, as it does neighbours in a mesh.
bool overlap(const Face& a, const Corners& corners) {
  const double rounding = std::max(a.rounding, rounding_of(corners));
  if (a.is_apart_from(corners, 2 * rounding)) return false;
  const Face b(corners);
  return !b.is_apart_from(a.corner, 2 * rounding) &&
         std::min(a.off_plane(corners), b.off_plane(a.corner)) <= rounding;
}

Face face_of(const Scene& scene, std::uint32_t triangle) {
  return Face(geometry::corners_of(scene, triangle));
}

/// Fronts come before backs, and of these lights, whose light comes from there all the same, then
/// what is first in the file.
std::tuple<bool, bool, std::uint32_t> rank(const Scene& scene, std::uint32_t oriented_face) {
  const std::uint32_t triangle = triangle_of(oriented_face);
  return {side_of(oriented_face) != scene.front_side[triangle],
          scene.triangle_light[triangle] == none, triangle};
}

/// Per triangle: those that overlap it, ascending.
std::vector<std::vector<std::uint32_t>> find_overlaps(const Scene& scene) {
  const std::vector<geometry::Box> boxes = geometry::triangle_boxes(scene);
  const geometry::BoxTree tree(boxes);
  std::vector<glm::dvec3> normal(boxes.size());
  tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t t) {
    normal[t] = face_normal(scene, oriented(static_cast<std::uint32_t>(t), 0));
  });
  std::vector<std::vector<std::uint32_t>> others(boxes.size());
  tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t t) {
    const auto triangle = static_cast<std::uint32_t>(t);
    const Face face = face_of(scene, triangle);
    const auto margin = static_cast<float>(face.rounding);
    const geometry::Box near{boxes[t].lower - margin, boxes[t].upper + margin};
    tree.visit_overlapping(boxes, near, [&](std::uint32_t other) {
      if (other == triangle) return;
      if (!(std::abs(glm::dot(normal[t], normal[other])) >= least_cosine)) return;
      if (overlap(face, geometry::corners_of(scene, other))) others[t].push_back(other);
    });
    std::sort(others[t].begin(), others[t].end());
  });
  return others;
}

/// The part of a convex polygon on the inner side of an edge, and what is beyond it; either may be
/// empty. Slivers of a rounding belong to the larger part.
std::pair<Polygon, Polygon> divide(const Polygon& polygon, const Face& by, std::size_t edge,
                                   double rounding) {
  std::vector<double> inside;
  for (const glm::dvec3& point : polygon) inside.push_back(by.inside(edge, point));
  const auto [least, most] = std::minmax_element(inside.begin(), inside.end());
  if (*least >= -rounding && *most > rounding) return {polygon, {}};
  if (*most <= rounding) return {{}, polygon};
  Polygon inner, outer;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (inside[i] >= 0) inner.push_back(polygon[i]);
    if (inside[i] <= 0) outer.push_back(polygon[i]);
    if (inside[i] * inside[next] < 0) {
      const double way = inside[i] / (inside[i] - inside[next]);
      const glm::dvec3 cut = polygon[i] + way * (polygon[next] - polygon[i]);
      inner.push_back(cut);
      outer.push_back(cut);
    }
  }
  return {inner, outer};
}

void append_triangles(const Polygon& polygon, std::vector<CoincidentFaces::Part>& parts) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    parts.push_back({glm::vec3(polygon[0]), glm::vec3(polygon[i - 1]), glm::vec3(polygon[i])});
  }
}

}  // namespace

CoincidentFaces::CoincidentFaces(const Scene& scene) {
  const auto others = find_overlaps(scene);
  const bool any = std::any_of(others.begin(), others.end(),
                               [](const auto& of_triangle) { return !of_triangle.empty(); });
  if (!any) return;
  std::vector<std::vector<std::uint32_t>> before(2 * others.size());
  for (std::uint32_t t = 0; t < others.size(); ++t) {
    for (const std::uint32_t other : others[t]) {
      const glm::dvec3 normal = face_normal(scene, oriented(t, 0));
      const bool alike = glm::dot(normal, face_normal(scene, oriented(other, 0))) > 0;
      for (const std::uint32_t side : {0u, 1u}) {
        const std::uint32_t own = oriented(t, side), its = oriented(other, alike ? side : 1 - side);
        if (rank(scene, its) < rank(scene, own)) before[own].push_back(its);
      }
    }
  }
  for (auto& faces : before) {
    std::sort(faces.begin(), faces.end(),
              [&](std::uint32_t a, std::uint32_t b) { return rank(scene, a) < rank(scene, b); });
  }
  before_ = rows_of(before.size(), [&](const auto& put) {
    for (std::size_t s = 0; s < before.size(); ++s) {
      for (const std::uint32_t face : before[s]) put(s, face);
    }
  });
}

std::uint32_t CoincidentFaces::at(const Scene& scene, std::uint32_t oriented_face,
                                  const glm::dvec3& position) const {
  for (const std::uint32_t other : before(oriented_face)) {
    const std::uint32_t triangle = triangle_of(other);
    if (scene.triangles[triangle] == scene.triangles[triangle_of(oriented_face)]) return other;
    const Face face = face_of(scene, triangle);
    const double margin = -2 * face.rounding;
    if (face.inside(0, position) >= margin && face.inside(1, position) >= margin &&
        face.inside(2, position) >= margin) {
      return other;
    }
  }
  return oriented_face;
}

CoincidentFaces::Parts CoincidentFaces::parts_of(const Scene& scene,
                                                 std::uint32_t oriented_face) const {
  const Corners own = geometry::corners_of(scene, triangle_of(oriented_face));
  std::vector<Polygon> counted{Polygon(own.begin(), own.end())};
  Parts parts;
  for (const std::uint32_t other : before(oriented_face)) {
    const Face by = face_of(scene, triangle_of(other));
    const double rounding = 2 * std::max(by.rounding, rounding_of(own));
    std::vector<Polygon> left;
    for (Polygon& polygon : counted) {
      for (std::size_t edge = 0; edge < 3 && !polygon.empty(); ++edge) {
        auto [inner, outer] = divide(polygon, by, edge, rounding);
        if (!outer.empty()) left.push_back(std::move(outer));
        polygon = std::move(inner);
      }
      append_triangles(polygon, parts.hidden);
    }
    counted = std::move(left);
  }
  for (const Polygon& polygon : counted) append_triangles(polygon, parts.counted);
  return parts;
}

}  // namespace photile::scene
