#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <string>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/sensors.hpp"
#include "render/hit_source.hpp"
#include "trace/sensors.hpp"

namespace photile {
namespace {

Film film_of(std::span<const Sensor> sensors, const GatherParameters& gathering) {
  if (gathering.rays < 1 || gathering.rays > limits::max_samples_per_pixel) {
    throw UsageError("rays: " + std::to_string(gathering.rays) + " is not between 1 and " +
                     std::to_string(limits::max_samples_per_pixel));
  }
  if (sensors.empty() || sensors.size() > limits::max_sensors) {
    throw UsageError("sensors: " + std::to_string(sensors.size()) + " is not between 1 and " +
                     std::to_string(limits::max_sensors));
  }
  return {1, static_cast<int>(sensors.size()), gathering.rays};
}

/// What the film has gathered as illuminance is that of the surfaces seen: replaces it by the
/// sensors' own.
LightLayers with_own_illuminance(LightLayers layers) {
  const auto own = [](const glm::vec3& radiance) {
    return static_cast<float>(glm::pi<double>() * luminance(glm::dvec3(radiance)));
  };
  for (LightLayers::Layer& layer : layers.layers) {
    std::transform(layer.radiance.begin(), layer.radiance.end(), layer.illuminance.begin(), own);
  }
  for (LightLayers::Row& row : layers.rows) {
    std::transform(row.radiance.begin(), row.radiance.end(), row.illuminance.begin(), own);
  }
  return layers;
}

}  // namespace

PrimaryHitBatch GatherHits::trace(const RayScene& rays, const PrimaryHitParameters& film,
                                  int first_row, int last_row,
                                  std::span<const std::uint32_t> map_of) const {
  return trace::gather_rays(rays, sensors_, response_, lamps_, film, first_row, last_row, map_of);
}

RenderResult gather(const Scene& scene, std::span<const Sensor> sensors,
                    const GatherParameters& gathering, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  RenderResult result = render_hits(scene, GatherHits(scene, sensors, gathering.response),
                                    film_of(sensors, gathering), devices, parameters, progress);
  result.layers = with_own_illuminance(std::move(result.layers));
  return result;
}

PathTracerResult gather_by_paths(const Scene& scene, std::span<const Sensor> sensors,
                                 const GatherParameters& gathering, std::uint64_t seed,
                                 Progress& progress) {
  PathTracerResult result =
      trace_paths_of_hits(scene, GatherHits(scene, sensors, gathering.response),
                          eye_rays({.seed = seed, .film = film_of(sensors, gathering)}), progress);
  result.layers = with_own_illuminance(std::move(result.layers));
  return result;
}

}  // namespace photile
