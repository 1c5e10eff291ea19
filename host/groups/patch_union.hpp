// Patches that are joined, either side by side or turned over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "photile/patches.hpp"

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
  std::size_t written = 0;
  Offset first = offsets.front();
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const Offset last = offsets[i + 1];
    const auto begin = maps.begin() + static_cast<std::ptrdiff_t>(written);
    auto end = begin;
    for (Offset j = first; j < last; ++j) *end++ = patches.map(maps[j]);
    std::sort(begin, end);
    end = std::unique(begin, end);
    written = static_cast<std::size_t>(end - maps.begin());
    offsets[i + 1] = static_cast<Offset>(written);
    first = last;
  }
  maps.resize(written);
  maps.shrink_to_fit();
}

}  // namespace photile::groups
