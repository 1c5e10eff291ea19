#include "maps/check_photons.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

namespace photile::maps {
namespace {

/// Whether `holds(first, last)` for all parts of [0, count), which threads share.
template <class Holds>
bool all_parts(std::size_t count, std::size_t part, const Holds& holds) {
  using Range = tbb::blocked_range<std::size_t>;
  return tbb::parallel_reduce(
      Range(0, count, part), true,
      [&](const Range& range, bool held) { return held && holds(range.begin(), range.end()); },
      [](bool a, bool b) { return a && b; });
}

bool all_finite(const std::vector<glm::vec3>& values) {
  return all_parts(values.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    return std::all_of(values.begin() + static_cast<std::ptrdiff_t>(first),
                       values.begin() + static_cast<std::ptrdiff_t>(last), [](const glm::vec3& v) {
                         return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
                       });
  });
}

bool has_all_arrays(const Photons& photons, const SceneNeeds& needs) {
  const std::size_t count = photons.size();
  return photons.flux.size() == count && photons.oriented_face.size() == count &&
         photons.incoming.size() == (needs.glossy ? count : 0) &&
         photons.light.size() == (needs.several_lights() ? count : 0);
}

/// Whether photons lie in the rows of their oriented faces.
bool are_in_their_rows(const Photons& photons) {
  return all_parts(photons.first_of.size() - 1, 1 << 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t face = first; face < last; ++face) {
      for (std::uint32_t i = photons.first_of[face]; i < photons.first_of[face + 1]; ++i) {
        if (photons.oriented_face[i] != face) return false;
      }
    }
    return true;
  });
}

}  // namespace

std::string problem_of(const Photons& photons, const SceneNeeds& needs,
                       std::uint64_t oriented_faces) {
  if (!has_all_arrays(photons, needs)) return "arrays of different lengths";
  if (!are_rows(photons.first_of, oriented_faces, photons.size()) || !are_in_their_rows(photons)) {
    return "photons that are not in the order of their triangles";
  }
  if (!all_below(photons.light, needs.light_count)) return "photons of a light that does not exist";
  if (!all_finite(photons.position) || !all_finite(photons.flux) || !all_finite(photons.incoming)) {
    return "photons that are NaN or infinite";
  }
  return {};
}

}  // namespace photile::maps
