#include "daylight/daylight_matrix.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "daylight/sky_lights.hpp"
#include "image/light_change.hpp"
#include "photile/light_groups.hpp"
#include "photile/quiet_progress.hpp"
#include "trace/distant_light.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/portals.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"

namespace photile::daylight {
namespace {

/// Of what is worth photons, that for the sky where there are lamps, too.
constexpr double sky_over_lamps = 4;
/// Of a patch that no window faces, against one that all face: light that comes in by reflection.
constexpr double least_facing = 0.03;
constexpr double sensor_clearance = 1e-4;  // metres
/// Rays to the whole sky that find what comes straight.
constexpr std::size_t straight_rays = 18'432;

struct SkyLight {
  std::uint32_t light;
  double flux;  ///< at 1 cd/m2
};

std::vector<SkyLight> sky_lights_of(const Scene& scene) {
  std::vector<SkyLight> found;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    if (scene.lights[i].is_sky_patch()) found.push_back({i, scene.lights[i].power});
  }
  return found;
}

/// Gives each patch a power by what its photons are worth; layers do not depend on it.
void set_worth(const std::vector<SkyLight>& sky, const std::vector<double>& mean_luminance,
               Scene& scene) {
  const trace::Portals portals(scene);
  std::vector<double> facing;
  double most = 0, lamps = 0, all = 0;
  for (const SkyLight& patch : sky) {
    const trace::DistantSampler sampler(scene, scene.lights[patch.light]);
    facing.push_back(portals.empty() ? 1.0 : trace::area_facing(portals, sampler));
    most = std::max(most, facing.back());
  }
  for (const Light& light : scene.lights) lamps += light.is_sky_patch() ? 0.0 : light.power;
  for (std::size_t i = 0; i < sky.size(); ++i) {
    const double shown = most > 0 ? facing[i] / most : 1.0;
    double& power = scene.lights[sky[i].light].power;
    power = sky[i].flux * (mean_luminance[i] + 1e-6) * (least_facing + shown);
    all += power;
  }
  if (!(lamps > 0)) return;
  for (const SkyLight& patch : sky) {
    scene.lights[patch.light].power *= sky_over_lamps * lamps / all;
  }
}

std::vector<Sensor> all_in_scene(const Scene& scene, std::span<const Sensor> sensors) {
  std::vector<Sensor> own;
  for (const Sensor& sensor : sensors) own.push_back(in_scene(scene, sensor));
  return own;
}

/// Adds the layers of one repeat to the sums.
void add_repeat(const LightLayers& layers, const std::vector<std::uint32_t>& patch_of_layer,
                const std::vector<double>& lux_of_layer, DaylightMatrix& sums,
                std::vector<float>& lamp_sums, const std::vector<std::uint32_t>& lamp_of_layer) {
  const auto add = [&](std::size_t sensor, std::size_t layer, const glm::vec3& radiance) {
    const auto lux = static_cast<float>(lux_of_layer[layer] * luminance(glm::dvec3(radiance)));
    if (patch_of_layer[layer] != none) {
      sums.from_sky[sensor * sums.patches + patch_of_layer[layer]] += lux;
    } else if (lamp_of_layer[layer] != none) {
      lamp_sums[lamp_of_layer[layer] * sums.sensors + sensor] += lux;
    }
  };
  for (std::size_t layer = 0; layer < layers.layers.size() && !layers.sparse(); ++layer) {
    for (std::size_t sensor = 0; sensor < sums.sensors; ++sensor)
      add(sensor, layer, layers.layers[layer].radiance[sensor]);
  }
  for (std::size_t sensor = 0; sensor < layers.rows.size(); ++sensor) {
    const LightLayers::Row& row = layers.rows[sensor];
    for (std::uint32_t i = row.first[0]; i < row.first[1]; ++i)
      add(sensor, row.light[i], row.radiance[i]);
  }
}

/// Lux for each cd/m2 that comes straight from each patch, by rays over its solid angle.
std::vector<float> straight_light(const Scene& scene, std::span<const Sensor> sensors,
                                  const std::vector<SkyLight>& sky) {
  const StraightLight straight(scene, sensors);
  const auto rays = static_cast<std::uint32_t>(
      std::max<std::size_t>(4, straight_rays / std::max<std::size_t>(1, sky.size())));
  std::vector<float> result(sensors.size() * sky.size(), 0.0f);
  tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t sensor) {
    const trace::FlushDenormals flush_denormals;
    for (std::size_t patch = 0; patch < sky.size(); ++patch) {
      const Light& light = scene.lights[sky[patch].light];
      const trace::DistantSampler sampler(scene, light);
      double sum = 0;
      for (std::uint32_t ray = 0; ray < rays; ++ray) {
        const trace::RandomBlock numbers =
            trace::RandomStream(0, sensor, static_cast<std::uint32_t>(patch))
                .block(trace::Purpose::sensor_light, ray);
        sum += straight.from(glm::dvec3(sampler.sample(numbers).direction), sensor);
      }
      result[sensor * sky.size() + patch] =
          static_cast<float>(sum / rays * trace::disc_solid_angle(light));
    }
  });
  return result;
}

}  // namespace

