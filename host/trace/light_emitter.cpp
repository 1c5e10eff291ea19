#include "trace/light_emitter.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "photile/errors.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

enum Block : std::uint32_t { place_block = 0, direction_block = 1 };

}  // namespace

LightEmitter::LightEmitter(const Scene& scene, std::uint32_t light, const BoundingSphere& bounds)
    : scene_(&scene), light_(&scene.lights[light]), bounds_(bounds) {
  if (light_->kind != LightKind::area) return;
  double area = 0;
  area_up_to_.reserve(light_->triangles.size());
  for (const std::uint32_t triangle : light_->triangles)
    area_up_to_.push_back(area += triangle_area(scene, triangle));
  if (!(area > 0))
    throw InputError(scene.source.string() + ": area light '" + light_->name + "' has " +
                     std::to_string(light_->triangles.size()) +
                     " triangles and no area; give it a surface or remove it");
}

EmittedRay LightEmitter::emit(const RandomStream& random) const {
  if (light_->kind == LightKind::area) return emit_from_area(random);

  const RandomBlock numbers = random.block(Purpose::emission, direction_block);
  switch (light_->kind) {
    case LightKind::point:
      return {light_->position, sample_sphere(numbers.uniform(0), numbers.uniform(1))};
    case LightKind::spot: {
      const float cosine = spot_cosine(numbers.uniform_double(0));
      return {light_->position,
              Frame(light_->direction).to_world(direction_at(cosine, numbers.uniform(2)))};
    }
    default: {  // directional; area lights were handled above
      const Frame frame(light_->direction);
      const glm::vec2 disc = sample_disc(numbers.uniform(0), numbers.uniform(1));
      const glm::dvec3 point = glm::dvec3(frame.s * disc.x + frame.t * disc.y - frame.n);
      return {glm::vec3(bounds_.center + bounds_.radius * point), light_->direction};
    }
  }
}

EmittedRay LightEmitter::emit_from_area(const RandomStream& random) const {
  const RandomBlock place = random.block(Purpose::emission, place_block);
  const double target = place.uniform_double(0) * area_up_to_.back();
  // The last entry is larger than the target, so there always is one.
  const auto chosen = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), target);
  const std::uint32_t triangle = light_->triangles[chosen - area_up_to_.begin()];

  const RandomBlock numbers = random.block(Purpose::emission, direction_block);
  const glm::vec2 uv = sample_triangle(place.uniform(2), place.uniform(3));
  const std::uint32_t front = scene_->front_side[triangle];
  const std::uint32_t side = light_->two_sided && numbers.bit(2) ? 1 - front : front;
  const SurfacePoint point = surface_point(*scene_, {triangle, uv.x, uv.y}, side);
  const glm::vec3 direction =
      Frame(point.normal)
          .to_world(sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1)));
  return {point.origin_towards(direction), direction};
}

float LightEmitter::spot_cosine(double u) const {
  // KHR_lights_punctual: over t = cosine - outer the intensity is (t / edge)^2 up to the edge of
  // the inner cone, then 1. Its integral is inverted.
  const double outer = std::cos(static_cast<double>(light_->outer_cone_angle));
  const double inner = std::cos(static_cast<double>(light_->inner_cone_angle));
  const double edge = inner - outer;
  const double edge_share = edge / 3.0;
  const double target = u * (edge_share + 1.0 - inner);
  const double t =
      target < edge_share ? std::cbrt(3.0 * edge * edge * target) : edge + (target - edge_share);
  return static_cast<float>(outer + t);
}

}  // namespace photile::trace
