#include "measuring/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "image/light_change.hpp"
#include "image/light_layers.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "trace/portal_search.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"

namespace photile::measuring {

namespace {

/// Which sensors the figures of a grid are about.
struct Extremes {
  std::size_t darkest, brightest;

  static Extremes of(std::span<const double> values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {static_cast<std::size_t>(low - values.begin()),
            static_cast<std::size_t>(high - values.begin())};
  }
};

/// The figures of one set of values.
struct Figures {
  double mean = 0, minimum, maximum;

  Figures(std::span<const double> values, const Extremes& extremes)
      : minimum(values[extremes.darkest]), maximum(values[extremes.brightest]) {
    for (const double value : values) mean += value;
    mean /= static_cast<double>(values.size());
  }
  // A dark grid is uniform in no useful sense.
  double uniformity() const { return mean > 0 ? minimum / mean : 0; }
  double diversity() const { return maximum > 0 ? minimum / maximum : 0; }
};

/// Spread of the values of leaving one repeat out each, scaled to that of the whole.
template <class Of>
double jackknife_error(std::span<const Figures> without, const Of& of) {
  const auto count = static_cast<double>(without.size());
  double mean = 0, squares = 0;
  for (const Figures& each : without) mean += of(each) / count;
  for (const Figures& each : without) squares += std::pow(of(each) - mean, 2);
  return std::sqrt((count - 1) / count * squares);
}

}  // namespace

std::vector<Measured> means_of(std::span<const std::vector<float>> repeats) {
  const auto count = static_cast<double>(repeats.size());
  std::vector<Measured> result(repeats.front().size());
  for (std::size_t sensor = 0; sensor < result.size(); ++sensor) {
    double mean = 0, squares = 0;
    for (const auto& repeat : repeats) mean += static_cast<double>(repeat[sensor]) / count;
    for (const auto& repeat : repeats) {
      squares += std::pow(static_cast<double>(repeat[sensor]) - mean, 2);
    }
    result[sensor] = {mean, std::sqrt(squares / (count - 1) / count)};
  }
  return result;
}

GridStatistics statistics_of(std::span<const std::vector<float>> repeats, std::size_t first,
                             std::size_t count) {
  const auto number = static_cast<double>(repeats.size());
  std::vector<double> sums(count);
  for (const auto& repeat : repeats) {
    for (std::size_t i = 0; i < count; ++i) sums[i] += static_cast<double>(repeat[first + i]);
  }
  std::vector<double> means(sums);
  for (double& mean : means) mean /= number;
  const Extremes extremes = Extremes::of(means);
  const Figures all(means, extremes);

  GridStatistics result;
  std::vector<Figures> without;
  std::vector<double> others(count);
  for (const auto& repeat : repeats) {
    for (std::size_t i = 0; i < count; ++i) {
      others[i] = (sums[i] - static_cast<double>(repeat[first + i])) / (number - 1);
    }
    without.emplace_back(others, extremes);
    const Extremes seen = Extremes::of(others);
    result.minimum_at_most += static_cast<double>(repeat[first + seen.darkest]) / number;
    result.maximum_at_least += static_cast<double>(repeat[first + seen.brightest]) / number;
  }
  const auto measured = [&](auto of) { return Measured{of(all), jackknife_error(without, of)}; };
  result.mean = measured([](const Figures& f) { return f.mean; });
  result.minimum = measured([](const Figures& f) { return f.minimum; });
  result.maximum = measured([](const Figures& f) { return f.maximum; });
  result.uniformity = measured([](const Figures& f) { return f.uniformity(); });
  result.diversity = measured([](const Figures& f) { return f.diversity(); });
  return result;
}

Measurement measurement_of(std::vector<SensorGrid> grids, const Readings& readings) {
  const std::size_t lights = readings.lights().size();
  Measurement result;
  for (SensorGrid& grid : grids) result.push_back({std::move(grid), {}});
  for (std::size_t i = 0; i == 0 || (lights > 1 && i <= lights); ++i) {
    const std::vector<std::vector<float>> repeats = readings.repeats_of(i);
    const std::vector<Measured> means = means_of(repeats);
    std::size_t first = 0;
    for (GridValues& values : result) {
      const std::size_t count = values.grid.sensors.size();
      const auto begin = means.begin() + static_cast<std::ptrdiff_t>(first);
      values.lights.push_back({readings.name_of(i),
                               {begin, begin + static_cast<std::ptrdiff_t>(count)},
                               statistics_of(repeats, first, count)});
      first += count;
    }
  }
  return result;
}

void mark_dark_points(Measurement& measurement) {
  const auto is_dark = [](const Measured& measured) { return measured.value == 0; };
  const bool any_light = std::ranges::any_of(measurement, [&](const GridValues& grid) {
    const auto& sensors = grid.total().sensors;
    return !std::ranges::all_of(sensors, is_dark);
  });
  if (!any_light) return;
  for (GridValues& values : measurement) {
    const auto& sensors = values.total().sensors;
    values.grid.marks.resize(sensors.size());
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      if (is_dark(sensors[i]) && values.grid.marks[i].empty()) values.grid.marks[i] = "no light";
    }
  }
}

