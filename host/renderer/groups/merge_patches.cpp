// Patches that hold mostly the same photons become one: the inner side of a thin plate joins the
// outer side of its other face, and small parts of a curved body join their neighbours.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "groups/patch_shape.hpp"
#include "groups/patch_union.hpp"
#include "groups/photon_sample.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"

namespace photile {
namespace {

using namespace groups;

/// A patch joins another that already holds this part of its photons.
constexpr double least_shared = 0.65;

/// At least as large a part must those be of what the joined patch would hold around it. With less,
/// the queries of either would look at too many photons of the other in vain: of the bright side of
/// a lamp for a hit on its dark side.
constexpr double least_shared_around = 0.5;

/// Normals this close to the axis leave a map flat: no query needs to look at normals. A flat map
/// that a join would bend must save this part of its references by it, for every query will pay.
constexpr double flat_angle = 0.17;  // radians
constexpr double least_saved_by_bending = 0.3;

constexpr int most_rounds = 8;

/// The normals of a patch, on the sides of its front map: all within `lean` radians of the axis.
struct NormalSpread {
  glm::dvec3 axis{0.0};
  double lean = 0;

  bool flat() const { return lean <= flat_angle; }
  /// Covers another patch's, too; `turned` puts its front to this one's back.
  NormalSpread joined(const NormalSpread& other, bool turned) const {
    const double cosine = glm::dot(axis, turned ? -other.axis : other.axis);
    return {axis, std::max(lean, std::acos(std::clamp(cosine, -1.0, 1.0)) + other.lean)};
  }
};

NormalSpread spread_of(const TriangleFacts& facts, std::span<const std::uint32_t> members,
                       const PatchShape& shape) {
  double sum = 0, least = 1, most = -1;
  for (const std::uint32_t member : members) {
    const double side = side_of(member) == 0 ? 1 : -1;
    const double cosine =
        side * glm::dot(glm::dvec3(facts.normal[triangle_of(member)]), shape.axis);
    sum += cosine;
    least = std::min(least, cosine);
    most = std::max(most, cosine);
  }
  const double worst = sum < 0 ? -most : least;
  return {sum < 0 ? -shape.axis : shape.axis, std::acos(std::clamp(worst, -1.0, 1.0))};
}

struct PatchFacts {
  std::vector<PatchShape> shapes;
  std::vector<NormalSpread> spreads;
};

PatchFacts facts_of(const Scene& scene, const Patches& patches) {
  const TriangleFacts facts(scene);
  PatchFacts result{std::vector<PatchShape>(patches.count()),
                    std::vector<NormalSpread>(patches.count())};
  tbb::parallel_for(std::size_t{0}, patches.count(), [&](std::size_t patch) {
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t member : patches.of(patch)) triangles.push_back(triangle_of(member));
    result.shapes[patch] = shape_of(scene, facts, triangles);
    result.spreads[patch] = spread_of(facts, patches.of(patch), result.shapes[patch]);
  });
  return result;
}

/// How many photons of the sample two patches share: front with front (turned = 0) and back with
/// back, or crosswise.
struct Sharing {
  std::uint32_t patch, other, turned, photons;
};

/// Whether more than `most` photons that the other patch holds around this one are not this one's:
/// what its queries would look at in vain if the two were joined.
bool holds_more_in_vain(double most, const Sharing& sharing, const PatchShape& shape,
                        const PhotonSample& sample, const HeldPhotons& held, double radius) {
  std::uint32_t count = 0;
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::span own = held.of(2 * sharing.patch + side);
    auto next = own.begin();
    for (const std::uint32_t photon : held.of(2 * sharing.other + (side ^ sharing.turned))) {
      next = std::lower_bound(next, own.end(), photon);
      const bool is_own = next != own.end() && *next == photon;
      if (is_own || !is_within(shape, sample.position(photon), radius)) continue;
      if (++count > most) return true;
    }
  }
  return count > most;
}

/// What a patch shares with those that hold more, where that is enough to join one; the fullest
/// share first.
class SharingCounter {
 public:
  SharingCounter(const PhotonSample& sample, const HeldPhotons& held, std::size_t patch_count)
      : sample_(sample), held_(held), counts_(2 * patch_count, 0) {}

