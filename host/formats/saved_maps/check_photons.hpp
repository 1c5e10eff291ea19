// Whether photons and groups from elsewhere can be used without reading beyond an array.
#pragma once

#include <string>

#include "photile/scene.hpp"
#include "photile/scene_renderer.hpp"

namespace photile::saved_maps {

/// "" where all indices and sizes fit one another and the scene, and all numbers are finite; else
/// what does not.
std::string problem_of(const PreparedPhotons& prepared, const Scene& scene);

}  // namespace photile::saved_maps
