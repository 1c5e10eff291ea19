// Irradiance gathered at sensors.
#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "cache/irradiance_gather.hpp"
#include "gathering_photons.hpp"
#include "photile/sensors.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "trace/sensors.hpp"

namespace photile::test {

inline RenderParameters looked_up(std::uint64_t photons, std::uint64_t seed = 1) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons;
  parameters.seed = seed;
  parameters.neighbours = 100;
  return parameters;
}

inline std::vector<std::uint64_t> numbers(std::size_t count) {
  std::vector<std::uint64_t> result(count);
  std::iota(result.begin(), result.end(), std::uint64_t{0});
  return result;
}

/// A closed cube of one metre whose walls all emit and reflect, the same everywhere.
inline Scene furnace(const Material& wall) {
  SceneBuilder builder("furnace");
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(wall), true, 1,
              builder.add(area_light("walls")));
  return builder.build();
}

/// A scene with its photons, on the device of the tests.
class GatheringScene {
 public:
  GatheringScene(Scene taken, const RenderParameters& parameters)
      : scene(std::move(taken)), rays(scene), estimators(rays, {&device(), 1}, parameters) {}

  cache::IrradianceGather gather(const cache::IrradianceGatherParameters& parameters) {
    return estimators.gather(parameters);
  }
  LightTable at(const std::vector<Sensor>& sensors,
                const cache::IrradianceGatherParameters& parameters = {}) {
    return gather(parameters).gather(trace::sensor_hits(rays, sensors), numbers(sensors.size()));
  }

  const Scene scene;
  RayScene rays;
  GatheringPhotons estimators;
};

/// count x count points of a parallelogram, none on its border.
inline std::vector<Sensor> sensors_on(const glm::dvec3& origin, const glm::dvec3& u,
                                      const glm::dvec3& v, const glm::dvec3& normal, int count) {
  std::vector<Sensor> sensors;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) {
      sensors.push_back({origin + (i + 0.43) / count * u + (j + 0.57) / count * v, normal});
    }
  return sensors;
}

}  // namespace photile::test
