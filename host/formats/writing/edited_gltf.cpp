// glTF: the JSON of the file with other numbers, and with copies of what lights share.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "common/files.hpp"
#include "files/scene_files.hpp"
#include "gltf/binary_file.hpp"
#include "photile/errors.hpp"
#include "writing/edited_scene.hpp"

namespace photile::writing {
namespace {

using Json = nlohmann::ordered_json;

glm::dvec3 rgb_in(const Json& object, const char* key, const glm::dvec3& fallback) {
  glm::dvec3 rgb = fallback;
  if (!object.contains(key) || !object[key].is_array()) return rgb;
  for (std::size_t c = 0; c < std::min<std::size_t>(3, object[key].size()); ++c) {
    rgb[static_cast<int>(c)] = object[key][c].get<double>();
  }
  return rgb;
}

/// The number of a node, mesh or light that `key` names; -1 where it names none. As an int towards
/// zero, as the importer reads it, and the largest one in place of those beyond.
int index_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return -1;
  constexpr double largest = std::numeric_limits<int>::max();
  return static_cast<int>(std::clamp(found->get<double>(), -1.0, largest));
}

Json array_of(const glm::dvec3& rgb) { return Json::array({rgb.r, rgb.g, rgb.b}); }

/// Splits an emission into a colour in [0, 1] and its strength, as glTF has them.
void set_scaled(Json& object, const char* color_key, const char* strength_key,
                const glm::dvec3& emission) {
  const double strength = std::max({emission.r, emission.g, emission.b});
  object[strength_key] = strength;
  if (strength > 0) object[color_key] = array_of(emission / strength);
}

Json* extension_of(Json& object, const char* name) {
  if (!object.contains("extensions") || !object["extensions"].contains(name)) return nullptr;
  return &object["extensions"][name];
}

/// One file's JSON while its lights are set.
class Document {
 public:
  Document(Json& json, const SceneLoadOptions& options, std::vector<std::string>& left_out)
      : json_(json), options_(options), left_out_(left_out) {}

  void set(std::span<const LightSetting> all) {
    std::vector<LightSetting> settings(all.begin(), all.end());
    recolor_whole_nodes(settings);
    for (const LightSetting& light : settings) {
      if (light.source.kind == reading::LightSource::Kind::surface && is_first_instance(light)) {
        ++lights_of_[light.source.material];
      }
    }
    seen_.clear();
    for (const LightSetting& light : settings) {
      if (!light.changed()) continue;
      if (light.source.kind == reading::LightSource::Kind::node) set_node(light);
      if (light.source.kind == reading::LightSource::Kind::surface) set_surface(light);
      if (light.source.kind == reading::LightSource::Kind::panel) set_panel(light);
    }
    set_lumens_of_surfaces(settings);
  }

 private:
  Json& node(const LightSetting& light) { return json_["nodes"].at(light.source.node); }

  /// False for all but the first of lights that share their setting and what defines them.
  bool is_first_instance(const LightSetting& light) {
    return !light.shared || seen_.insert(light.source.lamp_key()).second;
  }

  /// The number `key` among the extras of a light's node, or null.
  Json* extra(const LightSetting& light, const char* key) {
    Json& of = node(light);
    if (!of.contains("extras") || !of["extras"].contains(key)) return nullptr;
    return &of["extras"][key];
  }

  /// A temperature colours all lights of its node, so that either all keep it or none.
  void recolor_whole_nodes(std::vector<LightSetting>& settings) {
    std::set<std::uint32_t> nodes;
    for (const LightSetting& light : settings) {
      if (light.recolored && extra(light, "photile_kelvin")) nodes.insert(light.source.node);
    }
    for (LightSetting& light : settings) {
      if (nodes.contains(light.source.node)) light.recolored = true;
    }
    for (const std::uint32_t number : nodes) {
      json_["nodes"][number]["extras"].erase("photile_kelvin");
    }
  }

  /// The definition of a node's light in an extension; a separate copy for this node.
  Json& own_definition(const LightSetting& light, const char* extension) {
    Json& lights = json_["extensions"][extension]["lights"];
    Json& own = node(light)["extensions"][extension];
    const int index = index_in(own, "light");
    std::size_t uses = 0;
    for (Json& other : json_["nodes"]) {
      const Json* reference = extension_of(other, extension);
      if (reference && index_in(*reference, "light") == index) ++uses;
    }
    if (uses == 1 || light.shared) return lights.at(static_cast<std::size_t>(index));
    lights.push_back(Json(lights.at(static_cast<std::size_t>(index))));
    own["light"] = lights.size() - 1;
    return lights.back();
  }

  static void set_definition(Json& object, const char* strength_key, const LightSetting& light) {
    const double strength = object.value(strength_key, 1.0);
    if (light.recolored) {
      set_scaled(object, "color", strength_key,
                 light.emission(strength * rgb_in(object, "color", glm::dvec3(1.0))));
    } else {
      object[strength_key] = strength * light.ratio();
    }
  }

