// Places in a scene where light is measured, in the form in which a camera's hits are estimated.
#pragma once

#include <span>

#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"
#include "photile/sensors.hpp"

namespace photile::trace {

/// Hit i is sensor i, on the triangle found there; its pixel is i and the
/// eye is straight above. Errors: InputError that names a sensor without an opaque surface.
PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors);

}  // namespace photile::trace
