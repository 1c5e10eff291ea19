#include "gather/batch_sums.hpp"

#include <algorithm>

#include "photile/scene.hpp"

namespace photile::gathering {

BatchSums::BatchSums(const SceneNeeds& needs, int batches, bool caustics,
                     GatheredIrradiance& result)
    : sparse_(needs.many_lights()),
      caustics_(caustics),
      batches_(static_cast<std::size_t>(batches)),
      result_(result),
      sums_(needs.light_count * batches_, glm::vec3(0.0f)),
      shared_variance_(needs.light_count, 0.0),
      is_lit_(needs.light_count) {
  result_.batches = batches;
  if (sparse_) result_.mean.first.push_back(0);
}

void BatchSums::add_to_all(std::uint32_t layer, const glm::vec3& irradiance,
                           double relative_variance) {
  light_up(layer);
  for (std::size_t b = 0; b < batches_; ++b) sums_[layer * batches_ + b] += irradiance;
  const double value = luminance(glm::dvec3(irradiance));
  shared_variance_[layer] += relative_variance * value * value;
}

void BatchSums::end_point() {
  if (sparse_) {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t layer : lit_) {
      write(layer);
      result_.mean.light.push_back(layer);
    }
    result_.mean.first.push_back(result_.mean.irradiance.size());
  } else {
    for (std::uint32_t layer = 0; layer < is_lit_.size(); ++layer) write(layer);
  }
  for (const std::uint16_t layer : lit_) {
    std::fill_n(sums_.begin() + static_cast<std::ptrdiff_t>(layer * batches_), batches_,
                glm::vec3(0.0f));
    shared_variance_[layer] = 0;
    is_lit_[layer] = 0;
  }
  lit_.clear();
}

void BatchSums::write(std::uint32_t layer) {
  glm::vec3 sum(0.0f);
  for (std::size_t b = 0; b < batches_; ++b) {
    const glm::vec3& value = sums_[layer * batches_ + b];
    sum += value;
    result_.batch.push_back(static_cast<float>(luminance(glm::dvec3(value))));
  }
  result_.mean.irradiance.push_back(sum / static_cast<float>(batches_));
  if (caustics_) {
    result_.shared_variance.push_back(static_cast<float>(shared_variance_[layer]));
  }
}

}  // namespace photile::gathering
