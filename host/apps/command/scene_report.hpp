// The contents of a scene, as text and as JSON.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile::app {

/// Axis-aligned box around all vertices, metres, in the file's world.
struct Extents {
  glm::dvec3 lowest{0.0}, highest{0.0};
  glm::dvec3 size() const { return highest - lowest; }
};
Extents extents_of(const Scene& scene);

/// One line for all patches of a sky; none where the mix has no whole sky of patches.
std::vector<std::string> sky_summary(const LightMix& mix);

/// The counts, every light and every group of lights with its power in `mix`, a line each.
std::vector<std::string> scene_summary(const Scene& scene, const LightMix& mix);

/// The facts of the sky, a line each: "ground: reflectance 0.2 below the horizon".
std::vector<std::string> sky_lines(const SceneLoadOptions& load);

/// How each material scatters, on how many triangles and with which texture, a line each.
std::vector<std::string> material_summary(const Scene& scene);

/// The names that --set hide knows, with their triangles: a line for each of the largest.
std::vector<std::string> mesh_summary(const Scene& scene);

/// Warnings of what is allowed but seldom intended, a line each: materials that reflect nearly all
/// light, and lamps that emit less than a candle.
std::vector<std::string> doubts_of(const Scene& scene, const LightMix& mix);

/// Warns of the lights that are on and reach nothing: lights_that_reach_nothing.
///   reaches   per layer of the scene, in the order of layer_names
void warn_of_dark_lights(const Scene& scene, const LightMix& mix, const std::vector<bool>& reaches,
                         const std::string& what, Progress& progress);

/// The import's warnings, doubts_of, and those that need a pass over all triangles: solid glass on
/// open sheets.
std::vector<std::string> info_warnings(const Scene& scene, const LightMix& mix);

/// The rooms that photile import has listed beside the scene, or those that are found in it, a line
/// each. Errors: InputError naming the list.
std::vector<std::string> room_summary(const Scene& scene);

/// Everything that `photile info` prints. Errors: as above.
nlohmann::json scene_json(const Scene& scene, const LightMix& mix, const SceneLoadOptions& load);

}  // namespace photile::app