std::vector<std::string> doubts_of(const Measurement& measurement,
                                   std::span<const MixedLight> lights) {
  std::size_t points = 0, dark = 0;
  std::vector<std::string> lines;
  for (const GridValues& grid : measurement) {
    const auto& sensors = grid.total().sensors;
    points += sensors.size();
    dark += static_cast<std::size_t>(
        std::ranges::count_if(sensors, [](const Measured& m) { return m.value == 0; }));
  }
  const bool any_on =
      std::ranges::any_of(lights, [](const MixedLight& light) { return light.power > 0; });
  if (dark > 0 && dark < points) {
    lines.push_back(fmt::format(
        "{} of {} points have no light at all; they may lie outside the room or inside objects",
        dark, points));
  } else if (dark > 0) {
    lines.push_back(fmt::format("none of the {} points has any light: {}", points,
                                any_on ? "they may lie outside the room or inside objects, or "
                                         "differ from the scene in unit or up axis"
                                       : "all lights are off"));
  }
  std::vector<bool> reaches;
  for (const MixedLight& light : lights) {
    reaches.push_back(std::ranges::any_of(measurement, [&](const GridValues& grid) {
      return std::ranges::any_of(grid.lights, [&](const LightValues& values) {
        // With one light alone its values are those of all together.
        return (values.light == light.name || grid.lights.size() == 1) &&
               std::ranges::any_of(values.sensors, [](const Measured& m) { return m.value > 0; });
      });
    }));
  }
  for (std::string& line : lights_that_reach_nothing(lights, reaches, "point")) {
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> lights_that_reach_nothing(std::span<const MixedLight> lights,
                                                   const std::vector<bool>& reaches,
                                                   const std::string& what) {
  constexpr std::size_t most_named = 10;
  std::vector<std::string> lines;
  std::size_t skies = 0, dark_skies = 0, unnamed = 0;
  const auto is_sky = [](const MixedLight& light) {
    return light.name == "sky" || light.name.starts_with("sky_");
  };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!is_sky(lights[i]) || !(lights[i].power > 0)) continue;
    ++skies;
    dark_skies += reaches[i] ? 0 : 1;
  }
  const bool no_sky = skies > 0 && dark_skies == skies;
  if (no_sky) {
    lines.push_back(fmt::format("no skylight reaches any {}: {}", what, closed_to_the_sky));
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const MixedLight& light = lights[i];
    const bool sun = light.name == "sun";
    const bool told = light.name == "ground" || is_sky(light) || (sun && no_sky);
    if (told || reaches[i] || !(light.power > 0)) continue;
    if (lines.size() == most_named) {
      ++unnamed;
      continue;
    }
    lines.push_back(fmt::format("light '{}' reaches no {}; {}", light.name, what,
                                sun ? "it may shine on another side of the building"
                                    : "it may hang outside the room, or above a closed ceiling"));
  }
  if (unnamed > 0) lines.push_back(fmt::format("{} more lights reach no {}", unnamed, what));
  return lines;
}

void Readings::add(const LightLayers& layers, const LightMix& mix, double factor) {
  const LightLayers dense = layers.sparse() ? layers.dense() : layers;
  auto& repeat = repeats_.emplace_back();
  for (const LightLayers::Layer& layer : dense.layers) {
    const MixedLight& light = mix.lights[image::index_of(mix, layer.light)];
    const glm::dvec3 scale =
        factor * glm::pi<double>() * mix.lumens_of(light) * glm::dvec3(light.tint);
    std::vector<float>& values = repeat.emplace_back(sensors_);
    std::size_t lost = 0;
    for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
      values[sensor] = static_cast<float>(luminance(scale * glm::dvec3(layer.radiance[sensor])));
      lost += std::isfinite(values[sensor]) ? 0 : 1;
    }
    if (lost > 0) {
      throw InputError(fmt::format(
          "light '{}': lux at {} of {} points are infinite or not numbers; reduce its power",
          layer.light, lost, sensors_));
    }
  }
}

std::vector<float> Readings::total(std::size_t repeat) const {
  std::vector<double> sums(sensors_);
  for (const auto& light : repeats_[repeat]) {
    for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
      sums[sensor] += static_cast<double>(light[sensor]);
    }
  }
  return {sums.begin(), sums.end()};
}

