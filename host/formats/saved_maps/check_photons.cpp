#include "saved_maps/check_photons.hpp"

#include <cmath>
#include <cstdint>

#include "maps/check_photons.hpp"
#include "photile/scene_needs.hpp"

namespace photile::saved_maps {
namespace {

using maps::all_below;
using maps::are_rows;

bool are_patches(const Patches& patches, std::uint64_t sided_triangles) {
  if (patches.empty()) return patches.first_of.empty() && patches.members.empty();
  return patches.map_of.size() == sided_triangles && !patches.first_of.empty() &&
         are_rows(patches.first_of, patches.first_of.size() - 1, patches.members.size()) &&
         all_below(patches.members, sided_triangles) &&
         all_below(patches.map_of, 2 * std::uint64_t{patches.count()});
}

}  // namespace

std::string problem_of(const PreparedPhotons& prepared, const Scene& scene) {
  const std::uint64_t sided_triangles = 2 * std::uint64_t{scene.triangle_count()};
  const NeighbourGroups& groups = prepared.groups;
  const std::string problem = maps::problem_of(prepared.photons, needs_of(scene), sided_triangles);
  if (!problem.empty()) return problem;
  if (prepared.photons.emitted_per_light.size() != scene.lights.size()) {
    return "another number of lights";
  }
  if (prepared.caustics) {
    const std::string of_caustics =
        maps::problem_of(*prepared.caustics, needs_of(scene), sided_triangles);
    if (!of_caustics.empty()) return of_caustics;
  }
  if (!prepared.has_groups()) {
    const bool none = groups.offsets.empty() && groups.members.empty() && groups.patches.empty();
    return none && !prepared.light_maps ? "" : "groups without a radius";
  }
  if (!are_patches(groups.patches, sided_triangles)) return "patches that do not fit the scene";
  const std::uint64_t map_count =
      groups.patches.empty() ? sided_triangles : 2 * std::uint64_t{groups.patches.count()};
  if (!are_rows(groups.offsets, sided_triangles, groups.members.size()) ||
      !all_below(groups.members, map_count)) {
    return "groups that do not fit the scene";
  }
  // Naive groups have an infinite radius.
  if (!(prepared.radius > 0) || !std::isfinite(prepared.radius) ||
      !(groups.radius >= prepared.radius) || !(groups.angle_degrees >= 0) ||
      !(groups.angle_degrees <= 180)) {
    return "no sensible radius or angle";
  }
  return {};
}

}  // namespace photile::saved_maps
