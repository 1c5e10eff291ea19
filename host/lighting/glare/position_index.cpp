#include "glare/position_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace photile::glare {

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
  observer.position = place_in_scene(scene, observer.position);
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
