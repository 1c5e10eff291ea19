#include "groups/patch_shape.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace photile::groups {
namespace {

constexpr int raster_side = 64;

/// The direction that maximises the sum of area x (normal . direction)^2, by power iteration from
/// the normal of the largest triangle: the dominant eigenvector, blind to winding.
glm::dvec3 shared_axis(const TriangleFacts& facts, std::span<const std::uint32_t> triangles,
                       std::uint32_t largest) {
  glm::dvec3 squares(0.0), products(0.0);  // of coordinates of normals
  for (const std::uint32_t t : triangles) {
    const glm::dvec3 normal(facts.normal[t]);
    const double area = facts.area[t];
    squares += area * (normal * normal);
    products += area * glm::dvec3(normal.y * normal.z, normal.z * normal.x, normal.x * normal.y);
  }
  const glm::dmat3 moments(squares.x, products.z, products.y, products.z, squares.y, products.x,
                           products.y, products.x, squares.z);
  glm::dvec3 axis(facts.normal[largest]);
  for (int step = 0; step < 12; ++step) {
    const glm::dvec3 next = moments * axis;
    const double length = glm::length(next);
    if (!(length > 0)) break;
    axis = next / length;
  }
  return axis;
}

/// The longest edge of a triangle, turned into the plane across `axis`.
glm::dvec3 longest_edge_across(const Scene& scene, std::uint32_t triangle, const glm::dvec3& axis) {
  const auto corners = scene.corners(triangle);
  glm::dvec3 longest(0.0);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 edge = glm::dvec3(corners[(i + 1) % 3]) - glm::dvec3(corners[i]);
    const glm::dvec3 across = edge - axis * glm::dot(edge, axis);
    if (glm::dot(across, across) > glm::dot(longest, longest)) longest = across;
  }
  if (glm::dot(longest, longest) > 0) return glm::normalize(longest);
  const glm::dvec3 helper = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, helper));
}

}  // namespace

TriangleFacts::TriangleFacts(const Scene& scene)
    : normal(scene.triangle_count()), area(scene.triangle_count()) {
  tbb::parallel_for(std::size_t{0}, normal.size(), [&](std::size_t t) {
    const auto triangle = static_cast<std::uint32_t>(t);
    normal[t] = glm::vec3(face_normal(scene, oriented(triangle, 0)));
    area[t] = static_cast<float>(triangle_area(scene, triangle));
  });
}

PatchShape shape_of(const Scene& scene, const TriangleFacts& facts,
                    std::span<const std::uint32_t> triangles) {
  const std::uint32_t largest = *std::max_element(
      triangles.begin(), triangles.end(),
      [&](std::uint32_t a, std::uint32_t b) { return facts.area[a] < facts.area[b]; });
  PatchShape shape;
  shape.axis = shared_axis(facts, triangles, largest);
  shape.u_axis = longest_edge_across(scene, largest, shape.axis);
  shape.v_axis = glm::cross(shape.axis, shape.u_axis);
  shape.low = glm::dvec3(std::numeric_limits<double>::infinity());
  shape.high = -shape.low;
  for (const std::uint32_t t : triangles) {
    for (const glm::dvec3& corner : local_corners(scene, shape, t)) {
      shape.low = glm::min(shape.low, corner);
      shape.high = glm::max(shape.high, corner);
    }
    shape.area += facts.area[t];
    shape.least_cosine =
        std::min(shape.least_cosine, std::abs(glm::dot(glm::dvec3(facts.normal[t]), shape.axis)));
  }
  return shape;
}

double covered_part(const Scene& scene, const PatchShape& shape,
                    std::span<const std::uint32_t> triangles, double cell_size) {
  const double cell =
      std::max({cell_size, shape.width(0) / raster_side, shape.width(1) / raster_side});
  const auto cells_along = [&](int axis) {
    return std::clamp(static_cast<int>(std::ceil(shape.width(axis) / cell)), 1, raster_side);
  };
  const int columns = cells_along(0), rows = cells_along(1);
  const auto index = [&](double coordinate, int axis, int count) {
    return std::clamp(static_cast<int>((coordinate - shape.low[axis]) / cell), 0, count - 1);
  };
  std::vector<bool> covered(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (const std::uint32_t t : triangles) {
    const auto corners = local_corners(scene, shape, t);
    const glm::dvec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
    const glm::dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
    for (int row = index(low.y, 1, rows); row <= index(high.y, 1, rows); ++row) {
      for (int column = index(low.x, 0, columns); column <= index(high.x, 0, columns); ++column) {
        covered[static_cast<std::size_t>(row * columns + column)] = true;
      }
    }
  }
  return static_cast<double>(std::count(covered.begin(), covered.end(), true)) /
         static_cast<double>(covered.size());
}

}  // namespace photile::groups
