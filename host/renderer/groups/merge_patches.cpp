#include "groups/merge_patches.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "groups/patch_shape.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"

namespace photile::groups {

PatchUnion::PatchUnion(std::size_t patch_count) : parent_(patch_count) {
  for (std::uint32_t patch = 0; patch < patch_count; ++patch) parent_[patch] = 2 * patch;
}

void PatchUnion::join(std::uint32_t patch, std::uint32_t other, std::uint32_t turned) {
  parent_[patch] = 2 * other + turned;
}

std::uint32_t PatchUnion::map(std::uint32_t map) const {
  while (parent_[map / 2] / 2 != map / 2) map = parent_[map / 2] ^ (map & 1u);
  return number_.empty() ? map : 2 * number_[map / 2] + (map & 1u);
}

void PatchUnion::number() {
  std::vector<std::uint32_t> numbers(parent_.size(), none);
  std::uint32_t next = 0;
  for (std::uint32_t patch = 0; patch < parent_.size(); ++patch) {
    const std::uint32_t representative = map(2 * patch) / 2;
    if (numbers[representative] == none) numbers[representative] = next++;
  }
  number_ = std::move(numbers);
}

Patches PatchUnion::apply(const Patches& patches) const {
  Patches joined;
  joined.map_of.resize(patches.map_of.size());
  std::transform(patches.map_of.begin(), patches.map_of.end(), joined.map_of.begin(),
                 [this](std::uint32_t old) { return map(old); });
  std::uint32_t count = 0;
  for (const std::uint32_t map : joined.map_of) count = std::max(count, map / 2 + 1);
  IndexRows members = rows_of(count, [&](const auto& put) {
    for (std::uint32_t s = 0; s < joined.map_of.size(); s += 2) {
      const std::uint32_t map = joined.map_of[s];
      put(map / 2, s + (map & 1u));  // the side that map 2 p holds
    }
  });
  joined.first_of = std::move(members.first);
  joined.members = std::move(members.items);
  return joined;
}

namespace {

constexpr std::uint64_t sample_size = 32'768;

double gap(double coordinate, double low, double high) {
  return std::max({low - coordinate, coordinate - high, 0.0});
}

}  // namespace

std::uint64_t sample_step(std::uint64_t photons) {
  return std::max<std::uint64_t>(1, photons / sample_size);
}

bool is_within(const PatchShape& shape, const glm::dvec3& point, double radius) {
  const double u = gap(glm::dot(point, shape.u_axis), shape.low.x, shape.high.x);
  const double v = gap(glm::dot(point, shape.v_axis), shape.low.y, shape.high.y);
  const double h = gap(glm::dot(point, shape.axis), shape.low.z, shape.high.z);
  return u * u + v * v + h * h <= radius * radius;
}

PhotonSample::PhotonSample(std::span<const PatchShape> shapes, const NeighbourGroups& groups,
                           const Photons& photons) {
  std::vector<std::uint32_t> triangles;
  if (photons.of_all) {
    position_.assign(photons.of_all->sample.begin(), photons.of_all->sample.end());
    triangles = photons.of_all->sample_triangle;
  } else {
    const std::size_t step = sample_step(photons.size());
    for (std::size_t i = step / 2; i < photons.size(); i += step) {
      position_.emplace_back(photons.position[i]);
      triangles.push_back(photons.oriented_face[i]);
    }
  }
  std::vector<std::vector<std::uint32_t>> maps(position_.size());
  tbb::parallel_for(std::size_t{0}, position_.size(), [&](std::size_t i) {
    for (const std::uint32_t map : groups.of(triangles[i])) {
      if (is_within(shapes[map / 2], position_[i], groups.radius)) maps[i].push_back(map);
    }
  });
  for (const std::vector<std::uint32_t>& entered : maps) {
    maps_.insert(maps_.end(), entered.begin(), entered.end());
    first_of_.push_back(static_cast<std::uint32_t>(maps_.size()));
  }
}

void PhotonSample::rename(const PatchUnion& patches) { rename_maps(first_of_, maps_, patches); }

IndexRows held_photons(const PhotonSample& sample, std::size_t map_count) {
  return rows_of(map_count, [&](const auto& put) {
    for (std::uint32_t photon = 0; photon < sample.size(); ++photon) {
      for (const std::uint32_t map : sample.maps_of(photon)) put(map, photon);
    }
  });
}

}  // namespace photile::groups

namespace photile {

// Patches that hold mostly the same photons become one: the inner side of a thin plate joins the
// outer side of its other face, and small parts of a curved body join their neighbours.

namespace {

using namespace groups;

/// A patch joins another that already holds this part of its photons.
constexpr double least_shared = 0.65;

/// These must be at least as large a part of what the joined patch would hold around it. With less,
/// the queries of either would look at too many photons of the other in vain: of the bright side of
/// a light for a hit on its unlit side.
constexpr double least_shared_around = 0.5;

/// Normals this close to the axis leave a map flat: no query needs to look at normals. A flat map
/// that a join would bend must save this part of its references by it, because every query becomes
/// slower.
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
                        const PhotonSample& sample, const IndexRows& held, double radius) {
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
  SharingCounter(const PhotonSample& sample, const IndexRows& held, std::size_t patch_count)
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
    const std::uint32_t own = held_by_patch(held_, patch);
    std::vector<Sharing> enough;
    for (const std::uint32_t sharing : met_) {
      const std::uint32_t other = sharing / 2, photons = std::exchange(counts_[sharing], 0);
      const std::uint32_t others = held_by_patch(held_, other);
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
  const IndexRows& held_;
  std::vector<std::uint32_t> counts_;  ///< per map of another patch; 0 between two patches
  std::vector<std::uint32_t> met_;     ///< whose counts are not 0
};

/// For each patch that has one, the partner that holds most of its photons, if they are enough; the
/// fullest share first.
std::vector<Sharing> find_partners(const PhotonSample& sample, const PatchFacts& facts,
                                   double radius) {
  const std::vector<NormalSpread>& spreads = facts.spreads;
  const std::size_t patch_count = spreads.size();
  const IndexRows held = held_photons(sample, 2 * patch_count);
  const auto joins = [&](const Sharing& found) {
    const NormalSpread& other = spreads[found.other];
    const bool bends = other.flat() && !other.joined(spreads[found.patch], found.turned).flat();
    if (bends && found.photons < least_saved_by_bending * held_by_patch(held, found.other))
      return false;
    const double most_in_vain =
        found.photons / least_shared_around - held_by_patch(held, found.patch);
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
    return std::uint64_t{a.photons} * held_by_patch(held, b.patch) >
           std::uint64_t{b.photons} * held_by_patch(held, a.patch);
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
