// A first picture for somebody who waits: few photons, kept at the coarsest nodes of light maps.
#pragma once

#include <span>

#include "render/hit_source.hpp"
#include "render/rendering.hpp"

namespace photile {

/// What is asked of the first picture of those that these parameters ask for:
/// defaults::view_first_photons paths, whose estimates value the coarsest nodes. Light straight
/// from lamps is among them, whatever brings it later.
RenderParameters first_picture_parameters(const RenderParameters& asked);

/// Makes that picture, where `hits` await one, and has them draw it. What fails on the way leaves
/// it out: it is no part of the result. Returns what it took; nothing where none was made. Errors:
/// Interrupted.
///   film   of the picture that follows
TimeTaken draw_first_picture(const PreparedScene& scene, const HitSource& hits, const Film& film,
                             std::span<Device> devices, const RenderParameters& asked,
                             Progress& progress);

}  // namespace photile
