#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gltf/document.hpp"

namespace photile::gltf {
namespace {

constexpr std::array<std::string_view, 14> understood_extensions{
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
    "KHR_texture_transform",
};

/// Nothing that a picture could show.
constexpr std::array<std::string_view, 4> harmless_extensions{
    "EXT_structural_metadata",
    "FB_ngon_encoding",
    "KHR_xmp",
    "KHR_xmp_json_ld",
};

/// What to do about extensions that files of the wild have.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> remedies{{
    {"EXT_mesh_gpu_instancing", "its copies are missing; export them as nodes"},
    {"KHR_materials_anisotropy", "brushed metal shines alike in all directions"},
    {"KHR_materials_clearcoat", "coats are left out: what is below them reflects alone"},
    {"KHR_materials_pbrSpecularGlossiness",
     "its colours are lost; convert them to metallic-roughness"},
    {"KHR_materials_sheen", "cloth has no sheen"},
    {"KHR_materials_unlit", "its surfaces are lit as all others are"},
    {"KHR_materials_variants", "surfaces have their default materials"},
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
    throw context.error(fmt::format("requires the glTF extension {}, which is not understood; {}",
                                    extension, remedy_for(extension, "export without it")));
  }
}

void warn_of_extensions(const tinygltf::Model& model, reading::ImportContext& context) {
  for (const std::string& extension : model.extensionsUsed) {
    if (is_understood(extension)) continue;
    context.warnings.add("extension", extension,
                         "not understood; " + remedy_for(extension, "what it says is ignored"));
  }
}

}  // namespace photile::gltf
