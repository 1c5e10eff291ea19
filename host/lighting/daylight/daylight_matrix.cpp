#include "daylight/daylight_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "common/files.hpp"
#include "daylight/light_transport.hpp"
#include "trace/ray_query.hpp"

namespace photile::daylight {
namespace {

constexpr double sensor_clearance = 1e-4;  // metres

std::vector<Sensor> all_in_scene(const Scene& scene, std::span<const Sensor> sensors) {
  std::vector<Sensor> own;
  for (const Sensor& sensor : sensors) own.push_back(in_scene(scene, sensor));
  return own;
}

/// Standard errors over the means of what batches found.
std::vector<float> relative_errors(const std::vector<std::vector<double>>& batches) {
  std::vector<float> errors;
  const auto count = static_cast<double>(batches.size());
  for (std::size_t sensor = 0; sensor < batches.front().size(); ++sensor) {
    double sum = 0, squares = 0;
    for (const auto& batch : batches) {
      sum += batch[sensor];
      squares += batch[sensor] * batch[sensor];
    }
    const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean);
    const double error = count > 1 ? std::sqrt(variance / (count - 1)) : 0.0;
    errors.push_back(mean > 0 ? static_cast<float>(error / mean) : 0.0f);
  }
  return errors;
}

}  // namespace

DaylightMatrix DaylightMatrix::mean(std::span<const DaylightMatrix* const> of,
                                    std::span<const double> shares) {
  DaylightMatrix mean{of.front()->sensors, of.front()->patches, {}, {}, {}};
  const auto sum = [&](std::vector<float> DaylightMatrix::*member, const auto& term) {
    std::vector<double> sums((of.front()->*member).size(), 0.0);
    for (std::size_t k = 0; k < of.size(); ++k) {
      const std::vector<float>& values = of[k]->*member;
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += term(shares[k], double{values[i]});
    }
    (mean.*member).assign(sums.begin(), sums.end());
  };
  const auto value = [](double share, double one) { return share * one; };
  sum(&DaylightMatrix::from_sky, value);
  sum(&DaylightMatrix::straight, value);
  sum(&DaylightMatrix::relative_error,
      [](double share, double one) { return share * one * share * one; });
  for (float& error : mean.relative_error) error = std::sqrt(error);
  return mean;
}

DirectLight::DirectLight(const Scene& scene, std::span<const Sensor> sensors)
    : rays_(scene), sensors_(all_in_scene(scene, sensors)) {
  const BoundingSphere bounds = bounding_sphere(scene);
  beyond_ = 2.5 * bounds.radius;
  for (Sensor& sensor : sensors_) {
    sensor.position += sensor_clearance * sensor.normal;
    beyond_ =
        std::max(beyond_, glm::distance(sensor.position, bounds.center) + 1.5 * bounds.radius);
  }
}

double DirectLight::from(const glm::dvec3& direction, std::size_t sensor) const {
  const Sensor& at = sensors_[sensor];
  const double cosine = glm::dot(direction, at.normal);
  if (!(cosine > 0)) return 0;
  const glm::vec3 passes = trace::transmittance(rays_, glm::vec3(at.position),
                                                glm::vec3(at.position + beyond_ * direction));
  return cosine * luminance(glm::dvec3(passes));
}

DaylightMatrix daylight_matrix(const Scene& scene, std::span<const Sensor> sensors,
                               const std::vector<weather::SkyPatch>& patches,
                               const MatrixParameters& parameters, Progress& progress) {
  const MeasuringParameters& measuring = parameters.measuring;
  TransportParameters transported;
  transported.rays = measuring.gathering.rays;
  transported.response = measuring.gathering.response;
  transported.sky = {measuring.repeats, measuring.photons.seed,
                     measuring.photons.max_specular_depth};
  transported.mean_luminance = parameters.mean_luminance;
  const RayScene rays(scene);
  const weather::PatchFinder finder(patches, parameters.north);
  const LightTransport transport =
      light_transport(rays, all_in_scene(scene, sensors), finder, transported, progress);
  progress.begin("solve for the patches", transport.patches, "patches");
  DaylightMatrix matrix;
  matrix.sensors = sensors.size();
  matrix.patches = transport.patches;
  about_file(scene.source, [&] {
    matrix.from_sky = lux_of_patches(transport);
    matrix.relative_error = relative_errors(lux_of_batches(transport));
  });
  matrix.straight.assign(matrix.from_sky.size(), 0.0f);
  const auto maintenance = static_cast<float>(measuring.maintenance);
  for (std::size_t sensor = 0; sensor < matrix.sensors; ++sensor) {
    for (const auto& entry : transport.sensors[sensor].patches) {
      matrix.straight[sensor * matrix.patches + entry.patch] =
          maintenance * static_cast<float>(luminance(glm::dvec3(entry.straight)));
    }
  }
  for (float& lux : matrix.from_sky) lux *= maintenance;
  progress.end();
  return matrix;
}

}  // namespace photile::daylight
