// Sensors that measure light: their responses, and their hits in the form of a camera's.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <span>

#include "photile/ray_scene.hpp"
#include "photile/sensors.hpp"
#include "trace/light_sampler.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

class Photometer {
 public:
  Photometer(const Sensor& sensor, SensorResponse response)
      : origin_(origin_of(sensor, response)),
        normal_(sensor.normal),
        facing_(sensor.facing),
        response_(response),
        sees_lights_(sensor.sees_lights),
        frame_(normal_) {}

  /// A plane sensor on the side of a surface on which the point lies.
  explicit Photometer(const SurfacePoint& point)
      : origin_(point.origin_towards(point.normal)), normal_(point.normal), frame_(normal_) {}

  const glm::vec3& origin() const { return origin_; }
  bool sees_lights() const { return sees_lights_; }
  /// The normal of the side whose light counts; null where light from all sides counts.
  const glm::vec3* one_side() const {
    return response_ == SensorResponse::planar ? &normal_ : nullptr;
  }

  /// Density of `sample`, per steradian: the response over pi.
  float density(const glm::vec3& direction) const {
    const float cosine = glm::dot(direction, normal_);
    if (response_ == SensorResponse::planar) {
      return glm::one_over_pi<float>() * std::max(0.0f, cosine);
    }
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
    const float round = glm::one_over_pi<float>() * glm::one_over_pi<float>() * sine;
    if (response_ == SensorResponse::cylindrical) return round;
    return round + glm::one_over_pi<float>() * glm::one_over_pi<float>() *
                       glm::dot(direction, facing_);  // sine x cosine of the angle to `facing`
  }

  /// A direction for two numbers that are spread over the unit square and two independent ones.
  glm::vec3 sample(const glm::dvec2& spread, float own, float side) const {
    const glm::vec3 local =
        sample_cosine_hemisphere(static_cast<float>(spread.x), static_cast<float>(spread.y));
    if (response_ == SensorResponse::planar) return frame_.to_world(local);
    // Round the axis all vertical planes are alike: one at random, then as on a plane.
    const glm::vec3 round = Frame(frame_.to_world(direction_at(0.0f, own))).to_world(local);
    if (response_ == SensorResponse::cylindrical) return round;
    // With probability (1 - cos alpha) / 2 it goes to the other side, which is seen that much more.
    const float along = glm::dot(round, normal_);
    const float sine = std::sqrt(std::max(1e-12f, 1.0f - along * along));
    if (side >= 0.5f * (1.0f - glm::dot(round, facing_) / sine)) return round;
    return 2.0f * along * normal_ - round;
  }

 private:
  static glm::vec3 origin_of(const Sensor& sensor, SensorResponse response) {
    if (response != SensorResponse::planar) return glm::vec3(sensor.position);
    // A plane sensor may lie on a surface: its rays start a little above.
    const glm::dvec3 size = glm::abs(sensor.position);
    const double ray_offset = ray_offset_per_coordinate * std::max({size.x, size.y, size.z, 1e-3});
    return glm::vec3(sensor.position + ray_offset * sensor.normal);
  }

  glm::vec3 origin_, normal_, facing_{1.0f, 0.0f, 0.0f};
  SensorResponse response_ = SensorResponse::planar;
  bool sees_lights_ = true;
  Frame frame_;
};

/// Hit i is sensor i, on the triangle found there; its pixel is i, and the eye is directly above.
/// Errors: InputError that names a sensor without an opaque surface.
PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors);

/// Rays from sensors [first_row, last_row), the samples of the film's pass of each; sensor i is
/// pixel i of a film one pixel wide. Directions have the density response / pi, so that the mean
/// radiance of a sensor's rays is its irradiance / pi. At each ray a light is sampled, too; lights
/// that both find are weighted (Veach and Guibas 1995). Depends on the sensors, the film's seed and
/// samples only, not on how rows are split or on threads.
///   light_sampler    of the scene
///   adds_hot_spots   whether ray hits get the light of hot spots, which photons leave out
///   map_of           as in trace_primary_hits
PrimaryHitBatch gather_rays(const RayScene& rays, std::span<const Sensor> sensors,
                            SensorResponse response, const LightSampler& light_sampler,
                            bool adds_hot_spots, const PrimaryHitParameters& film, int first_row,
                            int last_row, std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
