// Photons of several processes: what is known of all of them, and each where its maps are.
#pragma once

#include <cstdint>
#include <memory>

#include "photile/communicator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"
#include "render/map_owners.hpp"

namespace photile {

/// What stages ask of the photons of all processes. Collective.
///   own   those of this process's paths, which follow those of the ranks before, sorted by sided
///         triangle
std::shared_ptr<const PhotonsOfAll> photons_of_all(Communicator& processes, const Photons& own);

/// How many photons went where.
struct PhotonsMoved {
  std::uint64_t sent = 0;   ///< to other processes
  std::uint64_t bytes = 0;  ///< of these
  std::uint64_t held = 0;   ///< by this process in the end, for maps of its own
};

/// Sends photons to the processes whose maps they may enter, those near a border to several, in
/// rounds of defaults::exchange_round_bytes. Returns those of the own maps as one process would
/// have them: sorted by sided triangle, within it in the order light, path, bounce. Collective.
///   own      as photons_of_all; `of_all` is set
///   radius   of the maps, metres
Photons to_owners(Communicator& processes, const Scene& scene, const NeighbourGroups& groups,
                  const MapOwners& owners, double radius, Photons own, PhotonsMoved& moved);

}  // namespace photile
