// Sums at one point of a surface, per light and batch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gather/gathered_irradiance.hpp"
#include "photile/scene_needs.hpp"

namespace photile::gathering {

/// Writes points one after another. Sums run in the order of the calls.
class BatchSums {
 public:
  /// References are kept. `result` is empty.
  ///   caustics   whether add_to_all is called at all
  BatchSums(const SceneNeeds& needs, int batches, bool caustics, GatheredIrradiance& result);

  /// Light of a layer at power 1, W/m2 or lm/m2, that one batch found.
  void add(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    light_up(layer);
    sums_[std::size_t{layer} * batches_ + batch] += irradiance;
  }

  /// Light that no batch has to find.
  ///   relative_variance   of it
  void add_to_all(std::uint32_t layer, const glm::vec3& irradiance, double relative_variance);

  /// Writes the point; the next one begins.
  void end_point();

 private:
  void light_up(std::uint32_t layer) {
    if (is_lit_[layer]) return;
    is_lit_[layer] = 1;
    lit_.push_back(static_cast<std::uint16_t>(layer));
  }
  void write(std::uint32_t layer);

  bool sparse_, caustics_;
  std::size_t batches_;
  GatheredIrradiance& result_;
  std::vector<glm::vec3> sums_;  ///< [layer][batch]
  std::vector<double> shared_variance_;
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

}  // namespace photile::gathering
