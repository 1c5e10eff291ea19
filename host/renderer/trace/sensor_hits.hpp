// Places in a scene where light is measured, in the form in which a camera's hits are estimated.
#pragma once

#include <span>

#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"
#include "photile/sensors.hpp"
#include "trace/light_sampler.hpp"

namespace photile::trace {

/// Hit i is sensor i, on the triangle found there; its pixel is i and the
/// eye is straight above. Errors: InputError that names a sensor without an opaque surface.
PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors);

/// Rays from sensors [first_row, last_row), the samples of the film's pass of each; sensor i is
/// pixel i of a film one pixel wide. Directions have the density response / pi, so that the mean
/// radiance of a sensor's rays is its irradiance / pi. At each ray a lamp is looked at, too; lamps
/// that both find are weighed (Veach and Guibas 1995). Depends on the sensors, the film's seed and
/// samples only, not on how rows are split or on threads.
///   lamps    of the scene
///   map_of   as in trace_primary_hits
PrimaryHitBatch gather_rays(const RayScene& rays, std::span<const Sensor> sensors,
                            SensorResponse response, const LightSampler& lamps,
                            const PrimaryHitParameters& film, int first_row, int last_row,
                            std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
