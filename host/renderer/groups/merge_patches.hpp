// Patches that are merged, in the same orientation or turned over, and a sample of the photons by
// the maps that hold them.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/index_rows.hpp"
#include "groups/patch_shape.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"

namespace photile::groups {

/// A union of disjoint sets with parity: each patch has its set, and whether its front belongs to
/// the set's front or back.
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

/// The step from one photon of a sample to the next among `photons` photons, so that about 32,768
/// are left. The first of the sample is half a step from the first of all.
std::uint64_t sample_step(std::uint64_t photons);

/// Every n-th photon, by sample_step. It enters the maps of its group whose
/// boxes lie within the radius.
class PhotonSample {
 public:
  /// `shapes`: one per patch.
  PhotonSample(std::span<const PatchShape> shapes, const NeighbourGroups& groups,
               const Photons& photons);

  std::size_t size() const { return position_.size(); }
  /// The maps that a photon of the sample enters, each once.
  std::span<const std::uint32_t> maps_of(std::size_t photon) const {
    return {maps_.data() + first_of_[photon], maps_.data() + first_of_[photon + 1]};
  }
  const glm::dvec3& position(std::size_t photon) const { return position_[photon]; }

  /// After joins.
  void rename(const PatchUnion& patches);

 private:
  std::vector<glm::dvec3> position_;  ///< metres
  std::vector<std::uint32_t> first_of_{0};
  std::vector<std::uint32_t> maps_;
};

/// Per map the photons of a sample that it holds, ascending.
IndexRows held_photons(const PhotonSample& sample, std::size_t map_count);
/// The number of them in both maps of a patch.
inline std::uint32_t held_by_patch(const IndexRows& held, std::uint32_t patch) {
  return held.first[2 * patch + 2] - held.first[2 * patch];
}

/// Whether a point lies at most `radius` metres from the box of a patch.
bool is_within(const PatchShape& shape, const glm::dvec3& point, double radius);

}  // namespace photile::groups
