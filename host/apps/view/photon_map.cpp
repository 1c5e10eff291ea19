#include "view/photon_map.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geometry/triangle_distance.hpp"
#include "trace/ray_query.hpp"

namespace photile::view {

namespace {

std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t oriented_face) {
  const auto corners = scene.corners(triangle_of(oriented_face));
  return {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
}

/// Whether the boxes of two triangles are at most `radius` apart: cheap, and true wherever the
/// triangles are.
bool boxes_within(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b,
                  double radius) {
  const glm::dvec3 gap =
      glm::max(glm::min(glm::min(a[0], a[1]), a[2]) - glm::max(glm::max(b[0], b[1]), b[2]),
               glm::min(glm::min(b[0], b[1]), b[2]) - glm::max(glm::max(a[0], a[1]), a[2]));
  return std::max({gap.x, gap.y, gap.z}) <= radius;
}

std::vector<std::uint32_t> group_of(const Scene& scene, const InspectablePhotons& photons,
                                    std::uint32_t oriented_face) {
  if (!std::isfinite(photons.radius)) return {};
  const double cos_angle = std::cos(glm::radians(photons.angle_degrees));
  const auto own = corners_of(scene, oriented_face);
  const glm::dvec3 normal = face_normal(scene, oriented_face);
  std::vector<std::uint8_t> near(2 * scene.triangle_count(), 0);
  tbb::parallel_for(std::size_t{0}, scene.triangle_count(), [&](std::size_t triangle) {
    const auto first = oriented(static_cast<std::uint32_t>(triangle), 0);
    const auto other = corners_of(scene, first);
    if (!boxes_within(own, other, photons.radius)) return;
    if (triangle_triangle_distance(own, other) > photons.radius) return;
    for (const std::uint32_t each : {first, first + 1}) {
      near[each] = normals_agree(normal, face_normal(scene, each), cos_angle) ? 1 : 0;
    }
  });
  near[oriented_face] = 0;
  std::vector<std::uint32_t> group;
  for (std::uint32_t each = 0; each < near.size(); ++each) {
    if (near[each]) group.push_back(each);
  }
  return group;
}

std::span<const glm::vec3> photons_on(const InspectablePhotons& photons,
                                      std::uint32_t oriented_face) {
  return std::span(photons.position)
      .subspan(photons.first_of[oriented_face],
               photons.first_of[oriented_face + 1] - photons.first_of[oriented_face]);
}

}  // namespace

InspectablePhotons InspectablePhotons::of(const TracedPhotons& photons) {
  return {photons.photons.position, photons.photons.first_of, photons.groups.patches,
          photons.groups.radius, photons.groups.angle_degrees};
}

PhotonMapView view_of_map(const Scene& scene, const InspectablePhotons& photons,
                          std::uint32_t oriented_face) {
  PhotonMapView view;
  view.oriented_face = oriented_face;
  view.group = group_of(scene, photons, oriented_face);
  const std::vector<std::uint32_t>& map_of = photons.patches.map_of;
  for (std::uint32_t each = 0; each < map_of.size(); ++each) {
    if (each == oriented_face || map_of[each] != map_of[oriented_face]) continue;
    if (!std::binary_search(view.group.begin(), view.group.end(), each)) view.patch.push_back(each);
  }
  const auto own = photons_on(photons, oriented_face);
  view.own_photons.assign(own.begin(), own.end());
  const auto corners = corners_of(scene, oriented_face);
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

std::uint32_t face_along(const RayScene& rays, const glm::dvec3& from,
                         const glm::dvec3& direction) {
  const trace::FlushDenormals flush_denormals;
  const auto hit = trace::intersect(rays, glm::vec3(from), glm::vec3(direction));
  if (!hit) return none;
  const bool faces = glm::dot(face_normal(rays.scene(), oriented(hit->triangle, 0)), direction) < 0;
  return oriented(hit->triangle, faces ? 0 : 1);
}

}  // namespace photile::view
