#include "view/photon_map_view.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/triangle_distance.hpp"

namespace photile::view {
namespace {

std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t sided_triangle) {
  const auto corners = scene.corners(triangle_of(sided_triangle));
  return {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
}

/// Whether the boxes of two triangles are at most `radius` apart: cheap, and never wrongly no.
bool boxes_within(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b,
                  double radius) {
  const glm::dvec3 gap =
      glm::max(glm::min(glm::min(a[0], a[1]), a[2]) - glm::max(glm::max(b[0], b[1]), b[2]),
               glm::min(glm::min(b[0], b[1]), b[2]) - glm::max(glm::max(a[0], a[1]), a[2]));
  return std::max({gap.x, gap.y, gap.z}) <= radius;
}

std::vector<std::uint32_t> group_of(const Scene& scene, const InspectablePhotons& photons,
                                    std::uint32_t sided_triangle) {
  if (!std::isfinite(photons.radius)) return {};
  const double cos_angle = std::cos(glm::radians(photons.angle_degrees));
  const auto own = corners_of(scene, sided_triangle);
  const glm::dvec3 normal = sided_normal(scene, sided_triangle);
  std::vector<std::uint8_t> near(2 * scene.triangle_count(), 0);
  tbb::parallel_for(std::size_t{0}, scene.triangle_count(), [&](std::size_t triangle) {
    const auto first = sided(static_cast<std::uint32_t>(triangle), 0);
    const auto other = corners_of(scene, first);
    if (!boxes_within(own, other, photons.radius)) return;
    if (triangle_triangle_distance(own, other) > photons.radius) return;
    for (const std::uint32_t each : {first, first + 1}) {
      near[each] = normals_agree(normal, sided_normal(scene, each), cos_angle) ? 1 : 0;
    }
  });
  near[sided_triangle] = 0;
  std::vector<std::uint32_t> group;
  for (std::uint32_t each = 0; each < near.size(); ++each) {
    if (near[each]) group.push_back(each);
  }
  return group;
}

std::span<const glm::vec3> photons_on(const InspectablePhotons& photons,
                                      std::uint32_t sided_triangle) {
  return std::span(photons.position)
      .subspan(photons.first_of[sided_triangle],
               photons.first_of[sided_triangle + 1] - photons.first_of[sided_triangle]);
}

}  // namespace

InspectablePhotons InspectablePhotons::of(const PreparedPhotons& photons) {
  return {photons.photons.position, photons.photons.first_of, photons.groups.patches,
          photons.groups.radius, photons.groups.angle_degrees};
}

PhotonMapView view_of_map(const Scene& scene, const InspectablePhotons& photons,
                          std::uint32_t sided_triangle) {
  PhotonMapView view;
  view.sided_triangle = sided_triangle;
  view.group = group_of(scene, photons, sided_triangle);
  const std::vector<std::uint32_t>& map_of = photons.patches.map_of;
  for (std::uint32_t each = 0; each < map_of.size(); ++each) {
    if (each == sided_triangle || map_of[each] != map_of[sided_triangle]) continue;
    if (!std::binary_search(view.group.begin(), view.group.end(), each)) view.patch.push_back(each);
  }
  const auto own = photons_on(photons, sided_triangle);
  view.own_photons.assign(own.begin(), own.end());
  const auto corners = corners_of(scene, sided_triangle);
  for (const std::uint32_t each : view.group) {
    for (const glm::vec3& photon : photons_on(photons, each)) {
      if (geometry::squared_point_triangle_distance(glm::dvec3(photon), corners) <=
          photons.radius * photons.radius) {
        view.group_photons.push_back(photon);
      }
    }
  }
  return view;
}

}  // namespace photile::view
