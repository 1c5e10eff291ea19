// Numbers for the photon maps that there are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "maps/candidate_maps.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::maps {

/// Pairs of maps (both sides of a triangle, or of a patch) of which a photon may enter one,
/// numbered without gaps in ascending order of their triangles or patches. What no photon comes
/// near has no map and takes no memory.
struct MapNumbers {
  std::vector<std::uint32_t> pairs;   ///< per pair: its triangle; with patches, its patch
  std::vector<std::uint32_t> map_of;  ///< per sided triangle: its map, or `none`

  std::size_t map_count() const { return 2 * pairs.size(); }
};

/// Numbers the maps that are members of candidate lists, and renames the members.
///   sided_count   sided triangles of the scene
MapNumbers number_maps(CandidateMaps& candidates, const Patches& patches, std::size_t sided_count);

/// `values` of all sided triangles' or patches' maps: those of the numbered ones.
std::vector<float> of_numbered(const MapNumbers& numbers, std::span<const float> values);

}  // namespace photile::maps
