// A sample of the photons, by the maps that they enter.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "groups/patch_shape.hpp"
#include "groups/patch_union.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"

namespace photile::groups {

/// From one photon of a sample to the next, of so many: about 32,768 are left. The first is half a
/// step from the first of all.
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

/// The photons of a sample that a map holds.
class HeldPhotons {
 public:
  HeldPhotons(const PhotonSample& sample, std::size_t map_count);

  /// Ascending.
  std::span<const std::uint32_t> of(std::uint32_t map) const {
    return {photons_.data() + first_of_[map], photons_.data() + first_of_[map + 1]};
  }
  /// Of both maps of a patch.
  std::uint32_t of_patch(std::uint32_t patch) const {
    return first_of_[2 * patch + 2] - first_of_[2 * patch];
  }

 private:
  std::vector<std::uint32_t> first_of_, photons_;
};

/// Whether a point lies at most `radius` metres from the box of a patch.
bool is_within(const PatchShape& shape, const glm::dvec3& point, double radius);

}  // namespace photile::groups
