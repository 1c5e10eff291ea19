#include <algorithm>
#include <optional>

#include "photile/defaults.hpp"
#include "render/path_estimate.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/ray_query.hpp"
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

class SurfacePath {
 public:
  SurfacePath(const RayScene& rays, const trace::LightSampler& lights, const RandomStream& random,
              std::vector<PathLight>& found)
      : rays_(rays), scene_(rays.scene()), lights_(lights), random_(random), found_(found) {}

  void trace(const SurfacePoint& start, const OpaqueBsdf& bsdf) {
    const trace::ShadingPoint shading_point(start, bsdf);
    sample_light(
        start, [&](const glm::vec3& to) { return shading_point.weights(to); },
        [&](const glm::vec3& to) { return shading_point.density(to); });
    const RandomBlock numbers = random_.block(Purpose::path_scattering, 1);
    const auto first = shading_point.sample(random_.block(Purpose::path_scattering, 0), numbers);
    if (!first) return;
    density_ = shading_point.density(*first);
    if (!(density_ > 0.0f)) return;
    weights_ = shading_point.weights(*first) * glm::vec3(1.0f / density_);
    from_ = start.position;
    std::optional<SurfacePoint> point = start;
    glm::vec3 way = *first;
    while ((point = follow(*point, way))) {
      if (!scatter(*point, way)) return;
    }
  }

 private:
  /// The next surface point in a direction; adds what it emits. Nothing beyond the scene.
  std::optional<SurfacePoint> follow(const SurfacePoint& from, const glm::vec3& direction) {
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
      if (!unscattered || !trace::material_of(scene_, point).thin) density_ = 0.0f;
      radiance_factor_ *= scattered.radiance_factor;
      direction = scattered.direction;
      return survives(scattered.weight, numbers);
    }
    const OpaqueBsdf bsdf(scene_, point, direction);
    sample_light(
        point, [&](const glm::vec3& to) { return weights_ * bsdf.reflected(to); },
        [&](const glm::vec3& to) { return bsdf.density(to); });
    const auto scattered = bsdf.sample(numbers);
    if (!scattered) return false;
    density_ = bsdf.density(*scattered);
    if (!(density_ > 0.0f)) return false;
    from_ = point.position;
    direction = *scattered;
    return survives(bsdf.reflected(*scattered) / density_, numbers);
  }

  /// Light of one light, chosen at random, at a point: `weigh` and `density` of directions there.
  template <class Weigh, class Density>
  void sample_light(const SurfacePoint& point, const Weigh& weigh, const Density& density) {
    const auto light =
        lights_.sample(point.position, random_.block(Purpose::path_light, 2 * bounce_),
                       random_.block(Purpose::path_light, 2 * bounce_ + 1));
    if (!light || !(glm::dot(light->direction, point.normal) > 0.0f)) return;
    const trace::RayOrigin origin = point.origin_towards(light->direction);
    const glm::vec3 arrives = light->received * trace::transmittance(rays_, origin, light->target);
    if (arrives == glm::vec3(0.0f)) return;
    const float weight = light->weight_beside(density(light->direction));
    add(light->layer, weigh(light->direction) * (arrives * weight));
  }

  /// Roulette on what is left of the light, as photons play it.
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
  const trace::LightSampler& lights_;
  const RandomStream& random_;
  std::vector<PathLight>& found_;

  LightWeights weights_;        ///< of the radiance that arrives along the path
  double radiance_factor_ = 1;  ///< of trace::Scattered, so far; roulette does not play with it
  glm::vec3 left_{1.0f};        ///< of the light since the first direction was chosen
  glm::vec3 from_{0.0f};        ///< the last opaque point, metres
  float density_ = 0;           ///< of the direction from there; 0 after a mirror or glass
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
