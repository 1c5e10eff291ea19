#include "trace/light_emitter.hpp"

#include <cmath>

#include "trace/sampling.hpp"
#include "trace/spot_falloff.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

enum Block : std::uint32_t { place_block = 0, direction_block = 1 };

}  // namespace

LightEmitter::LightEmitter(const Scene& scene, std::uint32_t light, const BoundingSphere& bounds)
    : scene_(&scene), light_(&scene.lights[light]), bounds_(bounds) {
  if (light_->kind == LightKind::area) area_.emplace(scene, *light_);
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
  const TriangleHit where = area_->sample(random.block(Purpose::emission, place_block));
  const RandomBlock numbers = random.block(Purpose::emission, direction_block);
  const std::uint32_t front = scene_->front_side[where.triangle];
  const std::uint32_t side = light_->two_sided && numbers.bit(2) ? 1 - front : front;
  const SurfacePoint point = surface_point(*scene_, where, side);
  const glm::vec3 direction =
      Frame(point.normal)
          .to_world(sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1)));
  return {point.origin_towards(direction), direction};
}

float LightEmitter::spot_cosine(double u) const {
  // The integral of the falloff over t = cosine - outer, inverted.
  const SpotFalloff spot(*light_);
  const double outer = spot.outer, edge = spot.edge;
  const double edge_share = edge / 3.0;
  const double target = u * spot.integral();
  const double t =
      target < edge_share ? std::cbrt(3.0 * edge * edge * target) : edge + (target - edge_share);
  return static_cast<float>(outer + t);
}

}  // namespace photile::trace