  std::vector<Sharing> of(std::uint32_t patch) {
    for (const std::uint32_t map : {2 * patch, 2 * patch + 1}) {
      for (const std::uint32_t photon : held_.of(map)) {
        for (const std::uint32_t other : sample_.maps_of(photon)) {
          const std::uint32_t sharing =
              other ^ (map & 1);  // of that patch, its side relative to ours
          if (counts_[sharing]++ == 0) met_.push_back(sharing);
        }
      }
    }
    const std::uint32_t own = held_.of_patch(patch);
    std::vector<Sharing> enough;
    for (const std::uint32_t sharing : met_) {
      const std::uint32_t other = sharing / 2, photons = std::exchange(counts_[sharing], 0);
      const std::uint32_t others = held_.of_patch(other);
      const bool holds_more = own < others || (own == others && patch > other);
      if (other == patch || !holds_more || photons < least_shared * own) continue;
      enough.push_back({patch, other, sharing & 1, photons});
    }
    met_.clear();
    std::sort(enough.begin(), enough.end(), [](const Sharing& a, const Sharing& b) {
      return std::tuple(b.photons, a.other, a.turned) < std::tuple(a.photons, b.other, b.turned);
    });
    return enough;
  }

 private:
  const PhotonSample& sample_;
  const HeldPhotons& held_;
  std::vector<std::uint32_t> counts_;  ///< per map of another patch; 0 between two patches
  std::vector<std::uint32_t> met_;     ///< whose counts are not 0
};

/// For each patch that has one, the partner that holds most of its photons, if they are enough; the
/// fullest share first.
std::vector<Sharing> find_partners(const PhotonSample& sample, const PatchFacts& facts,
                                   double radius) {
  const std::vector<NormalSpread>& spreads = facts.spreads;
  const std::size_t patch_count = spreads.size();
  const HeldPhotons held(sample, 2 * patch_count);
  const auto joins = [&](const Sharing& found) {
    const NormalSpread& other = spreads[found.other];
    const bool bends = other.flat() && !other.joined(spreads[found.patch], found.turned).flat();
    if (bends && found.photons < least_saved_by_bending * held.of_patch(found.other)) return false;
    const double most_in_vain = found.photons / least_shared_around - held.of_patch(found.patch);
    return !holds_more_in_vain(most_in_vain, found, facts.shapes[found.patch], sample, held,
                               radius);
  };
  std::vector<Sharing> best(patch_count, Sharing{none, none, 0, 0});
  tbb::enumerable_thread_specific<SharingCounter> counter(sample, held, patch_count);
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(patch_count)),
                    [&](const tbb::blocked_range<std::uint32_t>& patches) {
                      SharingCounter& counts = counter.local();
                      for (std::uint32_t patch = patches.begin(); patch != patches.end(); ++patch) {
                        const std::vector<Sharing> sharings = counts.of(patch);
                        const auto found = std::find_if(sharings.begin(), sharings.end(), joins);
                        if (found != sharings.end()) best[patch] = *found;
                      }
                    });
  std::erase_if(best, [](const Sharing& sharing) { return sharing.patch == none; });
  std::stable_sort(best.begin(), best.end(), [&](const Sharing& a, const Sharing& b) {
    return std::uint64_t{a.photons} * held.of_patch(b.patch) >
           std::uint64_t{b.photons} * held.of_patch(a.patch);
  });
  return best;
}

}  // namespace

NeighbourGroups merge_patches(const Scene& scene, NeighbourGroups groups, const Photons& photons) {
  const std::size_t count = groups.patches.count();
  if (count < 2 || photons.total() == 0) return groups;
  check_scene(scene);
  PatchFacts facts = facts_of(scene, groups.patches);
  PhotonSample sample(facts.shapes, groups, photons);
  PatchUnion merged(count);
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<bool> taken(count, false);
    bool changed = false;
    for (const Sharing& sharing : find_partners(sample, facts, groups.radius)) {
      if (taken[sharing.patch] || taken[sharing.other]) continue;
      taken[sharing.patch] = true;  // its photons are another's now: others wait for the next round
      merged.join(sharing.patch, sharing.other, sharing.turned);
      NormalSpread& spread = facts.spreads[sharing.other];
      spread = spread.joined(facts.spreads[sharing.patch], sharing.turned);
      changed = true;
    }
    if (!changed) break;
    sample.rename(merged);
  }
  merged.number();
  rename_maps(groups.offsets, groups.members, merged);
  groups.patches = merged.apply(groups.patches);
  return groups;
}

}  // namespace photile
