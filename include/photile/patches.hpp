// Patches: sided triangles that share one photon map, so that a finely tessellated surface does not
// enter each photon in dozens of maps.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Which triangles own a photon map.
enum class MapMode {
  naive,     ///< each its own, with its own photons only (figure 1 of the paper: dark edges)
  triangle,  ///< each its own, with the photons of its neighbour group: the method of the paper
  patch,     ///< one map for all triangles of a patch
  automatic  ///< patches where they save references, single triangles elsewhere
};

/// "naive", "triangle", "patch", "auto".
std::string_view name_of(MapMode mode);
inline constexpr std::array all_map_modes = {MapMode::naive, MapMode::triangle, MapMode::patch,
                                             MapMode::automatic};

/// Triangles in disjoint sets. Patch p owns two maps: map 2 p holds the photons of its members,
/// map 2 p + 1 those of the members' other sides. Without patches each sided triangle s owns map s.
struct Patches {
  std::vector<std::uint32_t> map_of;    ///< per sided triangle; empty: every triangle for itself
  std::vector<std::uint32_t> first_of;  ///< members of patch p: members[first_of[p] ..)
  std::vector<std::uint32_t> members;   ///< sided triangles, ascending within a patch

  bool empty() const { return map_of.empty(); }
  std::size_t count() const { return first_of.empty() ? 0 : first_of.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t patch) const {
    return {members.data() + first_of[patch], members.data() + first_of[patch + 1]};
  }
  std::uint32_t map(std::uint32_t sided_triangle) const {
    return empty() ? sided_triangle : map_of[sided_triangle];
  }
  std::uint64_t bytes() const {
    return (map_of.size() + first_of.size() + members.size()) * sizeof(std::uint32_t);
  }
};

/// Clusters triangles, connected or not, into patches: flat to a fraction of `radius`, alike in
/// normal (whichever way they are wound), and without large gaps. Patches may be any number of
/// radii wide, for the wider, the fewer photons lie near a border and enter two. Empty for
/// MapMode::naive and ::triangle. Parallel; the result does not depend on the number of threads.
///   radius   metres, > 0: the search radius of the maps
Patches find_patches(const Scene& scene, double radius, MapMode mode);

}  // namespace photile
