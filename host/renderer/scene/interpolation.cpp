#include "scene/interpolation.hpp"

#include <algorithm>

namespace photile::scene {
namespace {

/// Velocity at a keyframe: that of the parabola's chord between its neighbours.
glm::dvec3 velocity(std::span<const double> times, std::span<const glm::dvec3> values,
                    std::size_t i) {
  if (i == 0 || i + 1 == times.size()) return glm::dvec3(0);
  return (values[i + 1] - values[i - 1]) / (times[i + 1] - times[i - 1]);
}

}  // namespace

Between between(std::span<const double> times, double time) {
  if (times.size() < 2 || !(time > times.front())) return {0, 0};
  if (time >= times.back()) return {times.size() - 2, 1};
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto index = static_cast<std::size_t>(after - times.begin()) - 1;
  return {index, (time - times[index]) / (times[index + 1] - times[index])};
}

glm::dvec3 smooth(std::span<const double> times, std::span<const glm::dvec3> values, double time) {
  if (times.size() < 2) return values.front();
  const auto [i, share] = between(times, time);
  const double length = times[i + 1] - times[i];
  return hermite(values[i], length * velocity(times, values, i), values[i + 1],
                 length * velocity(times, values, i + 1), share);
}

glm::dvec3 linear(std::span<const double> times, std::span<const glm::dvec3> values, double time) {
  if (times.size() < 2) return values.front();
  const auto [i, share] = between(times, time);
  return glm::mix(values[i], values[i + 1], share);
}

}  // namespace photile::scene
