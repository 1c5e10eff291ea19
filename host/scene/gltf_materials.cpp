#include "scene/gltf_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf_document.hpp"
#include "scene/resource_error.hpp"
#include "scene/surface_models.hpp"
#include "scene/texture_store.hpp"

namespace photile::scene_io {
namespace {

/// From this transmission factor on a surface counts as glass.
constexpr double glass_transmission = 0.5;

class Converter {
 public:
  Converter(const tinygltf::Model& model, const AccessorReader& accessors, ImportContext& context)
      : model_(model),
        accessors_(accessors),
        context_(context),
        textures_(context.scene, context.folder) {}

  MaterialCoordinates add(const tinygltf::Material& source, const std::string& name);

 private:
  void warn(const std::string& message) { context_.warnings.add("material", name_, message); }
  void warn_about_ignored(const tinygltf::Material& source);
  void set_surface(const tinygltf::Material& source, Material& material);
  void set_glass(const tinygltf::Material& source, const MetallicRoughness& model,
                 Material& material);
  void add_texture(const tinygltf::TextureInfo& info, Material& material);
  Emission emission_of(const tinygltf::Material& source);
  std::uint32_t load_texture(int texture);
  TextureCoordinates coordinates(const tinygltf::TextureInfo& info);

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  ImportContext& context_;
  TextureStore textures_;
  std::string name_;
};

void Converter::warn_about_ignored(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  if (pbr.metallicRoughnessTexture.index >= 0) {
    warn("metallic-roughness texture is ignored; its factors are used");
  }
  if (source.normalTexture.index >= 0) warn("normal texture is ignored");
  if (source.occlusionTexture.index >= 0) warn("occlusion texture is ignored");
  if (source.alphaMode != "OPAQUE")
    warn("alpha mode " + source.alphaMode + " is treated as opaque");
  if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular")) {
    if (specular->Has("specularTexture") || specular->Has("specularColorTexture")) {
      warn("specular textures are ignored; their factors are used");
    }
  }
}

void Converter::set_surface(const tinygltf::Material& source, Material& material) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  MetallicRoughness model;
  model.base_color = glm::clamp(rgb_of(pbr.baseColorFactor, glm::dvec3(1.0)), 0.0, 1.0);
  model.metallic = std::isfinite(pbr.metallicFactor) ? pbr.metallicFactor : 1.0;
  model.roughness = std::isfinite(pbr.roughnessFactor) ? pbr.roughnessFactor : 1.0;
  if (const auto* ior = find_extension(source.extensions, "KHR_materials_ior")) {
    // Values between 0 and 1 are not allowed; 0 itself asks for a reflectance of 1.
    const double index = number_member(*ior, "ior", model.index_of_refraction);
    if (index == 0.0 || index >= 1.0) model.index_of_refraction = index;
  }
  if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular")) {
    model.specular_factor = number_member(*specular, "specularFactor", 1.0);
    model.specular_color =
        glm::max(vector_member(*specular, "specularColorFactor", glm::dvec3(1.0)), 0.0);
  }
  if (const auto* extension = find_extension(source.extensions, "KHR_materials_transmission")) {
    const double transmission = number_member(*extension, "transmissionFactor", 0.0);
    if (transmission >= glass_transmission) return set_glass(source, model, material);
    if (transmission > 0.0) warn("transmission below 0.5 is treated as opaque");
  }
  set_metallic_roughness(model, material);
}

void Converter::set_glass(const tinygltf::Material& source, const MetallicRoughness& model,
                          Material& material) {
  material.interaction = Interaction::glass;
  material.specular = glm::vec3(1.0f);
  material.transmission = glm::vec3(model.base_color);
  material.index_of_refraction = static_cast<float>(std::max(model.index_of_refraction, 1.0));
  const auto* volume = find_extension(source.extensions, "KHR_materials_volume");
  material.thin = volume == nullptr || number_member(*volume, "thicknessFactor", 0.0) <= 0.0;
  if (model.roughness > mirror_roughness && source.pbrMetallicRoughness.roughnessFactor < 1.0) {
    warn("rough glass is treated as smooth");
  }
}

std::uint32_t Converter::load_texture(int texture) {
  if (texture < 0 || static_cast<std::size_t>(texture) >= model_.textures.size()) {
    throw ResourceError(fmt::format("there is no texture {}", texture));
  }
  const tinygltf::Texture& source = model_.textures[static_cast<std::size_t>(texture)];
  if (source.source < 0 || static_cast<std::size_t>(source.source) >= model_.images.size()) {
    throw ResourceError(fmt::format("texture {} has no picture of a format that is read", texture));
  }
  const auto has_wrap = [&](int mode) {
    if (source.sampler < 0 || static_cast<std::size_t>(source.sampler) >= model_.samplers.size()) {
      return false;
    }
    const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(source.sampler)];
    return sampler.wrapS == mode || sampler.wrapT == mode;
  };
  if (has_wrap(TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) ||
      has_wrap(TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)) {
    warn("texture repeats where the file clamps or mirrors it");
  }
  const tinygltf::Image& image = model_.images[static_cast<std::size_t>(source.source)];
  const std::string key =
      fmt::format("image {}{}", source.source, image.name.empty() ? "" : " " + image.name);
  if (image.bufferView >= 0) {
    return textures_.from_memory(key, accessors_.view(image.bufferView, key));
  }
  if (!image.image.empty()) return textures_.from_memory(key, image.image);
  return textures_.from_file(decoded_uri(image.uri));
}

