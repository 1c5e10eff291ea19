// Patches that hold mostly the same photons become one: the inner side of a thin plate joins the
// outer side of its other face, and small parts of a curved body join their neighbours.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "groups/patch_shape.hpp"
#include "groups/patch_union.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile {
namespace {

using namespace groups;

constexpr std::size_t sample_size = 32'768;  ///< photons that sharing is estimated from

/// A patch joins another that already holds this part of its photons. With less, the queries of
/// either would look at too many photons of the other in vain.
constexpr double least_shared = 0.75;

/// Normals this close to the axis leave a map flat: no query needs to look at normals. A flat map that
/// a join would bend must save this part of its references by it, for every query will pay.
constexpr double flat_angle = 0.17;  // radians
constexpr double least_saved_by_bending = 0.3;

constexpr int most_rounds = 8;

/// The maps that some photons enter, one list per photon.
struct Sample {
  std::vector<std::uint32_t> first_of{0};
  std::vector<std::uint32_t> maps;
};

double gap(double coordinate, double low, double high) {
  return std::max({low - coordinate, coordinate - high, 0.0});
}

bool is_within(const PatchShape& shape, const glm::dvec3& p, double radius) {
  const double u = gap(glm::dot(p, shape.u_axis), shape.low.x, shape.high.x);
  const double v = gap(glm::dot(p, shape.v_axis), shape.low.y, shape.high.y);
  const double h = gap(glm::dot(p, shape.axis), shape.low.z, shape.high.z);
  return u * u + v * v + h * h <= radius * radius;
}

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

Sample sample_photons(std::span<const PatchShape> shapes, const NeighbourGroups& groups,
                      const Photons& photons) {
  const std::size_t step = std::max<std::size_t>(1, photons.size() / sample_size);
  Sample sample;
  for (std::size_t i = step / 2; i < photons.size(); i += step) {
    const glm::dvec3 position(photons.position[i]);
    for (const std::uint32_t map : groups.of(photons.sided_triangle[i])) {
      if (is_within(shapes[map / 2], position, groups.radius)) sample.maps.push_back(map);
    }
    sample.first_of.push_back(static_cast<std::uint32_t>(sample.maps.size()));
  }
  return sample;
}

/// How many photons of the sample two patches share: front with front (turned = 0) and back with
/// back, or crosswise.
struct Sharing {
  std::uint32_t patch, other, turned, photons;
};

std::uint64_t key_of(std::uint32_t patch, std::uint32_t other, std::uint32_t turned) {
  return std::uint64_t{patch} << 33 | std::uint64_t{other} << 1 | turned;
}

/// For each patch that has one, the partner that holds most of its photons, if they are enough; the
/// fullest share first.
std::vector<Sharing> find_partners(const Sample& sample, std::span<const NormalSpread> spreads) {
  const std::size_t patch_count = spreads.size();
  std::vector<std::uint32_t> held(patch_count, 0);
  std::unordered_map<std::uint64_t, std::uint32_t> shared;
  for (std::size_t i = 0; i + 1 < sample.first_of.size(); ++i) {
    for (std::uint32_t a = sample.first_of[i]; a < sample.first_of[i + 1]; ++a) {
      const std::uint32_t map = sample.maps[a];
      ++held[map / 2];
      for (std::uint32_t b = sample.first_of[i]; b < sample.first_of[i + 1]; ++b) {
        const std::uint32_t other = sample.maps[b];
        if (other / 2 != map / 2) ++shared[key_of(map / 2, other / 2, (map ^ other) & 1)];
      }
    }
  }
  std::vector<Sharing> best(patch_count, Sharing{none, none, 0, 0});
  for (const auto& [key, photons] : shared) {
    const Sharing found{static_cast<std::uint32_t>(key >> 33),
                        static_cast<std::uint32_t>(key >> 1), static_cast<std::uint32_t>(key & 1),
                        photons};
    const bool into_larger = held[found.patch] < held[found.other] ||
                             (held[found.patch] == held[found.other] && found.patch > found.other);
    Sharing& known = best[found.patch];
    // Ties go to the smaller number, for the order of a hash table is nobody's.
    const bool better = photons > known.photons ||
                        (photons == known.photons && key < key_of(known.patch, known.other,
                                                                  known.turned));
    if (!into_larger || !better || photons < least_shared * held[found.patch]) continue;
    const NormalSpread& other = spreads[found.other];
    const bool bends = other.flat() && !other.joined(spreads[found.patch], found.turned).flat();
    if (bends && photons < least_saved_by_bending * held[found.other]) continue;
    known = found;
  }
  std::erase_if(best, [](const Sharing& sharing) { return sharing.patch == none; });
  std::stable_sort(best.begin(), best.end(), [&](const Sharing& a, const Sharing& b) {
    return std::uint64_t{a.photons} * held[b.patch] > std::uint64_t{b.photons} * held[a.patch];
  });
  return best;
}

/// Sorted lists of maps after a renaming, each map once.
template <class Offset>
void rename(std::vector<Offset>& offsets, std::vector<std::uint32_t>& maps,
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

}  // namespace

NeighbourGroups merge_patches(const Scene& scene, NeighbourGroups groups, const Photons& photons) {
  const std::size_t count = groups.patches.count();
  if (count < 2 || photons.size() == 0) return groups;
  const TriangleFacts facts(scene);
  const std::vector<PatchShape> shapes = shapes_of(scene, facts, groups.patches);
  std::vector<NormalSpread> spreads;
  for (std::size_t patch = 0; patch < count; ++patch) {
    spreads.push_back(spread_of(facts, groups.patches.of(patch), shapes[patch]));
  }
  Sample sample = sample_photons(shapes, groups, photons);
  PatchUnion merged(count);
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<bool> taken(count, false);
    bool changed = false;
    for (const Sharing& sharing : find_partners(sample, spreads)) {
      if (taken[sharing.patch] || taken[sharing.other]) continue;
      taken[sharing.patch] = true;  // its photons are another's now: others wait for the next round
      merged.join(sharing.patch, sharing.other, sharing.turned);
      spreads[sharing.other] = spreads[sharing.other].joined(spreads[sharing.patch], sharing.turned);
      changed = true;
    }
    if (!changed) break;
    rename(sample.first_of, sample.maps, merged);
  }
  merged.number();
  rename(groups.offsets, groups.members, merged);
  groups.patches = merged.apply(groups.patches);
  return groups;
}

}  // namespace photile
