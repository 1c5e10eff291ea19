#include "trace/emission_sampling.hpp"

#include <algorithm>
#include <string>

#include "photile/errors.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

AreaSampler::AreaSampler(const Scene& scene, const Light& light) : scene_(&scene), light_(&light) {
  double area = 0;
  area_up_to_.reserve(light.triangles.size());
  for (const std::uint32_t triangle : light.triangles)
    area_up_to_.push_back(area += triangle_area(scene, triangle));
  if (!(area > 0))
    throw InputError(scene.source.string() + ": area light '" + light.name + "' has " +
                     std::to_string(light.triangles.size()) +
                     " triangles and no area; give it a surface or remove it");
  if (light.emission_texture != none) {
    cells_.emplace(scene, light);
    return;
  }
  fronts_.reserve(light.triangles.size());
  for (const std::uint32_t triangle : light.triangles) {
    const auto [a, b, c] = scene.corners(triangle);
    const SurfacePoint front =
        surface_point(scene, {triangle, 0.0f, 0.0f}, scene.front_side[triangle]);
    fronts_.push_back({glm::dvec3(a), glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a),
                       front.normal, front.ray_offset, front.side});
  }
}

double AreaSampler::density(const TriangleHit& where) const {
  if (cells_) return cells_->density({where.triangle, double{where.u}, double{where.v}});
  return 1 / area_up_to_.back();
}

TriangleHit AreaSampler::sample(const RandomBlock& random) const {
  if (cells_) {
    const auto point =
        cells_->sample(random.uniform_double(0), random.uniform(2), random.uniform(3));
    return {point.triangle, static_cast<float>(point.u), static_cast<float>(point.v)};
  }
  const glm::vec2 uv = sample_triangle(random.uniform(2), random.uniform(3));
  return {light_->triangles[chosen(random)], uv.x, uv.y};
}

SurfacePoint AreaSampler::sample_front(const RandomBlock& random) const {
  if (cells_) {
    const TriangleHit where = sample(random);
    return surface_point(*scene_, where, scene_->front_side[where.triangle]);
  }
  return sample_front_of(chosen(random), random);
}

SurfacePoint AreaSampler::sample_front_of(std::size_t number, const RandomBlock& random) const {
  const Front& front = fronts_[number];
  const glm::vec2 uv = sample_triangle(random.uniform(2), random.uniform(3));
  SurfacePoint point;
  point.where = {light_->triangles[number], uv.x, uv.y};
  point.side = front.side;
  point.position =
      glm::vec3(front.corner + double{uv.x} * front.along_u + double{uv.y} * front.along_v);
  point.normal = front.normal;
  point.ray_offset = front.ray_offset;
  return point;
}

/// One of the triangles, chosen by area.
std::size_t AreaSampler::chosen(const RandomBlock& random) const {
  const double target = random.uniform_double(0) * area_up_to_.back();
  // The last entry is larger than the target, so there always is one.
  const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), target);
  return static_cast<std::size_t>(found - area_up_to_.begin());
}

IntensitySampler::IntensitySampler(const Scene& scene, const Light& light)
    : distribution_(&scene.distributions[light.distribution]), axes_(light) {
  double flux = 0;
  flux_up_to_.reserve(distribution_->columns() * distribution_->rows());
  for (std::size_t column = 0; column < distribution_->columns(); ++column)
    for (std::size_t row = 0; row < distribution_->rows(); ++row)
      flux_up_to_.push_back(flux += distribution_->cell_flux(column, row));
}

glm::vec3 IntensitySampler::sample(const RandomStream& random) const {
  const double target = random.block(Purpose::emission, 0).uniform_double(0) * flux_up_to_.back();
  // The last entry is larger than the target, so there always is one.
  const auto chosen = static_cast<std::size_t>(
      std::upper_bound(flux_up_to_.begin(), flux_up_to_.end(), target) - flux_up_to_.begin());
  const std::size_t column = chosen / distribution_->rows(), row = chosen % distribution_->rows();
  const double largest = distribution_->cell_maximum(column, row);
  for (std::uint32_t tries = 1;; ++tries) {
    const RandomBlock numbers = random.block(Purpose::emission, tries);
    const auto point =
        distribution_->in_cell(column, row, numbers.uniform_double(0), numbers.uniform(2));
    if (numbers.uniform(3) * largest < point.intensity)
      return glm::vec3(axes_.to_world(point.direction));
  }
}

}  // namespace photile::trace
