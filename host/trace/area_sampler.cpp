#include "trace/area_sampler.hpp"

#include <algorithm>
#include <string>

#include "photile/errors.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

AreaSampler::AreaSampler(const Scene& scene, const Light& light) : light_(&light) {
  double area = 0;
  area_up_to_.reserve(light.triangles.size());
  for (const std::uint32_t triangle : light.triangles)
    area_up_to_.push_back(area += triangle_area(scene, triangle));
  if (!(area > 0))
    throw InputError(scene.source.string() + ": area light '" + light.name + "' has " +
                     std::to_string(light.triangles.size()) +
                     " triangles and no area; give it a surface or remove it");
  if (light.emission_texture != none) cells_.emplace(scene, light);
}

double AreaSampler::density(const TriangleHit& where) const {
  if (cells_) return cells_->density({where.triangle, double{where.u}, double{where.v}});
  return 1 / area_up_to_.back();
}

TriangleHit AreaSampler::sample(const RandomBlock& random) const {
  if (cells_) {
    const auto place =
        cells_->sample(random.uniform_double(0), random.uniform(2), random.uniform(3));
    return {place.triangle, static_cast<float>(place.u), static_cast<float>(place.v)};
  }
  const double target = random.uniform_double(0) * area_up_to_.back();
  // The last entry is larger than the target, so there always is one.
  const auto chosen = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), target);
  const glm::vec2 uv = sample_triangle(random.uniform(2), random.uniform(3));
  return {light_->triangles[static_cast<std::size_t>(chosen - area_up_to_.begin())], uv.x, uv.y};
}

}  // namespace photile::trace
