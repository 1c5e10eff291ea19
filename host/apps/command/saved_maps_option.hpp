// `--save-maps` and `--load-maps`.
#pragma once

#include <optional>
#include <span>

#include "command/render_options.hpp"
#include "photile/renderer.hpp"
#include "render/hit_source.hpp"
#include "saved_maps/saved_maps.hpp"

namespace photile::app {

/// What a file of photons has to match.
saved_maps::Settings saved_settings(const RenderParameters& parameters);

/// The photons of --load-maps; none where it was not given. Errors: those of saved_maps::load.
std::optional<TracedPhotons> load_maps(const Scene& scene, const RenderOptions& options,
                                       Progress& progress);

/// What keeps photons in the file of --save-maps; empty where it was not given. The scene and the
/// progress must outlive it.
KeepPhotons keep_maps(const Scene& scene, const RenderOptions& options, Progress& progress);

/// Adds light maps to the photons in the file of --save-maps, where both are there.
void keep_light_maps(const std::optional<LightMapContents>& light_maps,
                     const RenderOptions& options, Progress& progress);

/// Renders, as `render` does, from photons that a file holds, or that are kept in one.
///   hits          what the camera sees
///   reflections   gets the part of the picture that came by reflection, or null
/// Errors: those of `render` and of saved_maps; UsageError where the photons do not fit in memory
/// at once.
RenderResult render_with_kept_maps(const Scene& scene, const Camera& camera, const HitSource& hits,
                                   std::span<Device> devices, const RenderOptions& options,
                                   LightLayers* reflections, Progress& progress);

}  // namespace photile::app
