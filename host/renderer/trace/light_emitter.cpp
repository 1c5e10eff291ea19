#include "trace/light_emitter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "photile/defaults.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

enum Block : std::uint32_t {
  point_block = 0,
  direction_block = 1,
  portal_block = 2,
  luminaire_block = 1u << 20
};

constexpr int least_map_columns = 32;

/// A point on the disc of the bounding sphere through which parallel light enters the scene.
glm::vec3 entrance(const BoundingSphere& bounds, const glm::vec3& direction, float u1, float u2) {
  const Frame frame(direction);
  const glm::vec2 disc = sample_disc(u1, u2);
  const glm::dvec3 point = glm::dvec3(frame.s * disc.x + frame.t * disc.y - frame.n);
  return glm::vec3(bounds.center + bounds.radius * point);
}

/// Flux of a ray that was sampled with `density` in place of its own density.
glm::vec3 over_density(const glm::vec3& color, double own, double density) {
  return density > 0 ? color * static_cast<float>(own / density) : glm::vec3(0.0f);
}

}  // namespace

LightEmitter::LightEmitter(const Scene& scene, std::uint32_t light, const BoundingSphere& bounds,
                           std::shared_ptr<const Portals> portals)
    : scene_(&scene), light_(&scene.lights[light]), bounds_(bounds), portals_(std::move(portals)) {
  if (light_->kind == LightKind::area) area_.emplace(scene, *light_);
  if (light_->distribution != none) intensity_.emplace(scene, *light_);
  if (light_->has_size() && light_->kind != LightKind::area) distant_.emplace(scene, *light_);
  if (!light_->is_distant() || portals_->empty()) return;
  const auto shown = [this](const glm::dvec3& towards) { return portals_->area_facing(-towards); };
  bool reached = false;
  if (light_->kind == LightKind::environment) {
    const EnvironmentMap& map = scene.environments[light_->environment];
    // What portals show of a wide texel says little about the directions in it.
    if (map.width() < least_map_columns) return;
    reached = !towards_portals_.emplace(map, shown).empty();
  } else {
    reached = (distant_ ? area_facing(*portals_, *distant_)
                        : portals_->area_facing(glm::dvec3(light_->direction))) > 0;
  }
  if (reached) portal_fraction_ = defaults::portal_photons;
}

EmittedRay LightEmitter::emit(const RandomStream& random) const {
  if (area_) return emit_from_area(random);
  if (portal_fraction_ > 0) return emit_through_portals(random);
  if (distant_) return emit_from_beyond(random);

  const RandomBlock numbers = random.block(Purpose::emission, direction_block);
  switch (light_->kind) {
    case LightKind::point:
      return {light_->position,
              intensity_ ? intensity_->sample(random)
                         : sample_sphere(numbers.uniform(0), numbers.uniform(1)),
              light_->color};
    case LightKind::spot: {
      const float cosine = spot_cosine(numbers.uniform_double(0));
      return {light_->position,
              Frame(light_->direction).to_world(direction_at(cosine, numbers.uniform(2))),
              light_->color};
    }
    case LightKind::directional:
    case LightKind::area:
    case LightKind::environment:
      break;
  }
  // Parallel light; lights with a size were handled above.
  return {entrance(bounds_, light_->direction, numbers.uniform(0), numbers.uniform(1)),
          light_->direction, light_->color};
}

EmittedRay LightEmitter::emit_from_beyond(const RandomStream& random) const {
  const DistantSampler::Sample from =
      distant_->sample(random.block(Purpose::emission, direction_block));
  const RandomBlock numbers = random.block(Purpose::emission, point_block);
  return {entrance(bounds_, -from.direction, numbers.uniform(0), numbers.uniform(1)),
          -from.direction, from.color};
}

EmittedRay LightEmitter::emit_through_portals(const RandomStream& random) const {
  const RandomBlock numbers = random.block(Purpose::emission, point_block);
  const RandomBlock on_portal = random.block(Purpose::emission, portal_block);
  const bool through = on_portal.uniform_double(0) < portal_fraction_;
  const RandomBlock direction = random.block(Purpose::emission, direction_block);
  DistantSampler::Sample from{-light_->direction, light_->color, 0.0f};
  if (through && towards_portals_) {
    from = towards_portals_->sample(direction);
  } else if (distant_) {
    from = distant_->sample(direction);
  }
  const glm::dvec3 travel(-from.direction);
  glm::vec3 origin = entrance(bounds_, glm::vec3(travel), numbers.uniform(0), numbers.uniform(1));
  if (through) {
    // A part of a disc or a patch may lie behind all portals.
    if (!(portals_->area_facing(travel) > 0)) return {origin, -glm::vec3(travel), glm::vec3(0.0f)};
    const glm::dvec3 point =
        portals_->entrance(travel, double{on_portal.uniform(2)}, double{numbers.uniform(0)},
                           double{numbers.uniform(1)});
    const double back = glm::dot(point - bounds_.center, travel) + bounds_.radius;
    origin = glm::vec3(point - back * travel);
  }
  // A line through a portal's border may miss it by rounding.
  const int entered = std::max(portals_->entered_by(glm::dvec3(origin), travel), through ? 1 : 0);
  return {origin, glm::vec3(travel),
          from.color * static_cast<float>(flux_of_line(travel, entered))};
}

