// Sums at one point of a surface, per light and batch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "cache/gathered_irradiance.hpp"
#include "photile/defaults.hpp"
#include "photile/scene.hpp"

namespace photile::cache {

/// Writes points one after another. Sums run in the order of the calls.
class BatchSums {
 public:
  /// References are kept. `result` is empty.
  ///   caustics   whether add_to_all is called at all
  BatchSums(const SceneNeeds& needs, int batches, bool caustics, GatheredIrradiance& result);

  /// Before anything is added to a point of this unit normal, in scenes with smooth shading.
  void begin_point(const glm::vec3& normal) { normal_ = normal; }

  /// Light of a layer at power 1, W/m2 or lm/m2, that one batch found: a lamp in this direction.
  void add_lamp(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance,
                const glm::vec3& direction) {
    add(layer, batch, irradiance);
    if (smooth_) add_by_normal(layer, irradiance, direction, 0.0f, no_bound);
  }
  /// Likewise: surface, met by a ray with the density of the cosine, which is likely to go on
  /// beyond the horizon of the point.
  void add_surface(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance,
                   const glm::vec3& direction) {
    add(layer, batch, irradiance);
    if (smooth_) add_by_normal(layer, irradiance, direction, 0.5f, defaults::most_inverse_cosine);
  }
  /// Likewise: from nobody knows where, the same for every normal.
  void add_even(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    add(layer, batch, irradiance);
    if (smooth_) by_normal_[layer].w += static_cast<float>(luminance(glm::dvec3(irradiance)));
  }

  /// Light that no batch has to find, likewise.
  ///   relative_variance   of it
  void add_to_all(std::uint32_t layer, const glm::vec3& irradiance, double relative_variance);

  /// Writes the point; the next one begins.
  void end_point();

 private:
  static constexpr float no_bound = std::numeric_limits<float>::infinity();

  void add(std::uint32_t layer, std::uint32_t batch, const glm::vec3& irradiance) {
    light_up(layer);
    sums_[std::size_t{layer} * batches_ + batch] += irradiance;
  }
  void add_by_normal(std::uint32_t layer, const glm::vec3& irradiance, const glm::vec3& direction,
                     float even, float most_inverse_cosine);
  void light_up(std::uint32_t layer) {
    if (is_lit_[layer]) return;
    is_lit_[layer] = 1;
    lit_.push_back(static_cast<std::uint16_t>(layer));
  }
  void write(std::uint32_t layer);

  bool sparse_, caustics_, smooth_;
  std::size_t batches_;
  GatheredIrradiance& result_;
  glm::vec3 normal_{0.0f};
  std::vector<glm::vec3> sums_;       ///< [layer][batch]
  std::vector<glm::vec4> by_normal_;  ///< [layer], of all batches; empty without smooth shading
  std::vector<double> shared_variance_;
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

}  // namespace photile::cache
