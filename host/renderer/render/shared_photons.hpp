// Photons of several processes: which process holds which photon maps, the data of all photons, and
// the sending of photons to their maps.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "photile/communicator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Pairs of maps, both sides of a triangle or of a patch, in runs along the Morton curve through
/// the middles of their boxes: each process has one run, with about as many photons as any other.
class MapOwners {
 public:
  ///   landed   per oriented face: photons of all processes
  MapOwners(const Scene& scene, const Patches& patches, std::span<const std::uint32_t> landed,
            std::uint32_t processes);

  /// The rank that has the maps of an oriented face.
  std::uint32_t of(std::uint32_t oriented_face) const { return of_triangle_[oriented_face / 2]; }
  /// The rank that has a map of the groups.
  std::uint32_t of_map(std::uint32_t map) const { return of_pair_[map / 2]; }
  /// Per map of the groups: 1 for those of a rank.
  std::vector<std::uint8_t> maps_of(std::uint32_t rank) const;
  /// Per oriented face: the same.
  std::vector<std::uint8_t> triangles_of(std::uint32_t rank) const;

 private:
  std::vector<std::uint32_t> of_pair_, of_triangle_;
};

/// The data of the photons of all processes that stages need. Collective.
///   own   those of this process's paths, which follow those of the ranks before, sorted by
///         oriented face
std::shared_ptr<const PhotonsOfAll> photons_of_all(Communicator& processes, const Photons& own);

/// The data that a process sent to others of the same rendering, and holds for them.
struct SentData {
  std::uint64_t photons = 0, photon_bytes = 0, photons_held = 0;
  std::uint64_t points = 0, point_bytes = 0;  ///< of the picture; with their light
};

/// Sends photons to the processes whose maps they may enter, those near a border to several, in
/// rounds of defaults::exchange_round_bytes. Returns the photons of this process's maps as a single
/// process would have them: sorted by oriented face, within it in the order light, path, bounce.
/// Collective.
///   own      as photons_of_all; `of_all` is set
///   radius   of the maps, metres
///   sent     is added to
Photons to_owners(Communicator& processes, const Scene& scene, const NeighbourGroups& groups,
                  const MapOwners& owners, double radius, Photons own, SentData& sent);

}  // namespace photile
