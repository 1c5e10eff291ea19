// Patches that are joined, either side by side or turned over.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "photile/neighbour_groups.hpp"

namespace photile::groups {

/// A union of disjoint sets with parity: each patch knows the set it is in, and whether its front
/// belongs to the set's front or back.
class PatchUnion {
 public:
  explicit PatchUnion(std::size_t patch_count);

  /// Puts `patch` into the set of `other`; `turned` = 1 puts its front to the other's back. Both
  /// must be representatives (maps renamed by map()).
  void join(std::uint32_t patch, std::uint32_t other, std::uint32_t turned);

  /// Numbers the sets from 0 in the order of their first patches; map() gives those numbers from
  /// now on.
  void number();

  /// The map that a patch's map has become.
  std::uint32_t map(std::uint32_t map) const;

  /// The joined patches. Before: number().
  Patches apply(const Patches& patches) const;

 private:
  std::vector<std::uint32_t> parent_;  ///< map of the parent that the patch's front became
  std::vector<std::uint32_t> number_;  ///< per representative; empty before number()
};

/// Sorted lists of maps after a renaming, each map once.
template <class Offset>
void rename_maps(std::vector<Offset>& offsets, std::vector<std::uint32_t>& maps,
                 const PatchUnion& patches) {
  const std::size_t lists = offsets.size() - 1;
  std::vector<std::uint32_t> sizes(lists);
  tbb::parallel_for(std::size_t{0}, lists, [&](std::size_t i) {
    const auto begin = maps.begin() + static_cast<std::ptrdiff_t>(offsets[i]);
    const auto end = maps.begin() + static_cast<std::ptrdiff_t>(offsets[i + 1]);
    std::transform(begin, end, begin, [&](std::uint32_t map) { return patches.map(map); });
    std::sort(begin, end);
    sizes[i] = static_cast<std::uint32_t>(std::unique(begin, end) - begin);
  });
  auto written = maps.begin();
  for (std::size_t i = 0; i < lists; ++i) {
    const auto begin = maps.begin() + static_cast<std::ptrdiff_t>(offsets[i]);
    offsets[i] = static_cast<Offset>(written - maps.begin());
    written = std::copy(begin, begin + sizes[i], written);
  }
  offsets.back() = static_cast<Offset>(written - maps.begin());
  maps.erase(written, maps.end());
  maps.shrink_to_fit();
}

}  // namespace photile::groups
