// Neighbour groups: which oriented faces share photons (Graglia et al. 2012, section 2.1), and
// patches of them that share one map, so that a photon on fine triangles does not enter dozens of
// maps.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Which triangles own a photon map.
enum class MapMode {
  naive,     ///< each its own, with its own photons only (figure 1 of the paper: dark edges)
  triangle,  ///< each its own, with the photons of its neighbour group: the method of the paper
  patch,     ///< one map for all triangles of a patch
  automatic  ///< patches where they save references, single triangles elsewhere
};

/// "naive", "triangle", "patch", "auto".
std::string_view name_of(MapMode mode);
inline constexpr std::array all_map_modes = {MapMode::naive, MapMode::triangle, MapMode::patch,
                                             MapMode::automatic};

/// Triangles in disjoint sets. Patch p owns two maps: map 2 p holds the photons of its members,
/// map 2 p + 1 those of the members' other sides. Without patches each oriented face s owns map s.
struct Patches {
  std::vector<std::uint32_t> map_of;  ///< per oriented face; empty: every triangle has its own maps
  std::vector<std::uint32_t> first_of;  ///< members of patch p: members[first_of[p] ..)
  std::vector<std::uint32_t> members;   ///< oriented faces, ascending within a patch

  bool empty() const { return map_of.empty(); }
  std::size_t count() const { return first_of.empty() ? 0 : first_of.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t patch) const {
    return {members.data() + first_of[patch], members.data() + first_of[patch + 1]};
  }
  std::uint32_t map(std::uint32_t oriented_face) const {
    return empty() ? oriented_face : map_of[oriented_face];
  }
  std::uint64_t bytes() const {
    return (map_of.size() + first_of.size() + members.size()) * sizeof(std::uint32_t);
  }
};

/// Clusters triangles, connected or not, into patches: flat to a fraction of `radius`, with similar
/// normals (whichever way they are wound), and without large gaps. Patches may be any number of
/// radii wide: the wider they are, the fewer photons lie near a border and enter two maps. Empty
/// for MapMode::naive and ::triangle. Parallel; the result does not depend on the number of
/// threads.
///   radius   metres, > 0: the search radius of the maps
Patches find_patches(const Scene& scene, double radius, MapMode mode);

struct NeighbourGroupParameters {
  double radius = 0;  ///< metres, > 0: largest distance between two triangles of a group
  double angle_degrees = defaults::group_angle_degrees;  ///< largest angle between their normals
};

/// Groups in compressed sparse rows: the maps that photons of oriented face s may have to enter
/// are members[offsets[s] .. offsets[s + 1]), ascending, its own map among them. Without patches a
/// map is an oriented face, and the relation is symmetric.
struct NeighbourGroups {
  std::vector<std::uint64_t> offsets;  ///< size 2 * triangles + 1
  std::vector<std::uint32_t> members;
  Patches patches;  ///< which triangles share a map
  double radius = 0;
  double angle_degrees = 0;

  std::span<const std::uint32_t> of(std::uint32_t oriented_face) const {
    return {members.data() + offsets[oriented_face], members.data() + offsets[oriented_face + 1]};
  }
  std::uint64_t bytes() const {
    return offsets.size() * sizeof(offsets[0]) + members.size() * sizeof(members[0]) +
           patches.bytes();
  }
};

/// For each oriented face all oriented faces at most `radius` away (exact triangle-triangle
/// distance, Eberly) whose normals differ by at most the angle. A bounding volume hierarchy finds
/// the candidates; work is shared by TBB. The result does not depend on the number of threads.
/// Errors: UsageError when the radius is not positive and finite or the angle is outside [0, 180].
///   landed   per oriented face: 1 where there are photons that need a group; other faces get an
///            empty group. Empty: all faces get groups
NeighbourGroups find_neighbour_groups(const Scene& scene,
                                      const NeighbourGroupParameters& parameters,
                                      Progress& progress = Progress::none(),
                                      std::span<const std::uint8_t> landed = {});

/// Finds groups whose members are the maps of patches, by boxes: each map that holds an oriented
/// face whose normal agrees and whose box lies at most `radius` from the box of the oriented
/// face. These are slightly more maps than those with a triangle in the group; no query finds the
/// surplus photons that they hold. The search goes patch by patch, so that its time grows with the
/// patches near a triangle and not with the triangles.
NeighbourGroups find_patch_groups(const Scene& scene, Patches patches,
                                  const NeighbourGroupParameters& parameters,
                                  Progress& progress = Progress::none(),
                                  std::span<const std::uint8_t> landed = {});

/// Joins patches that hold mostly the same photons, judged by a sample: each joined pair saves the
/// references they share. Patches whose queries would test most photons in vain stay separate. What
/// a query finds does not change.
NeighbourGroups merge_patches(const Scene& scene, NeighbourGroups groups, const Photons& photons);

/// Which photons will be entered in maps by groups.
enum class MapUsers {
  these_photons,  ///< those for which the groups are made: oriented faces without photons get empty
                  ///< groups
  any_photons     ///< others as well, wherever they land
};

/// Groups for maps of a mode, as the renderer uses them: the patches of the mode, their groups, and
/// patches joined.
NeighbourGroups find_map_groups(const Scene& scene, const Photons& photons, MapMode mode,
                                const NeighbourGroupParameters& parameters,
                                Progress& progress = Progress::none(),
                                MapUsers users = MapUsers::these_photons);

/// Groups of one: every map holds the photons of its own oriented face only (figure 1 of the
/// paper: dark edges). Their radius is infinite: photons of other triangles are never searched.
NeighbourGroups naive_groups(const Scene& scene);

/// Rounding slack of the normal test, so that normals folded by exactly the angle agree although
/// their vertices were rounded to float.
inline constexpr double cosine_slack = 1e-6;

/// The normal test that groups use, so that oracles can apply the very same one.
/// `cos_angle` = cos(angle); inclusive up to cosine_slack.
bool normals_agree(const glm::dvec3& a, const glm::dvec3& b, double cos_angle);

/// A search radius in metres for `k` neighbours: defaults::radius_over_median_kth_distance times
/// the median, over a sample of photons, of the distance to the k-th nearest photon.
double automatic_radius(const Photons& photons, int k);

/// Distance between two triangles in metres, exact up to rounding in double precision, 0 where
/// they intersect (Eberly, "Distance Between Two Triangles in 3D").
double triangle_triangle_distance(const std::array<glm::dvec3, 3>& a,
                                  const std::array<glm::dvec3, 3>& b);

}  // namespace photile
