// The light that quick frames show at nodes, without steps between cells of different sizes.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cache/light_maps.hpp"
#include "cache/node_mix.hpp"
#include "cache/tiles.hpp"

namespace photile::cache {

/// The light of all lights together at the nodes, at their powers, and how much each node counts
/// between others. Where nodes are lacking it is softened, so that this does not show:
///   - Nodes on the border of a larger cell show the mean which that cell has at their position,
///     whatever they hold: otherwise there would be a step along that border.
///   - A corner of a cell counts less where its surroundings are nearer than the next corner: it
///     may lie behind a door, and says little about the surface in front of that.
///   - No corner of a cell is brighter than all others by more than a given factor: nodes beside
///     lights would show as bright squares.
class ShownNodes {
 public:
  /// Brings the light up to date with what the maps hold. Work is shared by TBB.
  ///   powers       per layer: power x tint
  ///   lacking      cells that the picture lacked before the maps were last filled: light is
  ///                softened around those that still lack their nodes
  ///   everywhere   light is softened at all cells, whether they lack nodes or not
  void mix(const LightMaps& maps, std::span<const glm::vec3> powers,
           std::span<const MissingCell> lacking, bool everywhere);

  /// Keeps these nodes alone, in this order, until the next mix.
  void keep(std::span<const std::uint32_t> nodes) {
    held_.keep(nodes);
    light_.clear();
  }

  /// Per node, as NodeMix has them.
  std::span<const glm::vec4> light() const { return light_; }
  std::span<const glm::vec4> by_normal() const { return by_normal_; }

  /// Whether the light of one of these nodes is softened because a cell beside it lacks nodes.
  bool lacks_beside(const BilinearWeights& bilinear) const;
  /// The same nodes, with the weights that they have by what each counts. They sum to 1.
  BilinearWeights weighted(BilinearWeights bilinear) const;

  /// The light of the nodes.
  const NodeMix& held() const { return held_; }

 private:
  class Softening;

  NodeMix held_;
  std::vector<glm::vec4> light_, by_normal_;  // per node
  // Per node; both are empty where nothing is softened.
  std::vector<float> weight_;
  std::vector<std::uint8_t> lacks_beside_;
};

}  // namespace photile::cache
