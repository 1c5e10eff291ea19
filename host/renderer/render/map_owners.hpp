// Which process holds which photon maps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/neighbour_groups.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Pairs of maps, both sides of a triangle or of a patch, in runs along the Morton curve through
/// the middles of their boxes: each process has one run, with about as many photons as any other.
class MapOwners {
 public:
  ///   landed   per sided triangle: photons of all processes
  MapOwners(const Scene& scene, const Patches& patches, std::span<const std::uint32_t> landed,
            std::uint32_t processes);

  /// The rank that has the maps of an oriented face.
  std::uint32_t of(std::uint32_t sided_triangle) const { return of_triangle_[sided_triangle / 2]; }
  /// The rank that has a map of the groups.
  std::uint32_t of_map(std::uint32_t map) const { return of_pair_[map / 2]; }
  /// Per map of the groups: 1 for those of a rank.
  std::vector<std::uint8_t> maps_of(std::uint32_t rank) const;
  /// Per sided triangle: the same.
  std::vector<std::uint8_t> triangles_of(std::uint32_t rank) const;

 private:
  std::vector<std::uint32_t> of_pair_, of_triangle_;
};

}  // namespace photile
