#include "trace/photon_path.hpp"

#include <algorithm>

#include "photile/defaults.hpp"
#include "trace/holes.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

double luminance_of(const glm::vec3& flux) { return luminance(glm::dvec3(flux)); }

/// One photon of the density that is estimated at this point.
void store(const PathSetup& setup, const SurfacePoint& point, const glm::vec3& direction,
           const glm::vec3& flux, PhotonRun& run) {
  run.position.push_back(point.position);
  run.flux.push_back(flux);
  if (setup.keep_incoming) run.incoming.push_back(-direction);
  run.sided_triangle.push_back(point.sided_triangle());
}

/// Flux after the interaction, black where the path ends. From `roulette_start` on, a path survives
/// with the share of its largest channel that is left, and keeps that channel's flux: photons of a
/// light all weigh the same, which is what keeps the noise of the estimate low. Those of long paths
/// weigh more.
glm::vec3 play_roulette(const PathSetup& setup, int bounce, const glm::vec3& before,
                        const glm::vec3& after, float u) {
  if (bounce < setup.parameters->roulette_start) return after;
  const float most = bounce < defaults::long_path ? 1.0f : defaults::largest_survival;
  const float survival = std::min(most, largest(after) / largest(before));
  return u < survival ? after / survival : glm::vec3(0.0f);
}

}  // namespace

void trace_photon_path(const PathSetup& setup, std::uint64_t path, PathRecord& record) {
  const Scene& scene = *setup.rays->scene;
  const RandomStream random(setup.parameters->seed, path, setup.light);
  const EmittedRay emitted = setup.emitter->emit(random);
  glm::vec3 flux(glm::dvec3(emitted.color) / static_cast<double>(setup.paths));
  if (!(largest(flux) > 0.0f)) return;
  glm::vec3 origin = emitted.origin, direction = emitted.direction;
  std::uint32_t holes = 0;
  bool straight = true;  // but for panes and holes, which looking at lamps sees through
  bool specular = true;  // scattered by mirrors and glass alone, if at all

  for (int bounce = 1;;) {
    const auto hit = setup.rays->intersect(origin, direction);
    if (!hit) {
      record.escaped += luminance_of(flux);
      return;
    }
    const SurfacePoint point = surface_hit(scene, *hit, direction);
    const bool opaque = material_of(scene, point).interaction == Interaction::opaque;
    // In holes as well: the density is that of light on the whole triangle, by whose area the
    // estimate divides, and does not fall where a hole is near.
    if (opaque && (setup.parameters->store_direct || !straight)) {
      store(setup, point, direction, flux, record.photons);
    }
    if (opaque && setup.parameters->keep_caustics && specular && !straight) {
      store(setup, point, direction, flux, record.caustics);
    }
    if (passes_hole(scene, point, random, Purpose::photon_holes, holes)) {
      origin = point.origin_towards(direction);
      continue;
    }
    if (bounce >= setup.parameters->max_path_length) break;

    const RandomBlock numbers = random.block(Purpose::photon_scattering, bounce);
    const std::optional<Scattered> scattered =
        opaque ? scatter_opaque(scene, point, direction, numbers)
               : scatter_specular(scene, point, direction, numbers.uniform(choice_word));
    if (!scattered) break;
    const glm::vec3 left = play_roulette(setup, bounce, flux, flux * scattered->weight,
                                         numbers.uniform(roulette_word));
    if (!(largest(left) > 0.0f)) break;
    record.absorbed += luminance_of(flux) - luminance_of(left);
    straight =
        straight && !opaque && scattered->direction == direction && material_of(scene, point).thin;
    specular = specular && !opaque;
    flux = left;
    direction = scattered->direction;
    origin = point.origin_towards(direction);
    ++bounce;
  }
  record.absorbed += luminance_of(flux);
}

}  // namespace photile::trace
