// Bright surface that lights the rest of a scene, and at which rays are aimed.
#pragma once

#include <cstdint>
#include <span>

#include "photile/ray_scene.hpp"
#include "trace/targets.hpp"

namespace photile::trace {

/// Spheres around the brightest part of the lit surface (`defaults::bright_part`), where most of
/// all reflected light comes from it (`defaults::bright_light`), as from the ceiling above a cove;
/// none where light is spread more widely. Rays with the density of the cosine seldom hit such
/// surface. It is found by the photons of `defaults::pilot_paths` pilot paths; textures are
/// ignored, because spheres decide where rays go and not what they find.
///   layer_powers   of the lights together, per layer
Targets bright_surface(const RayScene& rays, std::span<const double> layer_powers,
                       std::uint64_t seed);

}  // namespace photile::trace
