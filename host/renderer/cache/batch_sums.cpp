#include "cache/batch_sums.hpp"

#include <algorithm>

#include "photile/scene.hpp"

namespace photile::cache {

BatchSums::BatchSums(const SceneNeeds& needs, int batches, bool caustics,
                     GatheredIrradiance& result)
    : sparse_(needs.many_lights()),
      caustics_(caustics),
      smooth_(needs.smooth_shading),
      batches_(static_cast<std::size_t>(batches)),
      result_(result),
      sums_(needs.light_count * batches_, glm::vec3(0.0f)),
      by_normal_(needs.smooth_shading ? needs.light_count : 0, glm::vec4(0.0f)),
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
  if (smooth_) by_normal_[layer].w += static_cast<float>(value * static_cast<double>(batches_));
}

/// Irradiance goes with the cosine to the normal n, so that light L from w counts L (w . n) for it.
///   even   share of what is lost when w sinks below the horizon that other light, which rises
///          above it, makes good: half of light that is the same from all sides, for a plane that
///          is turned by t gets (1 + cos t) / 2 of it and not cos t
void BatchSums::add_by_normal(std::uint32_t layer, const glm::vec3& irradiance,
                              const glm::vec3& direction, float even, float most_inverse_cosine) {
  const auto light = static_cast<float>(luminance(glm::dvec3(irradiance)));
  const float cosine = glm::dot(direction, normal_);
  glm::vec3 along = normal_;
  if (cosine > 0.0f) {
    along += std::min(1.0f / cosine, most_inverse_cosine) * (direction - cosine * normal_);
  }
  by_normal_[layer] += light * glm::vec4(along - even * normal_, even);
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
    if (smooth_) by_normal_[layer] = glm::vec4(0.0f);
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
  if (smooth_) {
    result_.mean.by_normal.push_back(by_normal_[layer] / static_cast<float>(batches_));
  }
  if (caustics_) {
    result_.shared_variance.push_back(static_cast<float>(shared_variance_[layer]));
  }
}

}  // namespace photile::cache
