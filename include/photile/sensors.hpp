// Light measured at chosen points, as a photometer would, by photon maps or by paths.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "photile/path_tracer.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// A point of an opaque surface that faces `normal`, within a millimetre.
struct Sensor {
  glm::dvec3 position{0.0};          ///< metres
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit; also where radiance is seen from
};

/// The light at sensors, by `render`: the result's layers are one row high, sensor i is pixel i.
/// `parameters.film` gives the seed only. Errors: those of `render`; InputError that names a sensor
/// without an opaque surface.
RenderResult measure(const Scene& scene, std::span<const Sensor> sensors, std::span<Device> devices,
                     const RenderParameters& parameters, Progress& progress = Progress::none());

/// The same by `trace_paths`, from `paths` paths of each sensor.
PathTracerResult measure_by_paths(const Scene& scene, std::span<const Sensor> sensors, int paths,
                                  std::uint64_t seed, Progress& progress = Progress::none());

}  // namespace photile