void Converter::add_texture(const tinygltf::TextureInfo& info, Material& material) {
  try {
    material.diffuse_texture = load_texture(info.index);
  } catch (const ResourceError& error) {
    use_missing_texture_colour(material);
    warn(std::string(error.what()) + "; mid grey (0.5) is used instead");
  }
}

TextureCoordinates Converter::coordinates(const tinygltf::TextureInfo& info) {
  TextureCoordinates result;
  result.set = info.texCoord;
  const auto* transform = find_extension(info.extensions, "KHR_texture_transform");
  if (transform == nullptr) return result;
  const glm::dvec3 offset = vector_member(*transform, "offset", glm::dvec3(0.0));
  const glm::dvec3 scale = vector_member(*transform, "scale", glm::dvec3(1.0));
  const double angle = number_member(*transform, "rotation", 0.0);
  // Counter-clockwise as seen in the picture, whose v axis points down.
  const glm::dmat2 rotation(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
  result.linear = rotation * glm::dmat2(scale.x, 0.0, 0.0, scale.y);
  result.offset = {offset.x, offset.y};
  result.set = static_cast<int>(number_member(*transform, "texCoord", result.set));
  return result;
}

MaterialCoordinates Converter::add(const tinygltf::Material& source, const std::string& name) {
  name_ = name;
  Material material;
  material.name = name;
  set_surface(source, material);
  warn_about_ignored(source);
  const tinygltf::TextureInfo& texture = source.pbrMetallicRoughness.baseColorTexture;
  if (texture.index >= 0) {
    if (material.interaction == Interaction::opaque && material.diffuse != glm::vec3(0.0f)) {
      add_texture(texture, material);
    } else {
      warn("base-colour texture of a metal or glass is ignored; its factor is used");
    }
  }
  context_.scene.materials.push_back(std::move(material));
  context_.emission.push_back(emission_of(source));
  return {coordinates(texture), coordinates(source.emissiveTexture)};
}

Emission Converter::emission_of(const tinygltf::Material& source) {
  Emission emission;
  emission.radiance = rgb_of(source.emissiveFactor, glm::dvec3(0.0));
  if (const auto* strength = find_extension(source.extensions, "KHR_materials_emissive_strength")) {
    emission.radiance *= number_member(*strength, "emissiveStrength", 1.0);
  }
  emission.radiance *= static_cast<double>(context_.options.emissive_scale);
  emission.two_sided = source.doubleSided;
  if (source.emissiveTexture.index < 0 || emission.radiance == glm::dvec3(0.0)) return emission;
  try {
    emission.texture = load_texture(source.emissiveTexture.index);
  } catch (const ResourceError& error) {
    warn(std::string(error.what()) + "; the emissive factor is used alone");
  }
  return emission;
}

void note_blender_units(const tinygltf::Model& model, ImportContext& context) {
  const bool from_blender =
      model.asset.generator.find("Khronos glTF Blender I/O") != std::string::npos;
  const bool scaled = context.options.emissive_scale != SceneLoadOptions{}.emissive_scale;
  for (std::size_t i = 0; i < context.emission.size() && from_blender && !scaled; ++i) {
    if (context.emission[i].radiance == glm::dvec3(0.0)) continue;
    context.warnings.add("material", context.scene.materials[i].name,
                         "Blender writes emission in W/(m2 sr), not cd/m2; pass "
                         "--emissive-scale 683 to match its lamps");
  }
}

}  // namespace

std::vector<MaterialCoordinates> add_gltf_materials(const tinygltf::Model& model,
                                                    const AccessorReader& accessors,
                                                    ImportContext& context) {
  Converter converter(model, accessors, context);
  std::vector<MaterialCoordinates> coordinates;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const std::string& name = model.materials[i].name;
    coordinates.push_back(
        converter.add(model.materials[i], name.empty() ? fmt::format("material {}", i) : name));
  }
  // Only where it is used: it has a specular lobe, which costs later stages something.
  const bool default_used =
      std::any_of(model.meshes.begin(), model.meshes.end(), [](const tinygltf::Mesh& mesh) {
        return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                           [](const tinygltf::Primitive& p) { return p.material < 0; });
      });
  if (default_used) coordinates.push_back(converter.add(tinygltf::Material(), "default"));
  note_blender_units(model, context);
  return coordinates;
}

}  // namespace photile::scene_io
