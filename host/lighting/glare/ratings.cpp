#include "glare/ratings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "photile/defaults.hpp"

namespace photile::glare {

namespace {

double contrast_sum(std::span<const Source> sources) {
  double sum = 0;
  for (const Source& s : sources) {
    sum += s.luminance * s.luminance * s.solid_angle / (s.position_index * s.position_index);
  }
  return sum;
}

}  // namespace

double ugr(std::span<const Source> sources, double background) {
  return 8 * std::log10(0.25 / background * contrast_sum(sources));
}

Source as_small_source(Source source, double projected_area) {
  const double share = projected_area / defaults::small_source_area;
  if (share >= 1) return source;
  source.luminance *= share;
  source.solid_angle /= share;
  return source;
}

double ggr(double ugr, double direct, double indirect, double coverage) {
  const double of_ceiling = std::clamp(coverage, 0.15, 1.0);
  return ugr + (1.18 - 0.18 / of_ceiling) * 8 *
                   std::log10(2.55 * (1 + direct / 220) / (1 + direct / indirect));
}

double dgp(std::span<const Source> sources, double illuminance) {
  const double contrast =
      illuminance > 0 ? std::log10(1 + contrast_sum(sources) / std::pow(illuminance, 1.87)) : 0;
  return std::min(1.0, 5.87e-5 * illuminance + 0.0918 * contrast + 0.16);
}

double low_light_correction(double illuminance) {
  if (illuminance >= 1000) return 1;
  const double e = std::exp(0.024 * illuminance - 4);
  return e / (1 + e);
}

double dgi(std::span<const Source> sources, double background) {
  double sum = 0;
  for (const Source& s : sources) {
    const double weighed = s.solid_angle / (s.position_index * s.position_index);
    sum += 0.478 * std::pow(s.luminance, 1.6) * std::pow(weighed, 0.8) /
           (background + 0.07 * std::sqrt(s.solid_angle) * s.luminance);
  }
  return 10 * std::log10(sum);
}

Observer Observer::looking(std::string name, const glm::dvec3& position, const glm::dvec3& forward,
                           const glm::dvec3& upwards) {
  Observer observer{std::move(name), position, glm::normalize(forward), upwards};
  const auto across = [&](const glm::dvec3& axis) {
    return axis - glm::dot(axis, observer.forward) * observer.forward;
  };
  glm::dvec3 up = across(upwards);
  if (glm::length(up) < 1e-6 * glm::length(upwards)) {
    const glm::dvec3 size = glm::abs(observer.forward);
    const bool x_is_least = size.x <= size.y && size.x <= size.z;
    up =
        across(x_is_least ? glm::dvec3(1, 0, 0) : glm::dvec3(0, size.y <= size.z, size.y > size.z));
  }
  observer.up = glm::normalize(up);
  return observer;
}

Observer in_scene(const Scene& scene, Observer observer) {
  observer.position = position_in_scene(scene, observer.position);
  observer.forward = direction_in_scene(scene, observer.forward);
  observer.up = direction_in_scene(scene, observer.up);
  return observer;
}

double position_index(const Observer& observer, const glm::dvec3& direction) {
  const double cosine = glm::dot(direction, observer.forward);
  if (!(cosine > 0)) return std::numeric_limits<double>::infinity();
  const double above = glm::dot(direction, observer.up);
  const double aside = glm::dot(direction, glm::cross(observer.forward, observer.up));
  const double sigma = glm::degrees(std::acos(std::min(1.0, cosine)));
  const double tau = glm::degrees(std::atan2(std::abs(aside), above));
  if (above >= 0) {
    return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                    (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
  }
  const double of_tau = std::cos(glm::radians(tau));
  const double beta = glm::degrees(
      std::atan(std::tan(glm::radians(sigma)) * std::sqrt(1 + 0.3225 * of_tau * of_tau)));
  return std::exp(6.49e-3 * beta + 21e-5 * beta * beta);
}

}  // namespace photile::glare
