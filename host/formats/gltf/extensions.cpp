#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gltf/document.hpp"
#include "gltf/meshes.hpp"
#include "gltf/nodes.hpp"

namespace photile::gltf {
namespace {

constexpr std::array<std::string_view, 15> understood_extensions{
    "EXT_lights_area",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
};

/// Extensions without effect on a picture.
constexpr std::array<std::string_view, 14> harmless_extensions{
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "FB_ngon_encoding",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_packing_occlusionRoughnessMetallic",
};

/// What is rendered in place of what extensions describe, or what to do about them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> remedies{{
    {"EXT_mesh_gpu_instancing", "its copies are missing; export them as nodes"},
    {"EXT_texture_avif", "save its textures as PNG or JPEG"},
    {"KHR_animation_pointer", "its animations are ignored"},
    {"KHR_materials_anisotropy", "highlights are the same in all directions"},
    {"KHR_materials_clearcoat", "coats are ignored: only the surface below reflects"},
    {"KHR_materials_diffuse_transmission",
     "no light passes through; export thin sheets with alpha BLEND"},
    {"KHR_materials_dispersion", "glass refracts all colours alike"},
    {"KHR_materials_iridescence", "thin films have no colours"},
    {"KHR_materials_pbrSpecularGlossiness",
     "its colours are lost; convert them to metallic-roughness"},
    {"KHR_materials_sheen", "cloth has no sheen"},
    {"KHR_materials_unlit", "its surfaces are lit like all others"},
    {"KHR_materials_variants", "surfaces have their default materials"},
    {"KHR_materials_volume_scatter", "no light scatters below surfaces"},
    {"KHR_texture_basisu", "save its textures as PNG or JPEG"},
}};

bool is_understood(std::string_view extension) {
  const auto among = [&](std::span<const std::string_view> names) {
    return std::ranges::find(names, extension) != names.end();
  };
  return among(understood_extensions) || among(harmless_extensions);
}

std::string remedy_for(std::string_view extension, std::string_view otherwise) {
  const auto* const found = std::find_if(remedies.begin(), remedies.end(), [&](const auto& remedy) {
    return remedy.first == extension;
  });
  return std::string(found == remedies.end() ? otherwise : found->second);
}

}  // namespace

void check_required_extensions(const std::vector<std::string>& required,
                               const reading::ImportContext& context) {
  for (const std::string& extension : required) {
    if (is_understood(extension)) continue;
    throw context.error(
        fmt::format("the file requires the glTF extension {}, which is not supported; {}",
                    extension, remedy_for(extension, "export without it")));
  }
}

namespace {

/// Names the objects that have the extension. Returns whether there are any.
class ExtensionUsers {
 public:
  ExtensionUsers(const tinygltf::Model& model, std::string extension, const std::string& remedy,
                 files::Warnings& warnings)
      : model_(model),
        extension_(std::move(extension)),
        message_(extension_ + " is not supported; " + remedy),
        warnings_(warnings) {}

  bool warn() {
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      add(model_.nodes[i], "node", node_name(model_, static_cast<int>(i)));
    }
    for (std::size_t i = 0; i < model_.meshes.size(); ++i) {
      const std::string name = name_of_mesh(model_, static_cast<int>(i));
      add(model_.meshes[i], "mesh", name);
      for (const tinygltf::Primitive& primitive : model_.meshes[i].primitives) {
        add(primitive, "mesh", name);
      }
    }
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      const std::string& name = model_.materials[i].name;
      add(model_.materials[i], "material", name.empty() ? fmt::format("material {}", i) : name);
    }
    for (std::size_t i = 0; i < model_.textures.size(); ++i) {
      add(model_.textures[i], "texture", fmt::format("{}", i));
    }
    return found_;
  }

 private:
  template <class Object>
  void add(const Object& object, const char* kind, const std::string& name) {
    if (!find_extension(object.extensions, extension_)) return;
    warnings_.add(kind, name, message_);
    found_ = true;
  }

  const tinygltf::Model& model_;
  const std::string extension_, message_;
  files::Warnings& warnings_;
  bool found_ = false;
};

}  // namespace

void warn_of_extensions(const tinygltf::Model& model, reading::ImportContext& context) {
  for (const std::string& extension : model.extensionsUsed) {
    if (is_understood(extension)) continue;
    const std::string remedy = remedy_for(extension, "its contents are ignored");
    if (!ExtensionUsers(model, extension, remedy, context.warnings).warn()) {
      context.warnings.add("extension", extension, "not supported; " + remedy);
    }
  }
}

}  // namespace photile::gltf
