#include "estimate/light_at_points.hpp"

#include <algorithm>

namespace photile::estimate {

EstimateWriter::EstimateWriter(const SceneNeeds& needs, Estimates& estimates)
    : sparse_(needs.many_lights()),
      has_radiance_(needs.glossy || needs.smooth_shading),
      estimates_(estimates),
      irradiance_(needs.light_count, glm::vec3(0.0f)),
      radiance_(needs.light_count, glm::vec3(0.0f)),
      is_lit_(needs.light_count) {
  if (sparse_) estimates_.first.push_back(0);
}

void EstimateWriter::add(std::uint32_t layer, const glm::vec3& irradiance,
                         const glm::vec3& radiance) {
  if (!is_lit_[layer]) {
    is_lit_[layer] = 1;
    lit_.push_back(static_cast<std::uint16_t>(layer));
  }
  irradiance_[layer] += irradiance;
  radiance_[layer] += radiance;
}

void EstimateWriter::end_hit() {
  if (sparse_) {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t layer : lit_) {
      append(layer);
      estimates_.light.push_back(layer);
    }
    estimates_.first.push_back(estimates_.irradiance.size());
  } else {
    for (std::uint32_t layer = 0; layer < irradiance_.size(); ++layer) append(layer);
  }
  for (const std::uint16_t layer : lit_) {
    irradiance_[layer] = radiance_[layer] = glm::vec3(0.0f);
    is_lit_[layer] = 0;
  }
  lit_.clear();
}

void EstimateWriter::append(std::uint32_t layer) {
  estimates_.irradiance.push_back(irradiance_[layer]);
  if (has_radiance_) estimates_.radiance.push_back(radiance_[layer]);
}

}  // namespace photile::estimate
