#include "trace/sensor_hits.hpp"

#include <fmt/format.h>

#include <optional>

#include "photile/errors.hpp"
#include "trace/eye_path.hpp"
#include "trace/hit_batch.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors) {
  constexpr double reach = 1e-3;  // metres
  const Scene& scene = rays.scene();
  EyeRecord record;
  std::vector<HitPlace> places;
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
    append_hit(impl_of(rays), *point,
               {glm::vec3(sensor.position), down, glm::vec3(1.0f), static_cast<std::uint32_t>(i)},
               record);
    places.push_back({0, static_cast<std::uint32_t>(i)});
  }
  return hits_at({&record, 1}, places);
}

}  // namespace photile::trace