std::vector<std::vector<float>> Readings::repeats_of(std::size_t i) const {
  std::vector<std::vector<float>> repeats;
  for (std::size_t r = 0; r < repeats_.size(); ++r) {
    repeats.push_back(i == 0 ? total(r) : repeats_[r][i - 1]);
  }
  return repeats;
}

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

}  // namespace

Readings measure_grids(const Scene& scene, std::span<const SensorGrid> grids, const LightMix& mix,
                       std::span<Device> devices, const MeasuringParameters& parameters,
                       Progress& progress) {
  const std::vector<Sensor> sensors = sensors_of(scene, grids);
  Readings readings(image::layer_names(scene), sensors.size());
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

Readings measure_maintained(const Scene& scene, std::span<const SensorGrid> grids,
                            const LightMix& mix, std::span<Device> devices,
                            const MeasuringParameters& parameters, Progress& progress) {
  const bool any = std::ranges::any_of(
      scene.distributions, [](const auto& lamp) { return lamp.data().maintenance > 0; });
  if (!any) return measure_grids(scene, grids, mix, devices, parameters, progress);
  Scene aged = scene;
  LightMix aged_mix = mix;
  const LightGroups groups = light_groups_of(scene);
  std::vector<double> left(mix.lights.size());  // of the power of each group
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::uint32_t file = scene.lights[i].distribution;
    const double own = file == none ? 0 : scene.distributions[file].data().maintenance;
    const double factor = own > 0 ? own / parameters.maintenance : 1;
    aged.lights[i].power *= factor;
    left[groups.group_of[i]] += factor * groups.fraction[i];
  }
  for (std::size_t i = 0; i < left.size(); ++i) aged_mix.lights[i].power *= left[i];
  return measure_grids(aged, grids, aged_mix, devices, parameters, progress);
}

std::vector<Portal> portals_of_grids(const Scene& scene, std::span<const SensorGrid> grids,
                                     std::span<const std::string> asked) {
  constexpr double above = 0.01;  // metres: a sensor may lie on a surface
  const bool lit_from_beyond =
      std::ranges::any_of(scene.lights, [](const Light& light) { return light.is_distant(); });
  if (!lit_from_beyond) return {};
  std::vector<glm::dvec3> points;
  for (const Sensor& sensor : sensors_of(scene, grids))
    points.push_back(sensor.position + above * sensor.normal);
  return trace::portals_asked_for(scene, asked, points);
}

void remove_reflections(Scene& scene) {
  for (Material& material : scene.materials) {
    if (material.interaction == Interaction::glass) continue;
    material.interaction = Interaction::opaque;
    material.diffuse = material.specular = glm::vec3(0.0f);
    material.metallic_roughness = none;
  }
}

std::vector<std::string> doubts_of(const Scene& scene, std::span<const SensorGrid> grids) {
  constexpr double near = 0.01;  // metres
  std::vector<std::string> lines;
  if (has_hidden_caustics(scene)) {
    lines.emplace_back(
        "light of point, spot and directional lights that mirrors and glass cast onto sensors is "
        "missing; that of area lights is included");
  }
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const std::vector<Sensor> sensors = sensors_of(scene, grids);
  const auto covered = std::ranges::count_if(sensors, [&](const Sensor& sensor) {
    return trace::occluded(rays, glm::vec3(sensor.position + 1e-4 * sensor.normal),
                           glm::vec3(sensor.position + near * sensor.normal));
  });
  if (covered > 0) {
    lines.push_back(
        fmt::format("{} points have a surface less than 1 cm in front of them; they may lie in "
                    "furniture or just below a table top",
                    covered));
  }
  return lines;
}

}  // namespace photile::measuring

namespace photile {

std::vector<LightIlluminance> measure_illuminance(const Scene& scene,
                                                  std::span<const Sensor> sensors,
                                                  const LightMix& mix, std::span<Device> devices,
                                                  const MeasuringParameters& parameters,
                                                  Progress& progress) {
  if (parameters.repeats < 2 || parameters.repeats > limits::max_repeats) {
    throw UsageError(fmt::format("repeats: '{}' is not a whole number from 2 to {}",
                                 parameters.repeats, limits::max_repeats));
  }
  if (!(parameters.maintenance > 0 && parameters.maintenance <= 1)) {
    throw UsageError(fmt::format("maintenance: '{}' is not a number above 0, at most 1",
                                 parameters.maintenance));
  }
  const std::vector<measuring::SensorGrid> grids{
      {"points", {sensors.begin(), sensors.end()}, std::nullopt}};
  const measuring::Readings readings =
      measuring::measure_maintained(scene, grids, mix, devices, parameters, progress);
  std::vector<LightIlluminance> result;
  for (std::size_t i = 0; i <= readings.lights().size(); ++i) {
    result.push_back({readings.name_of(i), measuring::means_of(readings.repeats_of(i))});
  }
  return result;
}

}  // namespace photile
