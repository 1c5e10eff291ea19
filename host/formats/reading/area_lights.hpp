// Emissive triangles become area lights, and each light keeps where in its file it comes from.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "files/scene_files.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"

namespace photile::reading {

/// Where in its file a light comes from.
struct LightSource {
  enum class Kind : std::uint8_t {
    node,         ///< KHR_lights_punctual or photometric data at a glTF node
    surface,      ///< an emissive material
    panel,        ///< a luminous rectangle or disc at a glTF node
    picture,      ///< EXT_lights_image_based of the glTF scene
    surroundings  ///< an option, not the file
  };
  Kind kind = Kind::surroundings;
  std::uint32_t node = none;      ///< of the glTF file
  std::uint32_t material = none;  ///< of a surface: into Scene::materials, and the glTF file's
  std::string lamp = {};          ///< what the file has once for all instances; "" = just this one

  /// A key that instances of one lamp have in common, and no other lights.
  using LampKey = std::tuple<Kind, std::uint32_t, std::string>;
  LampKey lamp_key() const { return {kind, material, lamp}; }
};

/// The data of a file about the lights of an object beside their emission.
struct LightTraits {
  std::string group;      ///< "" = none
  double lumens = 0;      ///< of the object's lights together; 0 = not given
  double kelvin = 0;      ///< 0 = not given
  std::string lamp = {};  ///< as LightSource::lamp
};

/// Panels count as further objects, after all visits of nodes.
inline constexpr std::uint64_t first_panel_object = limits::max_node_visits;

/// What a material emits, in cd/m2 or W/(m2 sr).
struct Emission {
  glm::dvec3 radiance{0.0};  ///< of a white texel, where there is a texture
  bool two_sided = false;
  std::uint32_t texture = none;  ///< into Scene::textures
};

/// One light per object (a glTF node, an OBJ object or group) and emissive material.
class AreaLights {
 public:
  explicit AreaLights(Scene& scene) : scene_(scene) {}

  /// The light of `object` and `material`, or `none` when the material emits nothing. `traits` are
  /// those of the object's lights. Errors: InputError beyond limits::max_lights.
  std::uint32_t find_or_add(std::uint64_t object, const std::string& object_name,
                            std::uint32_t material, const Emission& emission,
                            const LightTraits& traits = {});

  /// The arguments of find_or_add for a light.
  struct Origin {
    std::uint64_t object;
    std::uint32_t material;
    std::string lamp;  ///< of the traits
  };

  /// Lists each light's triangles and computes its power. Lights that got no triangle are dropped
  /// with a warning. Call once, after the last triangle. Returns the origins of the lights that it
  /// appended to the scene.
  std::vector<Origin> finish(files::Warnings& warnings);

 private:
  struct Pending {
    std::uint64_t object;
    std::string object_name;
    std::uint32_t material;
    Emission emission;
    LightTraits traits;
  };
  std::string name_of(const Pending& light) const;
  bool set_emission(const Pending& pending, double area, Light& light,
                    files::Warnings& warnings) const;
  void apply_lumens(std::size_t first_light, const std::vector<const Pending*>& sources);

  Scene& scene_;
  std::vector<Pending> pending_;
  /// By object, material and texture: a primitive without coordinates loses the texture.
  std::map<std::tuple<std::uint64_t, std::uint32_t, std::uint32_t>, std::uint32_t> index_;
  std::map<std::uint64_t, int> materials_of_object_;
};

}  // namespace photile::reading
