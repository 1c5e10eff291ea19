// Light in space, interpolated from the nodes around: shown on surface whose nodes have no light
// yet, or lie in its grooves.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cache/light_maps.hpp"

namespace photile::cache {

/// Nodes that lie closer to other surface count less; this much at least.
inline constexpr float least_node_weight = 1e-3f;

/// Irradiance by position and direction of the normal: lattices from coarse to fine (Greger et al.,
/// "The Irradiance Volume", 1998), whose vertices have a value for each of six directions
/// (McTaggart, "Half-Life 2 / Valve Source Shading", 2004). Blind to what stands between a node and
/// a position.
class AmbientLight {
 public:
  /// Uses some of the nodes, chosen evenly.
  ///   light   irradiance, per node; the fourth component is not read
  void gather(const LightMaps& maps, const Scene& scene, std::span<const glm::vec4> light);

  /// W/m2, linear RGB; zero before nodes have been gathered.
  ///   normal   of unit length
  glm::vec3 irradiance(const glm::vec3& position, const glm::vec3& normal) const;

 private:
  /// Light times weight, and weight, for the directions +x, -x, +y ...
  using Vertex = std::array<glm::vec4, 6>;

  glm::vec3 within_bounds(const glm::vec3& position) const;

  glm::vec3 lowest_{0.0f}, extent_{0.0f};  ///< of the nodes, metres
  std::vector<Vertex> finest_;
};

}  // namespace photile::cache
