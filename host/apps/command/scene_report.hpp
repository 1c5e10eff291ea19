// What a scene holds, as text and as JSON.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"

namespace photile::app {

/// Axis-aligned box around all vertices, metres, in the file's world.
struct Extents {
  glm::dvec3 lowest{0.0}, highest{0.0};
  glm::dvec3 size() const { return highest - lowest; }
};
Extents extents_of(const Scene& scene);

/// "area", "point", "spot", "photometric", "sun", "directional" or "environment".
const char* kind_name(const Light& light);

/// Power of each light in the mix; lights of a group change together.
std::vector<double> powers_of(const Scene& scene, const LightMix& mix);

/// The counts, every light and every group of lights with its power in `mix`, a line each.
std::vector<std::string> scene_summary(const Scene& scene, const LightMix& mix);

/// How each material scatters, on how many triangles and with which texture, a line each.
std::vector<std::string> material_summary(const Scene& scene);

/// The import's warnings, and what takes a look at every triangle: solid glass on open sheets.
std::vector<std::string> info_warnings(const Scene& scene);

/// Everything that `photile info` tells.
nlohmann::json scene_json(const Scene& scene, const LightMix& mix);

}  // namespace photile::app
