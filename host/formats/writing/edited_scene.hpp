// A copy of a scene's file with other lights.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"

namespace photile::writing {

struct EditedScene {
  std::filesystem::path file;
  /// A line for each light that the file cannot hold as the mix has it: its name and why.
  std::vector<std::string> left_out;
};

/// SCENE.NAME.gltf (.glb, .obj) beside the scene: its file with lights of the powers and colours of
/// `mix`. In glTF the intensities and colours of KHR_lights_punctual, emissive factors and
/// strengths, and what photile reads beside them (EXT_lights_ies, EXT_lights_area, photile_lumens,
/// photile_kelvin); lights that share a definition, a material or a mesh get their own. An OBJ file
/// gets a library of its own, SCENE.NAME.mtl, with other Ke. Everything else stays as it was.
/// Lights of power 0 stay in the file and emit nothing, so that they are dropped when it is read.
///   scene     file to copy; its buffers, pictures and libraries stay where they are
///   options   with which it was loaded: lights that they add are left out
///   mix       of LightMix::of, changed
///   name      cleaned as names of lights are
/// Errors: those of load_scene; OutputError where the copy cannot be written or its name is taken.
EditedScene write_edited_scene(const std::filesystem::path& scene, const SceneLoadOptions& options,
                               const LightMix& mix, const std::string& name);

}  // namespace photile::writing
