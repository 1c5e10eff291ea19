// Which maps each photon may have to enter (its neighbour group, narrowed down where the group is
// large), and the numbering of the maps that exist.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/box.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

/// Lists of maps in compressed sparse rows; photons that lie close together on an oriented
/// face share a list. A large triangle has thousands of neighbours, of which a photon on it reaches
/// only a few: without the lists the build would test them all.
struct CandidateMaps {
  std::vector<std::uint32_t> list_of_photon;
  std::vector<std::uint64_t> first_list_of;  ///< per oriented face, and the number of lists
  std::vector<std::uint64_t> offsets;        ///< per list, and the number of members
  std::vector<std::uint32_t> members;        ///< maps
};

/// Every list of a photon holds each member of its group whose surface lies within `reach` metres
/// of the photon, and seldom many more. Splits the photons of an oriented face in halves until the
/// members near each half are few. Parallel; the result does not depend on the number of threads.
///   requested   per map of the groups: 1 for those that lists name; empty: all. Which
///               photons a list is for does not depend on it
CandidateMaps find_candidate_maps(const Scene& scene, const Photons& photons,
                                  const NeighbourGroups& groups, float reach,
                                  std::span<const std::uint8_t> requested = {});

/// The box of each pair of maps: of a triangle, or of a patch.
std::vector<geometry::Box> map_boxes(const Scene& scene, const Patches& patches);

/// Pairs of maps (both sides of a triangle, or of a patch) of which a photon may enter one,
/// numbered without gaps in ascending order of their triangles or patches. Surfaces without photons
/// nearby have no map and take no memory.
struct MapNumbers {
  std::vector<std::uint32_t> pairs;   ///< per pair: its triangle; with patches, its patch
  std::vector<std::uint32_t> map_of;  ///< per oriented face: its map, or `none`

  std::size_t map_count() const { return 2 * pairs.size(); }
};

/// Numbers the maps that are members of candidate lists, and renames the members.
///   face_count   oriented faces of the scene
MapNumbers number_maps(CandidateMaps& candidates, const Patches& patches, std::size_t face_count);

/// Of `values` for the maps of all oriented faces or patches, those of the numbered maps.
std::vector<float> of_numbered(const MapNumbers& numbers, std::span<const float> values);

}  // namespace photile::maps
