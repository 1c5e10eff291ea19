// Irradiance and reflected radiance at a point by the path tracer, one value for each seed.
#pragma once

#include <vector>

#include "photile/ray_scene.hpp"
#include "render/path_estimate.hpp"
#include "statistical_tests.hpp"
#include "trace/sensors.hpp"

namespace photile::test {

/// Luminance per light, its layer at power 1.
struct PathMeans {
  std::vector<double> irradiance, radiance;
};

/// Means over `paths` paths from every sensor together.
inline PathMeans path_means(const Scene& scene, const std::vector<Sensor>& sensors,
                            std::uint64_t seed, std::size_t paths) {
  const RayScene rays(scene);
  std::vector<Sensor> repeated;
  for (std::size_t i = 0; i < paths; ++i) {
    repeated.insert(repeated.end(), sensors.begin(), sensors.end());
  }
  std::vector<std::uint64_t> number(repeated.size());
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = i;
  const LightTable estimates =
      PathEstimator(rays, seed).estimate(trace::sensor_hits(rays, repeated), number);
  const std::size_t lights = needs_of(scene).light_count;
  PathMeans means{std::vector<double>(lights), std::vector<double>(lights)};
  for (std::size_t i = 0; i < estimates.irradiance.size(); ++i) {
    const double weight = 1.0 / static_cast<double>(repeated.size());
    means.irradiance[i % lights] += weight * luminance(estimates.irradiance[i]);
    if (!estimates.radiance.empty()) {
      means.radiance[i % lights] += weight * luminance(estimates.radiance[i]);
    }
  }
  return means;
}

/// The irradiance of the only light for seeds 1 to 16.
inline std::vector<double> path_irradiances(const Scene& scene, const std::vector<Sensor>& sensors,
                                            std::size_t paths) {
  return of_seeds(
      [&](std::uint64_t seed) { return path_means(scene, sensors, seed, paths).irradiance.at(0); });
}

}  // namespace photile::test
