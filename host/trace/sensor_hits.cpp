#include "trace/sensor_hits.hpp"

#include <fmt/format.h>

#include <optional>

#include "photile/errors.hpp"
#include "trace/eye_path.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors) {
  constexpr double reach = 1e-3;  // metres
  const Scene& scene = rays.scene();
  const bool glossy = rays.needs().glossy;
  PrimaryHits hits;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Sensor& sensor = sensors[i];
    const glm::vec3 down(-sensor.normal);
    const auto hit = intersect(rays, glm::vec3(sensor.position + reach * sensor.normal), down);
    const auto point = hit ? std::optional(surface_hit(scene, *hit, down)) : std::nullopt;
    if (!point || glm::length(glm::dvec3(point->position) - sensor.position) > reach ||
        material_of(scene, *point).interaction != Interaction::opaque) {
      throw InputError(fmt::format(
          "{}: no opaque surface within {} m of the sensor at ({}, {}, {})", scene.source.string(),
          reach, sensor.position.x, sensor.position.y, sensor.position.z));
    }
    const EyeHit eye = eye_hit(scene, *point, down, static_cast<std::uint32_t>(i), glm::vec3(1.0f));
    hits.position.push_back(eye.position);
    hits.sided_triangle.push_back(eye.sided_triangle);
    hits.pixel.push_back(eye.pixel);
    hits.throughput.push_back(eye.throughput);
    hits.diffuse_albedo.push_back(eye.diffuse_albedo);
    if (glossy) {
      hits.outgoing.push_back(eye.outgoing);
      hits.lobe.push_back(eye.lobe);
    }
  }
  return hits;
}

}  // namespace photile::trace
