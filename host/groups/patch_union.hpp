// Patches that are joined, either side by side or turned over.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/patches.hpp"

namespace photile::groups {

/// A union of disjoint sets with parity: each patch knows the set it is in, and whether its front
/// belongs to the set's front or back.
class PatchUnion {
 public:
  explicit PatchUnion(std::size_t patch_count);

  /// Puts `patch` into the set of `other`; `turned` = 1 puts its front to the other's back. Both must
  /// be representatives (maps renamed by map()).
  void join(std::uint32_t patch, std::uint32_t other, std::uint32_t turned);

  /// Numbers the sets from 0 in the order of their first patches; map() gives those numbers from now
  /// on.
  void number();

  /// The map that a patch's map has become.
  std::uint32_t map(std::uint32_t map) const;

  /// The joined patches. Before: number().
  Patches apply(const Patches& patches) const;

 private:
  std::vector<std::uint32_t> parent_;  ///< map of the parent that the patch's front became
  std::vector<std::uint32_t> number_;  ///< per representative; empty before number()
};

}  // namespace photile::groups
