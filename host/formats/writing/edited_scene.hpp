// A copy of a scene's file with other lights: the call, and a light as the writers of copies set
// it.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "reading/area_lights.hpp"

namespace photile::writing {

struct LightSetting {
  reading::LightSource source;
  std::string name;
  std::string material;    ///< of a surface
  bool textured = false;   ///< its emission has a texture
  double old_power = 0;    ///< what the file gives, > 0
  double power = 0;        ///< requested
  glm::dvec3 color{1.0};   ///< requested, of luminance 1
  glm::dvec3 tint{1.0};    ///< what its old colour is multiplied by
  double factor = 1;       ///< of its layer's power; power = old_power x factor x luminance of the
                           ///< tinted old colour
  bool recolored = false;  ///< `color` replaces what the file says
  bool shared = false;     ///< all instances of its lamp are in its layer, and set as it is

  bool changed() const { return recolored || factor != 1; }
  double ratio() const { return power / old_power; }
  /// What an emission `rgb` of the file becomes.
  glm::dvec3 emission(const glm::dvec3& rgb) const {
    if (textured) return factor * tint * rgb;
    return recolored ? luminance(rgb) * ratio() * color : ratio() * rgb;
  }
};

/// Writes `copy`. `left_out` gets a line for each light
/// that cannot be set. Errors: InputError, OutputError.
void write_lit_gltf(const std::filesystem::path& scene, const std::filesystem::path& copy,
                    std::span<const LightSetting> settings, const SceneLoadOptions& options,
                    std::vector<std::string>& left_out);

/// Errors: OutputError where there is such a file: no copy is written over another file.
void refuse_taken(const std::filesystem::path& file);

struct EditedScene {
  std::filesystem::path file;
  /// A line for each light that the file cannot hold as the mix has it: its name and why.
  std::vector<std::string> left_out;
};

/// SCENE.NAME.gltf (.glb, .obj) beside the scene: its file with lights of the powers and colours of
/// `mix`. In glTF the intensities and colours of KHR_lights_punctual, emissive factors and
/// strengths, and what photile reads beside them (EXT_lights_ies, EXT_lights_area, photile_lumens,
/// photile_kelvin); lights that share a definition, a material or a mesh get their own. An OBJ file
/// gets a separate library, SCENE.NAME.mtl, with other Ke. Everything else stays as it was. Lights
/// of power 0 stay in the file and emit nothing, so that they are dropped when it is read.
///   scene     file to copy; its buffers, pictures and libraries stay where they are
///   options   with which it was loaded: lights that they add are left out
///   mix       of LightMix::of, changed
///   name      cleaned as names of lights are
/// Errors: those of load_scene; OutputError where the copy cannot be written or its name is taken.
EditedScene write_edited_scene(const std::filesystem::path& scene, const SceneLoadOptions& options,
                               const LightMix& mix, const std::string& name);

}  // namespace photile::writing