StraightLight::StraightLight(const Scene& scene, std::span<const Sensor> sensors)
    : rays_(scene), sensors_(all_in_scene(scene, sensors)) {
  const BoundingSphere bounds = bounding_sphere(scene);
  beyond_ = 2.5 * bounds.radius;
  for (Sensor& sensor : sensors_) {
    sensor.position += sensor_clearance * sensor.normal;
    beyond_ =
        std::max(beyond_, glm::distance(sensor.position, bounds.center) + 1.5 * bounds.radius);
  }
}

double StraightLight::from(const glm::dvec3& direction, std::size_t sensor) const {
  const Sensor& at = sensors_[sensor];
  const double cosine = glm::dot(direction, at.normal);
  if (!(cosine > 0)) return 0;
  const glm::vec3 passes = trace::transmittance(rays_, glm::vec3(at.position),
                                                glm::vec3(at.position + beyond_ * direction));
  return cosine * luminance(glm::dvec3(passes));
}

DaylightMatrix daylight_matrix(Scene scene, std::span<const Sensor> sensors, const LightMix& mix,
                               const std::vector<SkyPatch>& patches, std::span<Device> devices,
                               const MatrixParameters& parameters, Progress& progress) {
  const std::vector<SkyLight> sky = sky_lights_of(scene);
  set_worth(sky, parameters.mean_luminance, scene);
  DaylightMatrix matrix;
  matrix.sensors = sensors.size();
  matrix.patches = patches.size() + 1;
  matrix.from_sky.assign(matrix.sensors * matrix.patches, 0.0f);

  const LightGroups groups = light_groups_of(scene);
  std::vector<std::uint32_t> patch_of_layer(groups.groups.size(), none);
  std::vector<std::uint32_t> lamp_of_layer(groups.groups.size(), none);
  std::vector<double> lux_of_layer(groups.groups.size(), 0.0);
  for (std::uint32_t i = 0; i < sky.size(); ++i) {
    patch_of_layer[groups.group_of[sky[i].light]] = i;
    lux_of_layer[groups.group_of[sky[i].light]] = glm::pi<double>() * sky[i].flux;
  }
  for (std::uint32_t layer = 0; layer < groups.groups.size(); ++layer) {
    const LightGroup& group = groups.groups[layer];
    if (patch_of_layer[layer] != none || scene.lights[group.lights.front()].is_distant()) continue;
    lamp_of_layer[layer] = static_cast<std::uint32_t>(matrix.lamps.size());
    matrix.lamps.push_back(group.name);
    const MixedLight& lamp = mix.lights[image::index_of(mix, group.name)];
    const double lumens = lamp.unit == PowerUnit::lumen ? 1.0 : mix.lumen_per_watt;
    lux_of_layer[layer] = glm::pi<double>() * lamp.power * lumens;
  }
  matrix.from_lamps.assign(matrix.lamps.size() * matrix.sensors, 0.0f);

  const std::vector<Sensor> own = all_in_scene(scene, sensors);
  const int repeats = parameters.measuring.repeats;
  RenderParameters photons = parameters.measuring.photons;
  photons.photons.quota = PhotonQuota::power;
  QuietProgress quiet(progress);
  std::vector<double> sum(matrix.sensors, 0.0), squares(matrix.sensors, 0.0);
  progress.begin("trace the sky", static_cast<std::uint64_t>(repeats), "repeats");
  for (int repeat = 0; repeat < repeats; ++repeat) {
    photons.seed = trace::seed_of_repeat(parameters.measuring.photons.seed,
                                         static_cast<std::uint32_t>(repeat));
    const RenderResult result =
        gather(scene, own, parameters.measuring.gathering, devices, photons, quiet);
    photons.radius = result.used.radius;  // found once
    std::vector<float> before = matrix.from_sky;
    add_repeat(result.layers, patch_of_layer, lux_of_layer, matrix, matrix.from_lamps,
               lamp_of_layer);
    for (std::size_t sensor = 0; sensor < matrix.sensors; ++sensor) {
      double lux = 0;
      for (std::size_t patch = 0; patch < matrix.patches; ++patch) {
        const std::size_t at = sensor * matrix.patches + patch;
        lux += double{matrix.from_sky[at] - before[at]} * parameters.mean_luminance[patch];
      }
      sum[sensor] += lux;
      squares[sensor] += lux * lux;
    }
    progress.advance(1);
  }
  const auto scale = static_cast<float>(parameters.measuring.maintenance / repeats);
  for (float& lux : matrix.from_sky) lux *= scale;
  for (float& lux : matrix.from_lamps) lux *= scale;
  for (std::size_t sensor = 0; sensor < matrix.sensors; ++sensor) {
    const double mean = sum[sensor] / repeats;
    const double variance = std::max(0.0, squares[sensor] / repeats - mean * mean);
    const double error = repeats > 1 ? std::sqrt(variance / (repeats - 1)) : 0.0;
    matrix.relative_error.push_back(mean > 0 ? static_cast<float>(error / mean) : 0.0f);
  }
  progress.end();
  if (parameters.straight) {
    matrix.straight = straight_light(scene, sensors, sky);
    for (float& lux : matrix.straight) lux *= static_cast<float>(parameters.measuring.maintenance);
  }
  return matrix;
}

}  // namespace photile::daylight
