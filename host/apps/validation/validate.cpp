#include "validation/validate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "photile/limits.hpp"
#include "photile/sensors.hpp"
#include "trace/random_stream.hpp"

namespace photile::validation {
namespace {

/// The readings' values from a film whose pixels are all their sensors, one after the other.
std::vector<double> readings_of(const AnalyticCase& analytic, const LightLayers& layers) {
  const LightLayers::Layer& layer = layers.layers.at(0);
  const double power = analytic.scene.lights[0].power;
  std::vector<double> values;
  std::size_t pixel = 0;
  for (const Reading& reading : analytic.readings) {
    double sum = 0;
    for (std::size_t i = 0; i < reading.sensors.size(); ++i, ++pixel) {
      sum += reading.quantity == Quantity::luminance
                 ? luminance(glm::dvec3(layer.radiance[pixel]))
                 : static_cast<double>(layer.illuminance[pixel]);
    }
    values.push_back(power * sum / static_cast<double>(reading.sensors.size()));
  }
  return values;
}

/// Measures with seeds that follow from one, until they tell whether all readings are within the
/// tolerance; `layers` gives the film for a seed.
template <class Layers>
std::vector<Measured> over_seeds(const AnalyticCase& analytic, std::uint64_t seed, int most,
                                 const Layers& layers) {
  std::vector<std::vector<double>> values(analytic.readings.size());
  std::vector<Measured> result(values.size());
  for (int done = 0, wanted = fewest_seeds; done < wanted;) {
    for (; done < wanted; ++done) {
      const std::vector<double> read = readings_of(
          analytic, layers(trace::seed_of_repeat(seed, static_cast<std::uint32_t>(done))));
      for (std::size_t r = 0; r < read.size(); ++r) values[r].push_back(read[r]);
    }
    for (std::size_t r = 0; r < values.size(); ++r) {
      result[r] = measured(values[r], analytic.readings[r].expected);
    }
    wanted = std::min(seeds_to_tell(result), most);
  }
  return result;
}

}  // namespace

double student_t_99(int freedom) {
  constexpr double z = 2.5758293035489004, z2 = z * z;  // of a normal deviate
  const double n = 4.0 * freedom;
  return z * (1 + (z2 + 1) / n + ((5 * z2 + 16) * z2 + 3) / (6 * n * n) +
              (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (6 * n * n * n) +
              ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / (360 * n * n * n * n));
}

Measured measured(std::span<const double> values, double expected) {
  const auto count = static_cast<double>(values.size());
  Measured result;
  result.value = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += std::pow(value - result.value, 2);
  result.error = result.value / expected - 1;
  result.seeds = static_cast<int>(values.size());
  result.noise =
      student_t_99(result.seeds - 1) * std::sqrt(squares / (count - 1) / count) / expected;
  result.verdict = std::abs(result.error) + result.noise <= tolerance  ? Verdict::within
                   : std::abs(result.error) - result.noise > tolerance ? Verdict::misses
                                                                       : Verdict::too_noisy;
  return result;
}

int seeds_to_tell(std::span<const Measured> readings) {
  double wanted = 0;
  for (const Measured& reading : readings) {
    if (reading.verdict != Verdict::too_noisy) continue;
    // The noise falls as the square root of the seeds, down to what the error leaves of the
    // tolerance, or exceeds it by. A tenth more, since the error changes, too.
    const double room = std::abs(tolerance - std::abs(reading.error));
    const double times = std::clamp(1.1 * std::pow(reading.noise / room, 2), 1.1, 2.0);
    wanted = std::max(wanted, std::ceil(times * reading.seeds));
  }
  return static_cast<int>(wanted);
}

std::vector<ValidationRow> validate(const AnalyticCase& analytic, std::span<Device> devices,
                                    const ValidationParameters& parameters, Progress& progress) {
  std::vector<Sensor> sensors;
  std::vector<ValidationRow> rows;
  for (const Reading& reading : analytic.readings) {
    sensors.insert(sensors.end(), reading.sensors.begin(), reading.sensors.end());
    rows.push_back({analytic.name, analytic.source, reading.place, reading.quantity,
                    reading.expected, std::nullopt, std::nullopt});
  }
  const std::uint64_t seed_of_all = parameters.photons.seed;
  if (parameters.by_photons) {
    RenderParameters photons = parameters.photons;
    photons.photons.emitted_photons = std::max<std::uint64_t>(
        limits::min_photons,
        static_cast<std::uint64_t>(analytic.photon_fraction *
                                   static_cast<double>(photons.photons.emitted_photons)));
    photons.direct_rays = analytic.direct_rays;
    photons.neighbours = std::max(
        1, static_cast<int>(std::lround(analytic.neighbour_fraction * photons.neighbours)));
    const auto all =
        over_seeds(analytic, seed_of_all, parameters.most_seeds, [&](std::uint64_t seed) {
          photons.seed = seed;
          RenderResult result = measure(analytic.scene, sensors, devices, photons, progress);
          photons.radius = result.used.radius;  // found once
          return std::move(result.layers);
        });
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].photons = all[r];
  }
  if (parameters.by_paths) {
    const int paths = std::clamp(parameters.paths / static_cast<int>(sensors.size()), 1,
                                 limits::max_samples_per_pixel);
    const auto all =
        over_seeds(analytic, seed_of_all, parameters.most_seeds, [&](std::uint64_t seed) {
          return measure_by_paths(analytic.scene, sensors, paths, seed, progress).layers;
        });
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].paths = all[r];
  }
  return rows;
}

}  // namespace photile::validation
