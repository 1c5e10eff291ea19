#include "maps/map_shapes.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/box.hpp"
#include "groups/patch_shape.hpp"
#include "scene/scene_queries.hpp"

namespace photile::maps {

namespace {

double perimeter_of(const Scene& scene, std::uint32_t triangle) {
  const auto corners = scene.corners(triangle);
  double perimeter = 0;
  for (int i = 0; i < 3; ++i) perimeter += glm::distance(corners[i], corners[(i + 1) % 3]);
  return perimeter;
}

/// Whether the kernels can compute distances from the triangle (kernels/shared/point_triangle.clh);
/// that of its box stands for it otherwise, which for a needle is nearly the same.
bool has_float_distance(const Scene& scene, std::uint32_t triangle) {
  constexpr double shortest = 0x1p-24, longest = 0x1p29;  // metres
  constexpr double most_heights = 16;
  const auto corners = scene.corners(triangle);
  double edge = 0;
  for (int i = 0; i < 3; ++i) {
    edge = std::max(edge, glm::distance(glm::dvec3(corners[i]), glm::dvec3(corners[(i + 1) % 3])));
  }
  return edge >= shortest && edge <= longest &&
         edge * edge <= most_heights * 2 * triangle_area(scene, triangle);
}

/// `members`: oriented faces of the map whose side the axis points from.
PhotileMapShape map_shape(const Scene& scene, const groups::TriangleFacts& facts,
                          std::span<const std::uint32_t> members, double angle, double margin) {
  std::vector<std::uint32_t> triangles(members.size());
  std::transform(members.begin(), members.end(), triangles.begin(), triangle_of);
  const groups::PatchShape box = groups::shape_of(scene, facts, triangles);

  const auto cosine = [&](std::uint32_t member) {
    const double cosine = glm::dot(glm::dvec3(facts.normal[triangle_of(member)]), box.axis);
    return side_of(member) == 0 ? cosine : -cosine;
  };
  double sum = 0, least = 1, most = -1;
  for (const std::uint32_t member : members) {
    sum += cosine(member);
    least = std::min(least, cosine(member));
    most = std::max(most, cosine(member));
  }
  const double sign = sum < 0 ? -1 : 1;
  const double lean = std::acos(std::clamp(sign > 0 ? least : -most, -1.0, 1.0));
  constexpr double slack = 1e-3;  // radians; far above the rounding of normals
  const double certain_angle = angle - lean - slack;

  const glm::dvec3 corner = box.low - margin;
  const glm::vec3 origin(corner.x * box.u_axis + corner.y * box.v_axis + corner.z * box.axis);
  const glm::vec3 u(box.u_axis), v(box.v_axis), axis(sign * box.axis);
  // Heights are measured from the origin along the axis: turn it over with the axis.
  const glm::vec3 base =
      sign > 0 ? origin : glm::vec3(glm::dvec3(origin) + box.axis * (box.width(2) + 2 * margin));
  PhotileMapShape shape{};
  shape.origin_x = base.x, shape.origin_y = base.y, shape.origin_z = base.z;
  shape.u_axis_x = u.x, shape.u_axis_y = u.y, shape.u_axis_z = u.z;
  shape.v_axis_x = v.x, shape.v_axis_y = v.y, shape.v_axis_z = v.z;
  shape.axis_x = axis.x, shape.axis_y = axis.y, shape.axis_z = axis.z;
  shape.width_u = static_cast<float>(box.width(0) + 2 * margin);
  shape.width_v = static_cast<float>(box.width(1) + 2 * margin);
  shape.height = static_cast<float>(box.width(2) + 2 * margin);
  shape.area = static_cast<float>(box.area);
  const bool single = members.size() == 1;
  shape.perimeter = static_cast<float>(single ? perimeter_of(scene, triangles.front())
                                              : 2 * (box.width(0) + box.width(1)));
  shape.certain_cosine = certain_angle > 0 ? static_cast<float>(std::cos(certain_angle)) : 2.0f;
  geometry::Box bounds;
  for (const std::uint32_t triangle : triangles) {
    for (const glm::vec3& corner_of : scene.corners(triangle)) bounds.extend(corner_of);
  }
  shape.low_x = bounds.lower.x, shape.low_y = bounds.lower.y, shape.low_z = bounds.lower.z;
  shape.high_x = bounds.upper.x, shape.high_y = bounds.upper.y, shape.high_z = bounds.upper.z;
  const bool exact = single && has_float_distance(scene, triangles.front());
  shape.triangle = exact ? triangles.front() : PHOTILE_NO_TRIANGLE;
  return shape;
}

}  // namespace

MapShapes map_shapes(const Scene& scene, const Patches& patches,
                     std::span<const std::uint32_t> pairs, double angle_radians) {
  const groups::TriangleFacts facts(scene);
  // What rounding to float may move a corner by, metres.
  const double margin =
      4.0 * std::numeric_limits<float>::epsilon() * scene::largest_coordinate(scene);
  MapShapes result;
  result.shapes.resize(pairs.size());
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
    const std::uint32_t own = oriented(pairs[i], 0);
    const std::span<const std::uint32_t> members =
        patches.empty() ? std::span(&own, 1) : patches.of(pairs[i]);
    result.shapes[i] = map_shape(scene, facts, members, angle_radians, margin);
  });
  for (PhotileMapShape& shape : result.shapes) {
    if (shape.triangle == PHOTILE_NO_TRIANGLE) continue;
    const auto index = static_cast<std::uint32_t>(result.corners.size() / 9);
    for (const glm::vec3& corner : scene.corners(shape.triangle)) {
      result.corners.insert(result.corners.end(), {corner.x, corner.y, corner.z});
    }
    shape.triangle = index;
  }
  return result;
}