/// Its density on the disc of the bounding sphere over that among both techniques.
double LightEmitter::flux_of_line(const glm::dvec3& travel, int entered) const {
  double through = 0;  // density by portals over that on the disc
  if (entered > 0) {
    const double disc = glm::pi<double>() * bounds_.radius * bounds_.radius;
    through = entered * disc / portals_->area_facing(travel);
    if (towards_portals_) {
      const glm::vec3 towards(-travel);
      const auto even = static_cast<double>(distant_->density(towards));
      through *= even > 0 ? static_cast<double>(towards_portals_->density(towards)) / even : 0.0;
    }
  }
  return 1 / ((1 - portal_fraction_) + portal_fraction_ * through);
}

EmittedRay LightEmitter::emit_towards(const Targets& targets, const RandomStream& random,
                                      const glm::dvec2& u) const {
  if (area_) return emit_from_area_towards(targets, random, u);
  if (light_->is_distant()) return emit_from_beyond_towards(targets, random, u);
  const auto [direction, density] = Aim(targets, glm::dvec3(light_->position), nullptr).sample(u);
  const double own = candela_per_lumen(*scene_, *light_, glm::dvec3(direction));
  return {light_->position, direction, over_density(light_->color, own, density)};
}

EmittedRay LightEmitter::emit_from_area_towards(const Targets& targets, const RandomStream& random,
                                                const glm::dvec2& u) const {
  const TriangleHit where =
      area_->sample(random.block(Purpose::emission, intensity_ ? luminaire_block : point_block));
  const RandomBlock numbers = random.block(Purpose::emission, direction_block);
  const std::uint32_t front = scene_->front_side[where.triangle];
  const std::uint32_t side = light_->two_sided && numbers.bit(2) ? 1 - front : front;
  SurfacePoint point = surface_point(*scene_, where, side);
  const Aim aim(targets, glm::dvec3(point.position), intensity_ ? nullptr : &point.normal);
  if (!aim.possible()) return {point.position, point.normal, glm::vec3(0.0f)};
  const auto [direction, density] = aim.sample(u);
  const double cosine = static_cast<double>(glm::dot(direction, point.normal));
  if (intensity_ && cosine < 0) point = surface_point(*scene_, where, 1 - side);
  const double own = intensity_ ? candela_per_lumen(*scene_, *light_, glm::dvec3(direction))
                                : std::max(0.0, cosine) * glm::one_over_pi<double>();
  return {point.origin_towards(direction), direction, over_density(color_of(point), own, density)};
}

EmittedRay LightEmitter::emit_from_beyond_towards(const Targets& targets,
                                                  const RandomStream& random,
                                                  const glm::dvec2& u) const {
  DistantSampler::Sample from{-light_->direction, light_->color, 0.0f};
  if (distant_) from = distant_->sample(random.block(Purpose::emission, direction_block));
  const glm::dvec3 travel(-from.direction);
  const auto [point, density] = targets.line_along(travel, u);
  const double back = glm::dot(point - bounds_.center, travel) + bounds_.radius;
  const double own = 1 / (glm::pi<double>() * bounds_.radius * bounds_.radius);
  return {glm::vec3(point - back * travel), glm::vec3(travel),
          over_density(from.color, own, density)};
}

EmittedRay LightEmitter::emit_from_area(const RandomStream& random) const {
  if (intensity_) return emit_from_luminaire(random);
  const TriangleHit where = area_->sample(random.block(Purpose::emission, point_block));
  const RandomBlock numbers = random.block(Purpose::emission, direction_block);
  const std::uint32_t front = scene_->front_side[where.triangle];
  const std::uint32_t side = light_->two_sided && numbers.bit(2) ? 1 - front : front;
  const SurfacePoint point = surface_point(*scene_, where, side);
  const glm::vec3 direction =
      Frame(point.normal)
          .to_world(sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1)));
  return {point.origin_towards(direction), direction, color_of(point)};
}

EmittedRay LightEmitter::emit_from_luminaire(const RandomStream& random) const {
  // Directions take as many blocks from 0 on as their rejection asks for.
  const TriangleHit where = area_->sample(random.block(Purpose::emission, luminaire_block));
  const glm::vec3 direction = intensity_->sample(random);
  const std::uint32_t front = scene_->front_side[where.triangle];
  const SurfacePoint seen = surface_point(*scene_, where, front);
  const bool forwards = glm::dot(direction, seen.normal) > 0.0f;
  const SurfacePoint point = forwards ? seen : surface_point(*scene_, where, 1 - front);
  return {point.origin_towards(direction), direction, color_of(point)};
}

glm::vec3 LightEmitter::color_of(const SurfacePoint& point) const {
  if (light_->emission_texture == none) return light_->color;
  // Radiosity over the density of the point, which follows the luminance only about.
  const double sides = light_->two_sided ? 2 : 1;
  return glm::vec3(glm::dvec3(light_->texel_radiance * emission_texel(*scene_, point)) *
                   (glm::pi<double>() * sides / area_->density(point.where)));
}

float LightEmitter::spot_cosine(double u) const {
  // The integral of the falloff over t = cosine - outer, inverted.
  const SpotFalloff spot(*light_);
  const double outer = spot.outer, edge = spot.edge;
  const double edge_fraction = edge / 3.0;
  const double target = u * spot.integral();
  const double t = target < edge_fraction ? std::cbrt(3.0 * edge * edge * target)
                                          : edge + (target - edge_fraction);
  return static_cast<float>(outer + t);
}

}  // namespace photile::trace
