// Estimates that are put together on the host.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

/// Writes the estimates of hits one after another, in the form that the scene asks for.
class EstimateWriter {
 public:
  /// References are kept. `estimates` is empty.
  EstimateWriter(const SceneNeeds& needs, Estimates& estimates);

  /// Adds what a layer gives to the hit. Sums run in the order of the calls.
  ///   irradiance   W/m2 or lm/m2
  ///   radiance     reflected, W/(m2 sr) or cd/m2
  void add(std::uint32_t layer, const glm::vec3& irradiance, const glm::vec3& radiance);

  /// Writes the hit; the next one begins.
  void end_hit();

 private:
  void append(std::uint32_t layer);

  bool sparse_, has_radiance_;
  Estimates& estimates_;
  std::vector<glm::vec3> irradiance_, radiance_;  ///< per layer, of the hit
  std::vector<std::uint8_t> is_lit_;              ///< per layer
  std::vector<std::uint16_t> lit_;                ///< layers, in the order in which they came
};

}  // namespace photile::estimate
