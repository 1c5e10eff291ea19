// The weights that photons are to have where few paths come: weight windows.
#pragma once

#include <tsl/robin_map.h>

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "common/content_hash.hpp"
#include "photile/scene.hpp"
#include "trace/ray_scene.hpp"
#include "trace/surface_cells.hpp"

namespace photile::trace {

/// A photon of a pilot, whose weight is its flux over that of a path of its light.
struct PilotPhoton {
  glm::vec3 position;  ///< metres
  glm::vec3 normal;    ///< unit geometric normal of the surface where it landed, on its side
  float weight;
};

/// Whether light comes to rooms that few paths find: whether of the cells of a coarse grid that
/// have photons of a pilot without windows, many have far fewer than the others and lie in closed
/// space. What is dim in the open, such as the ground around a house, has photons that leave the
/// scene, and does not count.
bool hides_light(std::span<const PilotPhoton> pilot, const RayScene::Impl& rays,
                 const BoundingSphere& bounds);

/// The weights that photons are to have, by place: 1, or where the paths of pilots leave fewer
/// photons than elsewhere, so much less that there are about as many. Paths that come there with
/// more are split, and those that leave with less end by roulette (weight windows of neutron
/// transport: Booth and Hendricks, "Importance estimation in forward Monte Carlo calculations",
/// 1984). No photon becomes heavier than without them.
///
/// Places are cells of a grid, parted by the axis that surfaces face.
class WeightWindows {
 public:
  /// From a pilot without windows.
  WeightWindows(std::span<const PilotPhoton> pilot, const BoundingSphere& bounds);

  /// Counts one more pilot of as many paths, for which these windows were used.
  void add(std::span<const PilotPhoton> pilot);

  /// The weight at a place, in (0, 1]; nothing where no pilot came.
  std::optional<float> at(const glm::vec3& position, const glm::vec3& normal) const;

 private:
  SurfaceCells cells_;
  int pilots_ = 0;
  tsl::robin_map<SurfaceCells::Facing, double, BytesHash>
      weight_;       ///< of all pilots' photons in a cell
  double even_ = 1;  ///< weight of a pilot's photons in a cell, from which on the window is 1
};

}  // namespace photile::trace
