#include "reading/scene_origin.hpp"

#include <algorithm>
#include <cmath>

#include "scene/coordinate_limit.hpp"

namespace photile::reading {

void SceneOrigin::add(const std::array<glm::dvec3, 3>& corners) {
  if (!std::all_of(corners.begin(), corners.end(), scene::within_limit)) return;
  double longest = 0, squares = 0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
    longest = std::max(longest, glm::dot(edge, edge));
    squares += glm::dot(corners[i], corners[i]);
  }
  const double weight = 1.0 / longest;
  if (!std::isfinite(weight * squares)) return;
  corners_ += 3;
  weight_ += 3.0 * weight;
  sum_ += weight * (corners[0] + corners[1] + corners[2]);
  squares_ += weight * squares;
}

glm::dvec3 SceneOrigin::best() const {
  constexpr double far = 1024.0, gain = 16.0;
  if (corners_ == 0) return glm::dvec3(0.0);
  const double mean_square = squares_ / static_cast<double>(corners_);
  if (!(mean_square > far * far)) return glm::dvec3(0.0);
  // Koenig and Huygens: moving the origin to the mean takes its own square off the mean square.
  const glm::dvec3 mean = sum_ / weight_;
  const double gone = weight_ * glm::dot(mean, mean) / static_cast<double>(corners_);
  if (!(mean_square - gone < mean_square / (gain * gain))) return glm::dvec3(0.0);
  return glm::dvec3(glm::vec3(mean));
}

}  // namespace photile::reading
