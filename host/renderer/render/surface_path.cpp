#include <algorithm>
#include <optional>

#include "photile/defaults.hpp"
#include "render/path_estimate.hpp"
#include "trace/eye_path.hpp"
#include "trace/hot_spots.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/ray_query.hpp"
#include "trace/ray_scene.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/shading_point.hpp"

namespace photile {
namespace {

using trace::largest;
using trace::LightWeights;
using trace::OpaqueBsdf;
using trace::power_heuristic;
using trace::Purpose;
using trace::RandomBlock;
using trace::RandomStream;
using trace::SurfacePoint;

/// The index of random numbers for scattering that no bounce uses.
constexpr std::uint32_t hot_spot_blocks = 1u << 31;

class SurfacePath {
 public:
  SurfacePath(const RayScene& rays, const trace::LightSampler& lights, const RandomStream& random,
              std::vector<PathLight>& found)
      : rays_(rays),
        scene_(rays.scene()),
        hot_spots_(trace::hot_spots_of(rays)),
        lights_(lights),
        random_(random),
        found_(found) {}

  void trace(const SurfacePoint& start, const OpaqueBsdf& bsdf) {
    const trace::ShadingPoint shading_point(start, bsdf);
    sample_light(
        start, [&](const glm::vec3& to) { return shading_point.weights(to); },
        [&](const glm::vec3& to) { return shading_point.density(to); });
    const RandomBlock numbers = random_.block(Purpose::path_scattering, 1);
    const auto first = choose_direction(
        start,
        [&] { return shading_point.sample(random_.block(Purpose::path_scattering, 0), numbers); },
        [&](const glm::vec3& to) { return shading_point.density(to); });
    if (!first) return;
    weights_ = shading_point.weights(*first) * (aim_weight_ / density_);
    std::optional<SurfacePoint> point = start;
    glm::vec3 way = *first;
    while ((point = follow(*point, way))) {
      if (!scatter(*point, way)) return;
    }
  }

 private:
  /// A direction in which the path goes on from an opaque point: by its own density, or for a part
  /// of them to a hot spot. Sets what the density of the former is, and what is to be multiplied to
  /// the weight over it. Nothing where the path ends.
  template <class Sample, class Density>
  std::optional<glm::vec3> choose_direction(const SurfacePoint& point, const Sample& sample,
                                            const Density& density) {
    from_ = point.position;
    aim_weight_ = glm::vec3(1.0f);
    std::optional<glm::vec3> direction;
    aim_ = trace::HotSpotAim(hot_spots_, point.position, &point.normal);
    const double to_hot_spots = aim_.fraction();
    if (to_hot_spots > 0) {
      const RandomBlock numbers =
          random_.block(Purpose::path_scattering, hot_spot_blocks + bounce_);
      if (numbers.uniform_double(0) < to_hot_spots) {
        target_ = aim_.sample({numbers.uniform_double(0) / to_hot_spots, numbers.uniform(2)});
        if (!target_) return std::nullopt;
        direction = target_->direction;
      } else {
        aim_weight_ /= static_cast<float>(1 - to_hot_spots);
      }
    }
    if (!direction) direction = sample();
    if (!direction) return std::nullopt;
    density_ = density(*direction);
    if (!(density_ > 0.0f)) return std::nullopt;
    if (target_) {
      aim_weight_ = static_cast<float>(aim_.weight(double{density_}, *target_)) *
                    trace::transmittance(rays_, point.origin_towards(*direction),
                                         target_->point.origin_towards(-*direction));
      if (aim_weight_ == glm::vec3(0.0f)) return std::nullopt;
    }
    return direction;
  }

  /// The next surface point in a direction; adds what it emits. Nothing beyond the scene.
  std::optional<SurfacePoint> follow(const SurfacePoint& from, const glm::vec3& direction) {
    if (target_) {
      const SurfacePoint point = target_->point;
      target_.reset();
      aim_ = {};
      return point;
    }
    trace::RayOrigin origin = from.origin_towards(direction);
    const auto point =
        trace::next_surface(rays_, origin, direction, random_, Purpose::path_cutouts, cutouts_);
    if (!point) {
      add_what_lies_beyond(direction);
    } else if (trace::emits(scene_, *point)) {
      const std::uint32_t light = scene_.triangle_light[point->where.triangle];
      add(lights_.layer(light), weights_ * (weight_against(lights_.density(from_, *point)) *
                                            lights_.radiance(*point, -direction)));
    }
    return point;
  }

  void add_what_lies_beyond(const glm::vec3& direction) {
    lights_.distant().for_each_shining(
        direction, [&](const trace::DistantLight& light, const glm::vec3& radiance) {
          add(lights_.layer(light.light()),
              weights_ * (weight_against(lights_.density(light, from_, direction)) * radiance));
        });
  }

