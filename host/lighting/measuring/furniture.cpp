#include "measuring/furniture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <utility>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/ray_query.hpp"

namespace photile::measuring {
namespace {

/// Surfaces this near to one another count as one crossing: sheets that lie on each other.
constexpr double beyond_hit = 1e-4;  // metres
constexpr int most_crossings = 1000;
constexpr double off_surface = 1e-3;  // metres

glm::dvec3 place_of(const Scene& scene, const trace::TriangleHit& hit) {
  const auto corners = scene.corners(hit.triangle);
  const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
  return (1 - u - v) * glm::dvec3(corners[0]) + u * glm::dvec3(corners[1]) +
         v * glm::dvec3(corners[2]);
}

/// Number of surfaces on a ray.
int crossings(const RayScene& rays, glm::dvec3 from, const glm::dvec3& direction) {
  int count = 0;
  for (; count < most_crossings; ++count) {
    const auto hit = trace::intersect(rays, glm::vec3(from), glm::vec3(direction));
    if (!hit) break;
    from = place_of(rays.scene(), *hit) + beyond_hit * direction;
  }
  return count;
}

/// Of each of six rays, along and across the sensor's direction, whether it crosses an odd number
/// of surfaces.
using Parities = std::bitset<6>;
constexpr std::size_t rays_turned_inside = 5;

Parities parities_at(const RayScene& rays, const Sensor& sensor) {
  const glm::dvec3& n = sensor.normal;
  const glm::dvec3 hint = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 across = glm::normalize(glm::cross(n, hint));
  const std::array axes{n, across, glm::cross(n, across)};
  Parities odd;
  for (std::size_t ray = 0; ray < odd.size(); ++ray) {
    const double sign = ray % 2 == 0 ? 1 : -1;
    odd[ray] = crossings(rays, sensor.position, sign * axes[ray / 2]) % 2 == 1;
  }
  return odd;
}

Parities usual_parities(const std::vector<Parities>& all) {
  Parities usual;
  for (std::size_t ray = 0; ray < usual.size(); ++ray) {
    const auto odd = std::count_if(all.begin(), all.end(),
                                   [&](const Parities& parities) { return parities[ray]; });
    usual[ray] = 2 * static_cast<std::size_t>(odd) > all.size();
  }
  return usual;
}

bool has_surface_near(const RayScene& rays, const Sensor& sensor, double clearance, bool on_wall) {
  if (!(clearance > 0)) return false;
  const glm::dvec3 reach = clearance * sensor.normal;
  return trace::occluded(rays, glm::vec3(sensor.position - (on_wall ? 0.0 : 1.0) * reach),
                         glm::vec3(sensor.position + reach));
}

}  // namespace

std::size_t leave_out_furniture(const Scene& scene, double clearance, SensorGrid& grid) {
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const bool on_wall = grid.role == GridRole::wall || grid.role == GridRole::ceiling;
  std::vector<Parities> parities;
  std::vector<bool> near;
  for (const Sensor& sensor : grid.sensors) {
    const Sensor there = in_scene(scene, sensor);
    // Rays along a surface that the sensor lies on would meet its edges by chance.
    parities.push_back(
        parities_at(rays, {there.position + off_surface * there.normal, there.normal}));
    near.push_back(has_surface_near(rays, there, clearance, on_wall));
  }
  const Parities usual = usual_parities(parities);
  std::vector<Sensor> sensors;
  std::vector<std::uint32_t> cells;
  for (std::size_t i = 0; i < grid.sensors.size(); ++i) {
    const bool inside = (parities[i] ^ usual).count() >= rays_turned_inside;
    if (near[i] || inside) {
      grid.blanks.push_back({grid.sensors[i],
                             inside ? "inside a solid or beyond the walls"
                                    : fmt::format("less than {} m from a surface", clearance),
                             sensors.size()});
      continue;
    }
    sensors.push_back(grid.sensors[i]);
    if (grid.layout) cells.push_back(grid.layout->cells[i]);
  }
  const std::size_t left_out = grid.sensors.size() - sensors.size();
  grid.sensors = std::move(sensors);
  if (grid.layout) grid.layout->cells = std::move(cells);
  return left_out;
}

}  // namespace photile::measuring
