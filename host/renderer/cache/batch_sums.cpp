#include "cache/batch_sums.hpp"

#include <algorithm>

namespace photile::cache {

BatchSums::BatchSums(const SceneNeeds& needs, int batches, bool caustics, LightTable& table)
    : caustics_(caustics),
      smooth_(needs.smooth_shading),
      batches_(static_cast<std::size_t>(batches)),
      table_(table),
      sums_(needs.light_count),
      of_batches_(needs.light_count * batches_, glm::vec3(0.0f)) {
  table_ = LightTable(needs);
  table_.batches = batches;
}

void BatchSums::add_to_all(std::uint32_t layer, const glm::vec3& irradiance,
                           double relative_variance) {
  for (std::size_t b = 0; b < batches_; ++b) of_batches_[layer * batches_ + b] += irradiance;
  const double value = luminance(glm::dvec3(irradiance));
  Sums& sums = sums_.of(layer);
  sums.shared_variance += relative_variance * value * value;
  if (smooth_) sums.by_normal.w += static_cast<float>(value * static_cast<double>(batches_));
}

/// Irradiance goes with the cosine to the normal n, so that light L from w counts L (w . n) for it.
///   even   fraction of what is lost when w sinks below the horizon that other light, which rises
///          above it, replaces: half of light that is the same from all sides, for a plane that is
///          turned by t gets (1 + cos t) / 2 of it and not cos t
void BatchSums::add_by_normal(Sums& sums, const glm::vec3& irradiance, const glm::vec3& direction,
                              float even, float most_inverse_cosine) const {
  const auto light = static_cast<float>(luminance(glm::dvec3(irradiance)));
  const float cosine = glm::dot(direction, normal_);
  glm::vec3 along = normal_;
  if (cosine > 0.0f) {
    along += std::min(1.0f / cosine, most_inverse_cosine) * (direction - cosine * normal_);
  }
  sums.by_normal += light * glm::vec4(along - even * normal_, even);
}

void BatchSums::end_point() {
  sums_.end_row(table_, [&](std::size_t layer, const Sums& sums) {
    glm::vec3 sum(0.0f);
    for (std::size_t b = 0; b < batches_; ++b) {
      glm::vec3& value = of_batches_[layer * batches_ + b];
      sum += value;
      table_.batch.push_back(static_cast<float>(luminance(glm::dvec3(value))));
      value = glm::vec3(0.0f);
    }
    table_.irradiance.push_back(sum / static_cast<float>(batches_));
    if (smooth_) table_.by_normal.push_back(sums.by_normal / static_cast<float>(batches_));
    if (caustics_) table_.shared_variance.push_back(static_cast<float>(sums.shared_variance));
  });
}

}  // namespace photile::cache
