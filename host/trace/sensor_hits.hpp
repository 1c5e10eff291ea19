// Places in a scene where light is measured, in the form in which a camera's hits are estimated.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"

namespace photile::trace {

/// A point of an opaque surface that faces `normal`.
struct Sensor {
  glm::dvec3 position;  ///< metres
  glm::dvec3 normal;    ///< unit
};

/// Hit i is sensor i, on the triangle found within `reach` metres below it; its pixel is i and the
/// eye is straight above. Errors: InputError that names a sensor without an opaque surface.
PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors, double reach = 1e-3);

}  // namespace photile::trace