  /// The weight of light that the path met, where sampling lights finds it with density `other`.
  /// Lights seen in mirrors or through refracting glass are found by following alone.
  float weight_against(float other) const {
    return density_ > 0.0f ? power_heuristic(density_, other) : 1.0f;
  }

  /// Adds a light as seen from the point; goes on in a new direction, written to `direction`, or
  /// returns false.
  bool scatter(const SurfacePoint& point, glm::vec3& direction) {
    const RandomBlock numbers = random_.block(Purpose::path_scattering, ++bounce_);
    if (trace::material_of(scene_, point).interaction != Interaction::opaque) {
      const trace::Scattered scattered =
          trace::scatter_specular(scene_, point, direction, numbers.uniform(trace::choice_word));
      // A pane of thin glass passes light straight on, and sampling lights sees through it.
      const bool unscattered = scattered.direction == direction;
      if (!unscattered || !trace::material_of(scene_, point).thin) {
        density_ = 0.0f;
        aim_ = {};
      }
      radiance_factor_ *= scattered.radiance_factor;
      direction = scattered.direction;
      return survives(scattered.weight, numbers);
    }
    if (aim_.fraction() > 0) {
      weights_ =
          weights_ * glm::vec3(static_cast<float>(aim_.weight_beside(double{density_}, point)));
    }
    const OpaqueBsdf bsdf(scene_, point, direction);
    sample_light(
        point, [&](const glm::vec3& to) { return weights_ * bsdf.reflected(to); },
        [&](const glm::vec3& to) { return bsdf.density(to); });
    const auto scattered = choose_direction(
        point, [&] { return bsdf.sample(numbers); },
        [&](const glm::vec3& to) { return bsdf.density(to); });
    if (!scattered) return false;
    direction = *scattered;
    if (!survives(bsdf.reflected(*scattered) / density_, numbers)) return false;
    weights_ = weights_ * aim_weight_;
    return true;
  }

  /// Light of one light, chosen at random, at a point, and that of hot spots there: `weigh` and
  /// `density` of directions.
  template <class Weigh, class Density>
  void sample_light(const SurfacePoint& point, const Weigh& weigh, const Density& density) {
    trace::for_each_hot_light(impl_of(rays_), lights_, point,
                              [&](const trace::LightSample& hot, const glm::vec3& arrives) {
                                add(hot.layer, weigh(hot.direction) * arrives);
                              });
    const auto light =
        lights_.sample(point.position, random_.block(Purpose::path_light, 2 * bounce_),
                       random_.block(Purpose::path_light, 2 * bounce_ + 1));
    if (!light || !(glm::dot(light->direction, point.normal) > 0.0f)) return;
    if (hot_spots_.holds(light->light, point.position)) return;
    const trace::RayOrigin origin = point.origin_towards(light->direction);
    const glm::vec3 arrives = light->received * trace::transmittance(rays_, origin, light->target);
    if (arrives == glm::vec3(0.0f)) return;
    const float weight = light->weight_beside(density(light->direction));
    add(light->layer, weigh(light->direction) * (arrives * weight));
  }

  /// Roulette on what is left of the light, as for photons.
  bool survives(const glm::vec3& weight, const RandomBlock& numbers) {
    const float before = largest(left_);
    left_ *= weight;
    const float survival = std::min(defaults::largest_survival, largest(left_) / before);
    if (!(numbers.uniform(trace::roulette_word) < survival)) return false;
    left_ /= survival;
    weights_ = weights_ * (weight / survival);
    return true;
  }

  void add(std::uint32_t layer, const LightWeights& light) {
    const auto factor = static_cast<float>(radiance_factor_);
    found_.push_back({layer, factor * light.irradiance, factor * light.radiance});
  }

  const RayScene& rays_;
  const Scene& scene_;
  const trace::HotSpots& hot_spots_;
  const trace::LightSampler& lights_;
  const RandomStream& random_;
  std::vector<PathLight>& found_;

  LightWeights weights_;        ///< of the radiance that arrives along the path
  double radiance_factor_ = 1;  ///< of trace::Scattered, so far; not used by roulette
  glm::vec3 left_{1.0f};        ///< of the light since the first direction was chosen
  glm::vec3 from_{0.0f};        ///< the last opaque point, metres
  float density_ = 0;           ///< of the direction from there; 0 after a mirror or glass
  trace::HotSpotAim aim_;       ///< from there
  std::optional<trace::HotSpotAim::Target> target_;  ///< where the path goes next, if it is aimed
  glm::vec3 aim_weight_{1.0f};  ///< of the light from there, for a part of the directions is aimed
  std::uint32_t bounce_ = 1;
  std::uint32_t cutouts_ = 0;
};

}  // namespace

void trace_surface_path(const RayScene& rays, const trace::LightSampler& lights,
                        const SurfacePoint& start, const OpaqueBsdf& bsdf,
                        const RandomStream& random, std::vector<PathLight>& found) {
  SurfacePath(rays, lights, random, found).trace(start, bsdf);
}

}  // namespace photile
