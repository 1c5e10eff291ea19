#include "measuring/measure_grids.hpp"

#include <algorithm>
#include <string>

#include "photile/light_layers.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/portal_search.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"

namespace photile::measuring {
namespace {

/// Sensors of all grids, in the scene's own coordinates.
std::vector<Sensor> sensors_of(const Scene& scene, std::span<const SensorGrid> grids) {
  std::vector<Sensor> sensors;
  for (const SensorGrid& grid : grids) {
    for (const Sensor& sensor : grid.sensors) {
      sensors.push_back(in_scene(scene, sensor));
    }
  }
  return sensors;
}

std::vector<std::string> layer_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const LightGroup& group : light_groups_of(scene).groups) names.push_back(group.name);
  return names;
}

}  // namespace

Readings measure_grids(const Scene& scene, std::span<const SensorGrid> grids, const LightMix& mix,
                       std::span<Device> devices, const MeasuringParameters& parameters,
                       Progress& progress) {
  const std::vector<Sensor> sensors = sensors_of(scene, grids);
  Readings readings(layer_names(scene), sensors.size());
  RenderParameters photons = parameters.photons;
  QuietProgress quiet(progress);
  progress.begin("measure", static_cast<std::uint64_t>(parameters.repeats), "repeats");
  for (int repeat = 0; repeat < parameters.repeats; ++repeat) {
    const std::uint64_t seed =
        trace::seed_of_repeat(parameters.photons.seed, static_cast<std::uint32_t>(repeat));
    photons.seed = seed;
    if (parameters.by_paths) {
      const auto result = gather_by_paths(scene, sensors, parameters.gathering, seed, quiet);
      readings.add(result.layers, mix, parameters.maintenance);
    } else {
      const auto result = gather(scene, sensors, parameters.gathering, devices, photons, quiet);
      photons.radius = result.used.radius;  // found once
      readings.add(result.layers, mix, parameters.maintenance);
    }
    progress.advance(1);
  }
  progress.end();
  return readings;
}

std::vector<Portal> portals_of_grids(const Scene& scene, std::span<const SensorGrid> grids,
                                     std::span<const std::string> asked) {
  constexpr double above = 0.01;  // metres: a sensor may lie on a surface
  const bool lit_from_beyond = std::any_of(scene.lights.begin(), scene.lights.end(),
                                           [](const Light& light) { return light.is_distant(); });
  if (!lit_from_beyond) return {};
  std::vector<glm::dvec3> points;
  for (const Sensor& sensor : sensors_of(scene, grids))
    points.push_back(sensor.position + above * sensor.normal);
  return trace::portals_asked_for(scene, asked, points);
}

std::size_t covered_sensors(const Scene& scene, std::span<const SensorGrid> grids) {
  constexpr double near = 0.01;  // metres
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const std::vector<Sensor> sensors = sensors_of(scene, grids);
  return static_cast<std::size_t>(
      std::count_if(sensors.begin(), sensors.end(), [&](const Sensor& sensor) {
        return trace::occluded(rays, glm::vec3(sensor.position + 1e-4 * sensor.normal),
                               glm::vec3(sensor.position + near * sensor.normal));
      }));
}

}  // namespace photile::measuring
