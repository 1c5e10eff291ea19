// A picture by path tracing: unbiased, without photons, and without an OpenCL device. The reference
// for the photon maps, and for small pictures another way to the same layers.
#pragma once

#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/primary_hits.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"

namespace photile {

struct PathTracerResult {
  LightLayers layers;
  RunStatistics statistics;
};

/// Renders the picture of `camera`, one layer per light, from film.samples_per_pixel paths a pixel.
/// Next event estimation and multiple importance sampling; paths end by Russian roulette, so that
/// no bounce is left out. What point, spot and directional lights throw through mirrors and
/// refracting glass onto other surfaces cannot be found and is missing. The picture depends on the
/// scene, the camera and the film (its seed; `pass` and `passes` are ignored) only, bit for bit,
/// whatever the number of threads. Errors: UsageError for values out of limits.hpp; InputError for
/// an area light without area; Interrupted.
PathTracerResult trace_paths(const Scene& scene, const Camera& camera,
                             const PrimaryHitParameters& film,
                             Progress& progress = Progress::none());

/// Whether lights of the scene have such caustics, which path tracing leaves out.
bool has_unseen_caustics(const Scene& scene);

}  // namespace photile