namespace {

constexpr std::uint32_t photons_per_bin = 16;
constexpr int most_halvings = 6;  ///< of each side of a triangle: 4096 bins

/// A triangle's sides are halved so often that its bins hold photons_per_bin on average.
int halvings_for(std::uint32_t photons) {
  return std::clamp((static_cast<int>(std::bit_width(photons / photons_per_bin)) - 1) / 2, 0,
                    most_halvings);
}

/// The bin of a point among the 4^halvings congruent parts of a triangle: squares of the
/// barycentric coordinates, each cut in two.
std::size_t bin_of(const glm::vec3& point, const std::array<glm::vec3, 3>& corners, int halvings) {
  const glm::dvec3 a(corners[0]), u = glm::dvec3(corners[1]) - a, v = glm::dvec3(corners[2]) - a;
  const glm::dvec3 p = glm::dvec3(point) - a;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
  const double pu = glm::dot(p, u), pv = glm::dot(p, v);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return 0;
  const int side = 1 << halvings;
  const double s = (vv * pu - uv * pv) / determinant * side;
  const double t = (uu * pv - uv * pu) / determinant * side;
  const int i = std::clamp(static_cast<int>(s), 0, side - 1);
  const int j = std::clamp(static_cast<int>(t), 0, side - 1);
  const bool upper = (s - i) + (t - j) > 1;
  return (static_cast<std::size_t>(i) * static_cast<std::size_t>(side) +
          static_cast<std::size_t>(j)) *
             2 +
         (upper ? 1 : 0);
}

/// The integral of the squared density over a triangle, photons squared per square metre.
double squared_density(const std::array<glm::vec3, 3>& corners, double area,
                       std::span<const glm::vec3> positions) {
  if (!(area > 0)) return 0;
  const int halvings = halvings_for(static_cast<std::uint32_t>(positions.size()));
  std::vector<std::uint32_t> counts(std::size_t{2} << (2 * halvings), 0);
  for (const glm::vec3& position : positions) ++counts[bin_of(position, corners, halvings)];
  double pairs = 0;
  for (const double count : counts) pairs += count * (count - 1);
  return pairs * static_cast<double>(1u << (2 * halvings)) / area;
}

}  // namespace

std::vector<float> photon_density_ratio(const Scene& scene, const Photons& photons,
                                        const Patches& patches) {
  const std::size_t face_count = 2 * scene.triangle_count();
  std::vector<double> squared(face_count, 0);
  tbb::parallel_for(std::size_t{0}, face_count, [&](std::size_t s) {
    const std::uint32_t first = photons.first_of[s], count = photons.first_of[s + 1] - first;
    if (count < 2) return;
    const auto triangle = static_cast<std::uint32_t>(s / 2);
    squared[s] = squared_density(scene.corners(triangle), triangle_area(scene, triangle),
                                 {photons.position.data() + first, count});
  });

  struct Sums {
    double area = 0, photons = 0, squared = 0;
  };
  std::vector<Sums> sums(patches.empty() ? face_count : 2 * patches.count());
  for (std::uint32_t s = 0; s < face_count; ++s) {
    Sums& sum = sums[patches.map(s)];
    sum.area += triangle_area(scene, triangle_of(s));
    sum.photons += photons.first_of[s + 1] - photons.first_of[s];
    sum.squared += squared[s];
  }
  std::vector<float> density_ratio(sums.size(), 1.0f);
  for (std::size_t map = 0; map < sums.size(); ++map) {
    const auto& [area, count, integral] = sums[map];
    if (count > 0) {
      density_ratio[map] = static_cast<float>(std::max(1.0, integral * area / (count * count)));
    }
  }
  return density_ratio;
}

}  // namespace photile::maps
