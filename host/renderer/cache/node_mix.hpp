// The light of all lights together at the nodes of light maps, and that of a plane turned from the
// surface that it lies on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/scene.hpp"

namespace photile::cache {

/// Irradiance of the lights together, linear RGB, at their powers and tints.
class NodeMix {
 public:
  /// Updates the mix to these powers: nodes with light whose power changed, and new nodes, are
  /// summed again. Every sum is computed in full, in one order: adding a difference would leave its
  /// rounding, and the mix would depend on the path that sliders took. Work is shared by TBB.
  ///   values   what the nodes hold, see LightMaps::values
  ///   powers   per layer: power x tint
  void mix(const LightTable& values, std::size_t nodes, std::span<const glm::vec3> powers);

  /// Per node; the fourth component is unused.
  std::span<const glm::vec4> light() const { return light_; }
  /// Per node the luminance by the normal, as in LightTable; empty where nodes do not have it.
  std::span<const glm::vec4> by_normal() const { return by_normal_; }
  std::span<const glm::vec3> powers() const { return powers_; }

 private:
  std::vector<glm::vec3> powers_;
  std::vector<glm::vec4> light_, by_normal_;
};

/// Irradiance of a plane of unit normal n, in the colour of the irradiance of the surface.
///   by_normal   as in LightTable
inline glm::vec3 turned(const glm::vec3& irradiance, const glm::vec4& by_normal,
                        const glm::vec3& normal) {
  const auto light = static_cast<float>(luminance(glm::dvec3(irradiance)));
  if (!(light > 0.0f)) return glm::vec3(0.0f);
  return std::max(0.0f, glm::dot(glm::vec3(by_normal), normal) + by_normal.w) / light * irradiance;
}

}  // namespace photile::cache
