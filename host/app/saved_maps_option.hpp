// `--save-maps` and `--load-maps`.
#pragma once

#include <span>

#include "app/render_options.hpp"
#include "photile/renderer.hpp"

namespace photile::app {

/// As `render`, from photons that a file holds, or that are kept in one. Errors: those of `render`
/// and of saved_maps; UsageError where the photons do not fit in memory at once.
RenderResult render_with_saved_maps(const Scene& scene, const Camera& camera,
                                    std::span<Device> devices, const RenderOptions& options,
                                    Progress& progress);

}  // namespace photile::app
