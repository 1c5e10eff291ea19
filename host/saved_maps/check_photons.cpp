#include "saved_maps/check_photons.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "photile/scene_needs.hpp"

namespace photile::saved_maps {
namespace {

/// Rows of compressed sparse rows: from 0, ascending, to the number of elements.
template <class T>
bool are_rows(const std::vector<T>& first, std::uint64_t rows, std::uint64_t elements) {
  return first.size() == rows + 1 && first.front() == 0 && first.back() == elements &&
         std::is_sorted(first.begin(), first.end());
}

template <class T>
bool all_below(const std::vector<T>& values, std::uint64_t end) {
  return std::all_of(values.begin(), values.end(), [&](T value) { return value < end; });
}

bool all_finite(const std::vector<glm::vec3>& values) {
  return std::all_of(values.begin(), values.end(), [](const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  });
}

bool has_all_arrays(const Photons& photons, const SceneNeeds& needs) {
  const std::size_t count = photons.size();
  return photons.flux.size() == count && photons.sided_triangle.size() == count &&
         photons.incoming.size() == (needs.glossy ? count : 0) &&
         photons.light.size() == (needs.several_lights() ? count : 0);
}

/// Whether photons lie in the rows of their sided triangles.
bool are_in_their_rows(const Photons& photons) {
  for (std::size_t sided = 0; sided + 1 < photons.first_of.size(); ++sided) {
    for (std::uint32_t i = photons.first_of[sided]; i < photons.first_of[sided + 1]; ++i) {
      if (photons.sided_triangle[i] != sided) return false;
    }
  }
  return true;
}

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
  const SceneNeeds needs = needs_of(scene);
  const Photons& photons = prepared.photons;
  const NeighbourGroups& groups = prepared.groups;
  if (!has_all_arrays(photons, needs)) return "arrays of different lengths";
  if (!are_rows(photons.first_of, sided_triangles, photons.size()) || !are_in_their_rows(photons)) {
    return "photons out of the order of their triangles";
  }
  if (!all_below(photons.light, needs.light_count)) return "photons of a light that is not there";
  if (photons.emitted_per_light.size() != scene.lights.size()) return "another number of lights";
  if (!all_finite(photons.position) || !all_finite(photons.flux) || !all_finite(photons.incoming)) {
    return "photons that are NaN or infinite";
  }
  if (!are_patches(groups.patches, sided_triangles)) return "patches that do not fit the scene";
  const std::uint64_t maps =
      groups.patches.empty() ? sided_triangles : 2 * std::uint64_t{groups.patches.count()};
  if (!are_rows(groups.offsets, sided_triangles, groups.members.size()) ||
      !all_below(groups.members, maps)) {
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