  void set_node(const LightSetting& light) {
    if (Json* lumens = extra(light, "photile_lumens")) *lumens = light.power;
    if (Json* profile = extension_of(node(light), "EXT_lights_ies")) {
      set_definition(*profile, "multiplier", light);
      return;
    }
    if (extra(light, "photile_ies")) {
      // 0 lumens are not allowed: a lamp that is off loses its candela.
      Json& extras = node(light)["extras"];
      if (light.power > 0) {
        extras["photile_lumens"] = light.power;
      } else {
        extras.erase("photile_ies");
      }
    }
    if (extension_of(node(light), "KHR_lights_punctual")) {
      if (!is_first_instance(light)) return;
      set_definition(own_definition(light, "KHR_lights_punctual"), "intensity", light);
    } else if (light.recolored) {
      left_out_.push_back(light.name + ": has no colour in the file; only its power is set");
    }
  }

  /// The material of a light; a separate copy for this light.
  Json& own_material(const LightSetting& light) {
    Json& materials = json_["materials"];
    if (lights_of_[light.source.material] == 1) return materials.at(light.source.material);
    materials.push_back(Json(materials.at(light.source.material)));
    const std::size_t own = materials.size() - 1;
    for (Json& primitive : own_mesh(light)["primitives"]) {
      if (index_in(primitive, "material") == static_cast<int>(light.source.material)) {
        primitive["material"] = own;
      }
    }
    return materials[own];
  }

  /// The mesh of a light's node; a separate copy for this node.
  Json& own_mesh(const LightSetting& light) {
    Json& owner = node(light);
    Json& meshes = json_["meshes"];
    const int mesh = index_in(owner, "mesh");
    const auto uses =
        std::count_if(json_["nodes"].begin(), json_["nodes"].end(),
                      [&](const Json& other) { return index_in(other, "mesh") == mesh; });
    if (uses == 1 || light.shared) return meshes.at(static_cast<std::size_t>(mesh));
    meshes.push_back(Json(meshes.at(static_cast<std::size_t>(mesh))));
    owner["mesh"] = meshes.size() - 1;
    return meshes.back();
  }

  void set_surface(const LightSetting& light) {
    if (!is_first_instance(light)) return;
    constexpr const char* extension = "KHR_materials_emissive_strength";
    Json& material = own_material(light);
    glm::dvec3 emission = rgb_in(material, "emissiveFactor", glm::dvec3(0.0));
    if (const Json* strong = extension_of(material, extension)) {
      emission *= strong->value("emissiveStrength", 1.0);
    }
    emission = light.emission(emission);
    const double strength = std::max({emission.r, emission.g, emission.b});
    if (!extension_of(material, extension) && strength <= 1) {
      material["emissiveFactor"] = array_of(emission);
      return;
    }
    material["emissiveFactor"] = array_of(strength > 0 ? emission / strength : emission);
    material["extensions"][extension]["emissiveStrength"] = strength;
    Json& used = json_["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
  }

  void set_panel(const LightSetting& light) {
    const std::string node_name = node(light).value("name", "");
    const bool by_option =
        std::any_of(options_.panels.begin(), options_.panels.end(),
                    [&](const LuminousPanel& panel) { return panel.node == node_name; });
    if (by_option) {
      left_out_.push_back(light.name + ": comes from an option; change its lumens in that option");
    } else if (extra(light, "photile_area")) {
      *extra(light, "photile_lumens") = light.power;
      if (light.recolored) {
        left_out_.push_back(light.name + ": photile_area has no colour; only its power is set");
      }
    } else if (is_first_instance(light)) {
      set_definition(own_definition(light, "EXT_lights_area"), "intensity", light);
    }
  }

  /// Lumens of a node are shared by its surfaces.
  void set_lumens_of_surfaces(std::span<const LightSetting> settings) {
    std::map<std::uint32_t, double> power_of;
    for (const LightSetting& light : settings) {
      if (light.source.kind == reading::LightSource::Kind::surface &&
          extra(light, "photile_lumens")) {
        power_of[light.source.node] += light.power;
      }
    }
    for (const auto& [number, power] : power_of) {
      Json& extras = json_["nodes"][number]["extras"];
      // 0 lumens are not allowed; the emission is 0 then.
      if (power > 0) {
        extras["photile_lumens"] = power;
      } else {
        extras.erase("photile_lumens");
      }
    }
  }

  Json& json_;
  const SceneLoadOptions& options_;
  std::vector<std::string>& left_out_;
  std::map<std::uint32_t, int> lights_of_;        ///< of each material; instances of one count once
  std::set<reading::LightSource::LampKey> seen_;  ///< lamps of shared ones
};

}  // namespace

void write_lit_gltf(const std::filesystem::path& scene, const std::filesystem::path& copy,
                    std::span<const LightSetting> settings, const SceneLoadOptions& options,
                    std::vector<std::string>& left_out) {
  const std::vector<unsigned char> file = files::SceneFolder(scene, true).read_scene_file();
  const std::string bytes(file.begin(), file.end());
  const bool binary = gltf::BinaryFile::is(bytes);
  const gltf::BinaryFile parts(bytes);
  try {
    Json json = Json::parse(binary ? parts.json : bytes);
    Document(json, options, left_out).set(settings);
    write_file(copy, binary
                         ? gltf::BinaryFile::head(json.dump(), parts.rest.size()).append(parts.rest)
                         : json.dump(2) + "\n");
  } catch (const Json::exception&) {  // its text is meaningful to programmers only
    throw InputError(fmt::format(
        "{}: its lights cannot be set, because the file is malformed; export the file again",
        scene.string()));
  }
}

}  // namespace photile::writing
