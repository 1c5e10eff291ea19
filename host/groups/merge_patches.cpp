// Patches that hold mostly the same photons become one: the inner side of a thin plate joins the
// outer side of its other face, and small parts of a curved body join their neighbours.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/radix_sort.hpp"
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

/// What patches share with those that hold more, in the order of their numbers.
///   held   per patch: photons of the sample
std::vector<Sharing> find_sharings(const PhotonSample& sample,
                                   std::span<const std::uint32_t> held) {
  // A pair of patches is one number, and an entry of the list below for each photon they share.
  const int patch_bits = std::bit_width(held.size());
  const auto is_larger = [&](std::uint32_t other, std::uint32_t patch) {
    return held[patch] < held[other] || (held[patch] == held[other] && patch > other);
  };
  constexpr std::size_t photons_per_task = 1024;
  const std::size_t task_count = (sample.size() + photons_per_task - 1) / photons_per_task;
  std::vector<std::vector<std::uint64_t>> of_task(task_count);
  tbb::parallel_for(std::size_t{0}, task_count, [&](std::size_t task) {
    const std::size_t last = std::min(sample.size(), (task + 1) * photons_per_task);
    for (std::size_t photon = task * photons_per_task; photon < last; ++photon) {
      for (const std::uint32_t map : sample.maps_of(photon)) {
        for (const std::uint32_t other : sample.maps_of(photon)) {
          if (map / 2 == other / 2 || !is_larger(other / 2, map / 2)) continue;
          const std::uint64_t pair = std::uint64_t{map / 2} << patch_bits | other / 2;
          of_task[task].push_back(pair << 1 | ((map ^ other) & 1));
        }
      }
    }
  });
  std::vector<std::uint64_t> shared;
  for (const auto& pairs : of_task) shared.insert(shared.end(), pairs.begin(), pairs.end());
  geometry::radix_sort(shared, 2 * patch_bits + 1, [](std::uint64_t pair) { return pair; });

  std::vector<Sharing> sharings;
  const std::uint64_t patch_mask = (std::uint64_t{1} << patch_bits) - 1;
  for (std::size_t first = 0, last = 0; first < shared.size(); first = last) {
    while (last < shared.size() && shared[last] == shared[first]) ++last;
    sharings.push_back({static_cast<std::uint32_t>(shared[first] >> (patch_bits + 1)),
                        static_cast<std::uint32_t>(shared[first] >> 1 & patch_mask),
                        static_cast<std::uint32_t>(shared[first] & 1),
                        static_cast<std::uint32_t>(last - first)});
  }
  return sharings;
}

/// For each patch that has one, the partner that holds most of its photons, if they are enough; the
/// fullest share first.
std::vector<Sharing> find_partners(const PhotonSample& sample, const PatchFacts& facts,
                                   double radius) {
  const std::vector<NormalSpread>& spreads = facts.spreads;
  const std::size_t patch_count = spreads.size();
  const HeldPhotons lists(sample, 2 * patch_count);
  std::vector<std::uint32_t> held(patch_count);
  for (std::uint32_t patch = 0; patch < patch_count; ++patch) held[patch] = lists.of_patch(patch);
  std::vector<Sharing> candidates = find_sharings(sample, held);
  std::erase_if(candidates, [&](const Sharing& sharing) {
    return sharing.photons < least_shared * held[sharing.patch];
  });
  std::vector<std::size_t> first_of;  // candidates of one patch
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i == 0 || candidates[i].patch != candidates[i - 1].patch) first_of.push_back(i);
  }
  first_of.push_back(candidates.size());

  const auto joins = [&](const Sharing& found) {
    const NormalSpread& other = spreads[found.other];
    const bool bends = other.flat() && !other.joined(spreads[found.patch], found.turned).flat();
    if (bends && found.photons < least_saved_by_bending * held[found.other]) return false;
    const double most_in_vain = found.photons / least_shared_around - held[found.patch];
    return !holds_more_in_vain(most_in_vain, found, facts.shapes[found.patch], sample, lists,
                               radius);
  };
  std::vector<Sharing> best(first_of.size() - 1, Sharing{none, none, 0, 0});
  tbb::parallel_for(std::size_t{0}, best.size(), [&](std::size_t i) {
    const std::span own = std::span(candidates).subspan(first_of[i], first_of[i + 1] - first_of[i]);
    std::stable_sort(own.begin(), own.end(),
                     [](const Sharing& a, const Sharing& b) { return a.photons > b.photons; });
    const auto found = std::find_if(own.begin(), own.end(), joins);
    if (found != own.end()) best[i] = *found;
  });
  std::erase_if(best, [](const Sharing& sharing) { return sharing.patch == none; });
  std::stable_sort(best.begin(), best.end(), [&](const Sharing& a, const Sharing& b) {
    return std::uint64_t{a.photons} * held[b.patch] > std::uint64_t{b.photons} * held[a.patch];
  });
  return best;
}

}  // namespace

NeighbourGroups merge_patches(const Scene& scene, NeighbourGroups groups, const Photons& photons) {
  const std::size_t count = groups.patches.count();
  if (count < 2 || photons.size() == 0) return groups;
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
