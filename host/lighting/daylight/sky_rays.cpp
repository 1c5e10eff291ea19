#include "daylight/sky_rays.hpp"

#include <glm/gtc/constants.hpp>

#include "trace/holes.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/scatter.hpp"
#include "trace/sobol.hpp"

namespace photile::daylight {

SkyRays::SkyRays(const RayScene& rays, const weather::PatchFinder& patches,
                 const SkyRayParameters& parameters)
    : rays_(rays), patches_(patches), parameters_(parameters), portals_(rays.scene()) {}

void SkyRays::follow(glm::vec3 origin, glm::vec3 direction, glm::vec3 weight, std::uint32_t batch,
                     const trace::RandomStream& random, SeenByRays& seen) const {
  const Scene& scene = rays_.scene();
  double radiance_factor = 1;
  float distance = 0;
  bool straight = true;
  std::uint32_t holes = 0;
  for (int depth = 0; depth <= parameters_.max_specular_depth; ++depth) {
    const glm::vec3 from = origin;
    const auto met =
        trace::next_surface(rays_, origin, direction, random, trace::Purpose::eye_holes, holes);
    const auto factor = static_cast<float>(radiance_factor);
    if (!met) {
      seen.patches.push_back({patches_(direction), batch, straight, factor * weight});
      return;
    }
    const trace::SurfacePoint& point = *met;
    distance += glm::distance(from, point.position);
    const Material& material = trace::material_of(scene, point);
    if (material.interaction != Interaction::opaque) {
      const trace::RandomBlock numbers = random.block(trace::Purpose::eye_scattering, depth);
      const trace::Scattered scattered =
          trace::scatter_specular(scene, point, direction, numbers.uniform(trace::choice_word));
      straight = straight && scattered.direction == direction && material.thin;
      weight *= scattered.weight;
      radiance_factor *= scattered.radiance_factor;
      direction = scattered.direction;
    } else {
      const trace::OpaqueBsdf bsdf(scene, point, direction);
      const float share = bsdf.lobe_share();
      const trace::RandomBlock numbers = share > 0.0f
                                             ? random.block(trace::Purpose::eye_scattering, depth)
                                             : trace::RandomBlock({});
      if (!(share > 0.0f) || !(numbers.uniform(trace::choice_word) < share)) {
        weight *= factor * bsdf.base_reflectance() / (1.0f - share);
        if (weight != glm::vec3(0.0f)) {
          seen.surfaces.push_back({point, batch, distance, weight * glm::one_over_pi<float>()});
        }
        return;
      }
      trace::OpaqueBsdf lobe = bsdf;
      lobe.keep_lobe();
      const auto next = lobe.sample(numbers);
      const float density = next ? lobe.density(*next) : 0.0f;
      if (!(density > 0.0f)) return;
      weight *= lobe.reflected(*next) / (density * share);
      straight = false;
      direction = *next;
    }
    if (weight == glm::vec3(0.0f)) return;
    origin = point.origin_towards(direction);
  }
}

SeenByRays SkyRays::from(std::span<const trace::Photometer> places, std::uint64_t number,
                         int rays) const {
  SeenByRays seen;
  thread_local std::vector<double> weights;
  const float each = glm::pi<float>() / static_cast<float>(rays * parameters_.batches);
  for (int batch = 0; batch < parameters_.batches; ++batch) {
    const std::uint64_t seed =
        trace::seed_of_repeat(parameters_.seed, static_cast<std::uint32_t>(batch));
    const trace::RandomStream of_batch(seed, number << 16, 0);
    const trace::RandomBlock scrambles[2]{of_batch.block(trace::Purpose::sensor_direction, 0),
                                          of_batch.block(trace::Purpose::sensor_light, 0)};
    for (int ray = 0; ray < rays; ++ray) {
      const trace::RandomStream random(seed, number << 16 | static_cast<std::uint64_t>(ray), 0);
      const trace::RandomBlock own = random.block(trace::Purpose::sensor_direction, 1);
      const trace::Photometer& place =
          places[static_cast<std::size_t>(batch * rays + ray) % places.size()];
      const double sum = portals_.empty() ? 0 : portals_.weigh(glm::dvec3(place.origin()), weights);
      // A ray alone follows the cosine: what it brings is then no more than what is there.
      const double looking = sum > 0 ? (rays / 2) / static_cast<double>(rays) : 0;
      const bool looks = looking > 0 && ray % 2 == 1;
      const auto index = static_cast<std::uint32_t>(looking > 0 ? ray / 2 : ray);
      const glm::dvec2 spread = trace::sobol_point(index, scrambles[looks ? 1 : 0]);
      const glm::vec3 direction =
          looks ? glm::vec3(portals_.look(glm::dvec3(place.origin()), weights, sum,
                                          own.uniform_double(0), spread.x, spread.y))
                : place.sample(spread, own.uniform(0), own.uniform(1));
      const double density = place.density(direction);
      if (!(density > 0)) continue;
      double of_both = (1 - looking) * density;
      if (looking > 0) {
        of_both += looking * portals_.density(glm::dvec3(place.origin()), glm::dvec3(direction),
                                              weights, sum);
      }
      follow(place.origin(), direction, glm::vec3(each * static_cast<float>(density / of_both)),
             static_cast<std::uint32_t>(batch), random, seen);
    }
  }
  return seen;
}

}  // namespace photile::daylight
