// Patches that hold mostly the same photons become one: the inner side of a thin plate joins the
// outer side of its other face, and small parts of a curved body join their neighbours.
#include <algorithm>
#include <cmath>
#include <unordered_map>

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
  glm::dvec3 axis;
  double lean;

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

std::vector<PatchShape> shapes_of(const Scene& scene, const TriangleFacts& facts,
                                  const Patches& patches) {
  std::vector<PatchShape> shapes;
  shapes.reserve(patches.count());
  std::vector<std::uint32_t> triangles;
  for (std::size_t patch = 0; patch < patches.count(); ++patch) {
    triangles.clear();
    for (const std::uint32_t member : patches.of(patch)) triangles.push_back(triangle_of(member));
    shapes.push_back(shape_of(scene, facts, triangles));
  }
  return shapes;
}

/// How many photons of the sample two patches share: front with front (turned = 0) and back with
/// back, or crosswise.
struct Sharing {
  std::uint32_t patch, other, turned, photons;
};

std::uint64_t key_of(std::uint32_t patch, std::uint32_t other, std::uint32_t turned) {
  return std::uint64_t{patch} << 33 | std::uint64_t{other} << 1 | turned;
}

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

/// For each patch that has one, the partner that holds most of its photons, if they are enough; the
/// fullest share first.
std::vector<Sharing> find_partners(const PhotonSample& sample, std::span<const PatchShape> shapes,
                                   std::span<const NormalSpread> spreads, double radius) {
  const std::size_t patch_count = spreads.size();
  const HeldPhotons lists(sample, 2 * patch_count);
  std::vector<std::uint32_t> held(patch_count);
  for (std::uint32_t patch = 0; patch < patch_count; ++patch) held[patch] = lists.of_patch(patch);
  std::unordered_map<std::uint64_t, std::uint32_t> shared;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    for (const std::uint32_t map : sample.maps_of(i)) {
      for (const std::uint32_t other : sample.maps_of(i)) {
        if (other / 2 != map / 2) ++shared[key_of(map / 2, other / 2, (map ^ other) & 1)];
      }
    }
  }
  std::vector<Sharing> best(patch_count, Sharing{none, none, 0, 0});
  for (const auto& [key, photons] : shared) {
    const Sharing found{static_cast<std::uint32_t>(key >> 33), static_cast<std::uint32_t>(key >> 1),
                        static_cast<std::uint32_t>(key & 1), photons};
    const bool into_larger = held[found.patch] < held[found.other] ||
                             (held[found.patch] == held[found.other] && found.patch > found.other);
    Sharing& known = best[found.patch];
    // Ties go to the smaller number, for the order of a hash table is nobody's.
    const bool better =
        photons > known.photons ||
        (photons == known.photons && key < key_of(known.patch, known.other, known.turned));
    if (!into_larger || !better || photons < least_shared * held[found.patch]) continue;
    const NormalSpread& other = spreads[found.other];
    const bool bends = other.flat() && !other.joined(spreads[found.patch], found.turned).flat();
    if (bends && photons < least_saved_by_bending * held[found.other]) continue;
    const double most_in_vain = photons / least_shared_around - held[found.patch];
    if (holds_more_in_vain(most_in_vain, found, shapes[found.patch], sample, lists, radius)) {
      continue;
    }
    known = found;
  }
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
  const TriangleFacts facts(scene);
  const std::vector<PatchShape> shapes = shapes_of(scene, facts, groups.patches);
  std::vector<NormalSpread> spreads;
  for (std::size_t patch = 0; patch < count; ++patch) {
    spreads.push_back(spread_of(facts, groups.patches.of(patch), shapes[patch]));
  }
  PhotonSample sample(shapes, groups, photons);
  PatchUnion merged(count);
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<bool> taken(count, false);
    bool changed = false;
    for (const Sharing& sharing : find_partners(sample, shapes, spreads, groups.radius)) {
      if (taken[sharing.patch] || taken[sharing.other]) continue;
      taken[sharing.patch] = true;  // its photons are another's now: others wait for the next round
      merged.join(sharing.patch, sharing.other, sharing.turned);
      spreads[sharing.other] =
          spreads[sharing.other].joined(spreads[sharing.patch], sharing.turned);
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
