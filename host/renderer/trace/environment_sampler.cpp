#include "trace/environment_sampler.hpp"

#include <algorithm>

#include "photile/scene.hpp"

namespace photile::trace {

EnvironmentSampler::EnvironmentSampler(const EnvironmentMap& map)
    : EnvironmentSampler(map, [](const glm::dvec3&) { return 1.0; }) {}

EnvironmentSampler::EnvironmentSampler(
    const EnvironmentMap& map, const std::function<double(const glm::dvec3& direction)>& factor)
    : map_(&map) {
  texel_up_to_.reserve(static_cast<std::size_t>(map.width()) *
                       static_cast<std::size_t>(map.height()));
  double all = 0;
  for (int row = 0; row < map.height(); ++row) {
    double sum = 0;
    for (int column = 0; column < map.width(); ++column)
      texel_up_to_.push_back(sum += luminance(map.texel(column, row)) *
                                    factor(map.direction_at(column + 0.5, row, 0.5)));
    row_up_to_.push_back(all += sum * map.solid_angle(row));
  }
}

EnvironmentSampler::Sample EnvironmentSampler::sample(const RandomBlock& random) const {
  // The last entries are larger than the targets, so there always are a row and a texel.
  const double target = random.uniform_double(0) * row_up_to_.back();
  const auto row = static_cast<std::size_t>(
      std::upper_bound(row_up_to_.begin(), row_up_to_.end(), target) - row_up_to_.begin());
  const double before = row == 0 ? 0.0 : row_up_to_[row - 1];
  const double within = (target - before) / (row_up_to_[row] - before);  // uniform again
  const auto first = texel_up_to_.begin() + static_cast<std::ptrdiff_t>(row) * map_->width();
  const auto last = first + map_->width();
  const auto chosen = std::upper_bound(first, last, std::min(within, 1 - 0x1p-53) * *(last - 1));
  const auto column = static_cast<int>(std::min(chosen, last - 1) - first);
  const glm::vec3& radiance = map_->texel(column, static_cast<int>(row));
  const double bright = luminance(radiance);
  return {glm::vec3(map_->direction_at(column + double{random.uniform(2)}, static_cast<int>(row),
                                       double{random.uniform(3)})),
          glm::vec3(glm::dvec3(radiance) / bright),
          static_cast<float>(weight(column, static_cast<int>(row)) / row_up_to_.back())};
}

double EnvironmentSampler::weight(int column, int row) const {
  const std::size_t texel =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(map_->width()) +
      static_cast<std::size_t>(column);
  return texel_up_to_[texel] - (column == 0 ? 0.0 : texel_up_to_[texel - 1]);
}

float EnvironmentSampler::density(const glm::vec3& direction) const {
  const std::size_t texel = map_->texel_towards(direction);
  const auto width = static_cast<std::size_t>(map_->width());
  return static_cast<float>(
      weight(static_cast<int>(texel % width), static_cast<int>(texel / width)) / row_up_to_.back());
}

}  // namespace photile::trace
