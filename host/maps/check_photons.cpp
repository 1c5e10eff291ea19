#include "maps/check_photons.hpp"

#include <cmath>

namespace photile::maps {
namespace {

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

}  // namespace

std::string problem_of(const Photons& photons, const SceneNeeds& needs,
                       std::uint64_t sided_triangles) {
  if (!has_all_arrays(photons, needs)) return "arrays of different lengths";
  if (!are_rows(photons.first_of, sided_triangles, photons.size()) || !are_in_their_rows(photons)) {
    return "photons out of the order of their triangles";
  }
  if (!all_below(photons.light, needs.light_count)) return "photons of a light that is not there";
  if (!all_finite(photons.position) || !all_finite(photons.flux) || !all_finite(photons.incoming)) {
    return "photons that are NaN or infinite";
  }
  return {};
}

}  // namespace photile::maps
