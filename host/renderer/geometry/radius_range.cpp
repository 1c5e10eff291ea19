#include "geometry/radius_range.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

double scene_diagonal(const Scene& scene) { return 2 * bounding_sphere(scene).radius; }

double least_radius(const Scene& scene) {
  return std::max(limits::min_radius, limits::min_radius_over_scene * scene_diagonal(scene));
}

void check_radius(const Scene& scene, double radius) {
  const double least = least_radius(scene);
  if (radius >= least && radius <= limits::max_radius) return;
  throw UsageError(fmt::format("radius {} m: must be between {:.3g} and {:.3g} m in this scene",
                               radius, least, limits::max_radius));
}

}  // namespace photile
