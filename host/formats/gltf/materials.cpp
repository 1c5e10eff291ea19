#include "gltf/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "gltf/document.hpp"
#include "photile/limits.hpp"
#include "photile/load_scene.hpp"
#include "scene/surface_models.hpp"

namespace photile::gltf {

namespace {

/// What distinguishes the picture from others, and its name in messages.
std::string name_of(const tinygltf::Image& image, std::size_t number) {
  return fmt::format("image {}{}", number, image.name.empty() ? "" : " " + image.name);
}

/// Index in Scene::textures of an image of the file. Errors: ResourceError where it cannot be read.
std::uint32_t texture_picture(const tinygltf::Model& model, std::size_t number,
                              const AccessorReader& accessors, pictures::TextureContent content,
                              pictures::TextureStore& textures) {
  const tinygltf::Image& image = model.images[number];
  const std::string name = name_of(image, number);
  if (image.bufferView >= 0) {
    return textures.from_memory(name, accessors.view(image.bufferView, name), content);
  }
  if (!image.image.empty()) return textures.from_memory(name, image.image, content);
  return textures.from_file(decoded_uri(image.uri), content);
}

}  // namespace

pictures::RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t number,
                                       const AccessorReader& accessors,
                                       files::SceneFolder& folder) {
  const tinygltf::Image& image = model.images[number];
  const std::string name = name_of(image, number);
  if (image.bufferView >= 0)
    return pictures::decode_rgbd(name, accessors.view(image.bufferView, name));
  if (!image.image.empty()) return pictures::decode_rgbd(name, image.image);
  const std::string file = decoded_uri(image.uri);
  return pictures::decode_rgbd(file, folder.read(file));
}

namespace {

constexpr const char* transform_name = "KHR_texture_transform";

TextureCoordinates coordinates_of(int set, const tinygltf::Value* transform) {
  TextureCoordinates result;
  result.set = set;
  if (transform == nullptr) return result;
  const glm::dvec3 offset = vector_member(*transform, "offset", glm::dvec3(0.0));
  const glm::dvec3 scale = vector_member(*transform, "scale", glm::dvec3(1.0));
  const double angle = number_member(*transform, "rotation", 0.0);
  // Counter-clockwise as seen in the picture, whose v axis points down.
  const glm::dmat2 rotation(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
  result.linear = rotation * glm::dmat2(scale.x, 0.0, 0.0, scale.y);
  result.offset = {offset.x, offset.y};
  result.set = integer_member(*transform, "texCoord", result.set);
  return result;
}

/// A texture as a material names it.
struct TextureReference {
  int index = -1;  ///< as the file has it: there need not be such a texture
  TextureCoordinates coordinates;

  bool given() const { return index != -1; }
};

/// Of a texture's info, a normal map's or that of an occlusion.
template <class Info>
TextureReference reference_of(const Info& info) {
  return {info.index,
          coordinates_of(info.texCoord, find_extension(info.extensions, transform_name))};
}

/// The texture that the member `name` of an extension refers to; not given where it is absent.
TextureReference reference_of(const tinygltf::Value& extension, const std::string& name) {
  if (!extension.Has(name) || !extension.Get(name).IsObject()) return {};
  const tinygltf::Value& info = extension.Get(name);
  const tinygltf::Value* transform = nullptr;
  if (info.Has("extensions") && info.Get("extensions").Has(transform_name)) {
    transform = &info.Get("extensions").Get(transform_name);
  }
  return {integer_member(info, "index", -1),
          coordinates_of(integer_member(info, "texCoord", 0), transform)};
}

/// From this transmission factor on a surface counts as glass.
constexpr double glass_transmission = 0.5;

class Converter {
 public:
  Converter(const tinygltf::Model& model, const AccessorReader& accessors,
            reading::ImportContext& context)
      : model_(model),
        accessors_(accessors),
        context_(context),
        textures_(context.scene, context.folder) {}

  MaterialCoordinates add(const tinygltf::Material& source, const std::string& name);

 private:
  void warn(const std::string& message) { context_.warnings.add("material", name_, message); }
  MetallicRoughness model_of(const tinygltf::Material& source);
  void set_glass(const tinygltf::Material& source, const MetallicRoughness& model,
                 Material& material);
  void warn_about_glass(const tinygltf::Material& source, const MetallicRoughness& model,
                        const tinygltf::Value* volume);
  void set_opaque(const tinygltf::Material& source, MetallicRoughness model, Material& material);
  void set_opacity(const tinygltf::Material& source, bool emits, Material& material);
  void set_normal_map(const tinygltf::Material& source, Material& material);
  reading::Emission emission_of(const tinygltf::Material& source);
  std::uint32_t load_texture(int texture, pictures::TextureContent content);
  std::uint32_t surface_texture(const TextureReference& reference, pictures::TextureContent content,
                                const std::string& what);

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  reading::ImportContext& context_;
  pictures::TextureStore textures_;
  std::string name_;
  std::optional<TextureCoordinates> shared_;  ///< of the material's textures so far
};

MetallicRoughness Converter::model_of(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  MetallicRoughness model;
  // By the specification that would be a metal which reflects all light, but a file that sets
  // nothing does not mean that.
  const bool unsaid = source.values.empty() &&
                      find_extension(source.extensions, "KHR_materials_transmission") == nullptr;
  if (unsaid) {
    model.base_color = glm::dvec3(scene::missing_albedo);
    model.metallic = model.specular_factor = 0;
    warn(
        "the file does not describe its surface; it becomes matt grey (0.5); set another "
        "reflectance by --reflectance");
    return model;
  }
  model.base_color = glm::clamp(rgb_of(pbr.baseColorFactor, glm::dvec3(1.0)), 0.0, 1.0);
  model.metallic = std::isfinite(pbr.metallicFactor) ? pbr.metallicFactor : 1.0;
  model.roughness = std::isfinite(pbr.roughnessFactor) ? pbr.roughnessFactor : 1.0;
  if (const auto* ior = find_extension(source.extensions, "KHR_materials_ior")) {
    // Values between 0 and 1 are not allowed; 0 itself asks for a reflectance of 1.
    const double index = number_member(*ior, "ior", model.index_of_refraction);
    if (index == 0.0 || index >= 1.0) {
      model.index_of_refraction = std::min(index, limits::max_index_of_refraction);
    }
  }
  if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular")) {
    model.specular_factor = number_member(*specular, "specularFactor", 1.0);
    model.specular_color =
        glm::max(vector_member(*specular, "specularColorFactor", glm::dvec3(1.0)), 0.0);
  }
  if (context_.options.lambertian) model.specular_factor = 0;
  return model;
}

void Converter::set_opaque(const tinygltf::Material& source, MetallicRoughness model,
                           Material& material) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  if (reference_of(pbr.baseColorTexture).given() && model.base_color != glm::dvec3(0.0)) {
    material.diffuse_texture = surface_texture(reference_of(pbr.baseColorTexture),
                                               pictures::TextureContent::srgb, "mid grey (0.5)");
    if (material.diffuse_texture == none) model.base_color = glm::dvec3(scene::missing_albedo);
  }
  model.texture =
      surface_texture(reference_of(pbr.metallicRoughnessTexture), pictures::TextureContent::data,
                      "the metallic and roughness factor");
  if (model.metallic > 0 && model.base_color != glm::dvec3(0.0) &&
      source.values.count("metallicFactor") == 0 &&
      !reference_of(pbr.metallicRoughnessTexture).given()) {
    warn(
        "the file does not say whether it is a metal, and by the default of glTF it is; where it "
        "is none, write \"metallicFactor\": 0 into its pbrMetallicRoughness");
  }
  if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular")) {
    model.specular_texture = surface_texture(reference_of(*specular, "specularTexture"),
                                             pictures::TextureContent::data, "the specular factor");
    model.specular_color_texture =
        surface_texture(reference_of(*specular, "specularColorTexture"),
                        pictures::TextureContent::srgb, "the specular colour");
  }
  scene::set_metallic_roughness(model, material);
  const bool varies = model.texture != none || model.specular_texture != none ||
                      model.specular_color_texture != none ||
                      (material.diffuse_texture != none && model.metallic > 0.0);
  if (varies && material.interaction == Interaction::opaque) {
    material.metallic_roughness =
        static_cast<std::uint32_t>(context_.scene.metallic_roughness.size());
    context_.scene.metallic_roughness.push_back(model);
  }
}

/// Emission knows no cutouts: what shines stays whole.
void Converter::set_opacity(const tinygltf::Material& source, bool emits, Material& material) {
  if (source.alphaMode != "MASK" && source.alphaMode != "BLEND") return;
  if (material.interaction == Interaction::glass) return;  // transmission says what passes
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  float opacity = 1.0f;
  if (pbr.baseColorFactor.size() == 4 && std::isfinite(pbr.baseColorFactor[3])) {
    opacity = static_cast<float>(std::clamp(pbr.baseColorFactor[3], 0.0, 1.0));
  }
  std::uint32_t texture = surface_texture(reference_of(pbr.baseColorTexture),
                                          pictures::TextureContent::srgb, "the alpha factor");
  if (texture != none && context_.scene.textures[texture].opaque()) texture = none;
  const bool mask = source.alphaMode == "MASK";
  // Above 1 nothing is there, by whatever amount.
  const double cutoff =
      mask && std::isfinite(source.alphaCutoff) ? std::min(source.alphaCutoff, 2.0) : 0.0;
  if (mask && (cutoff <= 0.0 || (texture == none && double{opacity} >= cutoff))) return;
  if (texture == none && opacity >= 1.0f) return;
  if (emits) {
    warn("alpha of a material that emits is ignored; it has no cutouts");
    return;
  }
  material.opacity = opacity;
  material.opacity_texture = texture;
  material.opacity_cutoff = static_cast<float>(cutoff);
  if (!mask) warn("alpha mode BLEND lets light straight through, without refraction or tint");
}

void Converter::set_normal_map(const tinygltf::Material& source, Material& material) {
  material.normal_texture = surface_texture(reference_of(source.normalTexture),
                                            pictures::TextureContent::data, "no normal map");
  const double scale = source.normalTexture.scale;
  if (std::isfinite(scale)) {
    material.normal_scale =
        static_cast<float>(std::clamp(scale, -limits::max_normal_scale, limits::max_normal_scale));
  }
}

void Converter::set_glass(const tinygltf::Material& source, const MetallicRoughness& model,
                          Material& material) {
  material.interaction = Interaction::glass;
  material.specular = glm::vec3(1.0f);
  material.transmission = glm::vec3(model.base_color);
  material.index_of_refraction = static_cast<float>(std::max(model.index_of_refraction, 1.0));
  const auto* volume = find_extension(source.extensions, "KHR_materials_volume");
  material.thin = volume == nullptr || number_member(*volume, "thicknessFactor", 0.0) <= 0.0;
  warn_about_glass(source, model, volume);
}

/// What a glass specifies and photile does not support.
void Converter::warn_about_glass(const tinygltf::Material& source, const MetallicRoughness& model,
                                 const tinygltf::Value* volume) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  // glTF's roughness is 1 where the file does not give any.
  if (model.roughness > scene::mirror_roughness) {
    warn(fmt::format("rough glass (roughness {:.3g}) is treated as smooth", model.roughness));
  }
  if (reference_of(pbr.metallicRoughnessTexture).given()) {
    warn("roughness texture of glass is ignored; it is smooth");
  }
  if (reference_of(pbr.baseColorTexture).given()) {
    warn("base-colour texture of glass is ignored; its factor is used");
  }
  if (find_extension(source.extensions, "KHR_materials_transmission")->Has("transmissionTexture")) {
    warn("transmission texture is ignored; all of the surface is glass");
  }
  if (volume != nullptr && volume->Has("attenuationDistance")) {
    warn("attenuation inside glass is ignored");
  }
}

std::uint32_t Converter::load_texture(int texture, pictures::TextureContent content) {
  const tinygltf::Texture* const source = element(model_.textures, texture);
  if (source == nullptr) throw files::ResourceError(fmt::format("there is no texture {}", texture));
  const auto* webp = find_extension(source->extensions, "EXT_texture_webp");
  const int picture =
      source->source >= 0 || webp == nullptr ? source->source : integer_member(*webp, "source", -1);
  if (element(model_.images, picture) == nullptr) {
    throw files::ResourceError(
        fmt::format("texture {} has no picture in a supported format", texture));
  }
  const tinygltf::Sampler* const sampler = element(model_.samplers, source->sampler);
  const auto has_wrap = [&](int mode) {
    return sampler != nullptr && (sampler->wrapS == mode || sampler->wrapT == mode);
  };
  if (has_wrap(TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) ||
      has_wrap(TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)) {
    warn("texture repeats where the file clamps or mirrors it");
  }
  return texture_picture(model_, static_cast<std::size_t>(picture), accessors_, content, textures_);
}

/// A texture of the surface; `none` where the material has none or it cannot be used. `substitute`
/// says what is used then.
std::uint32_t Converter::surface_texture(const TextureReference& reference,
                                         pictures::TextureContent content,
                                         const std::string& substitute) {
  if (!reference.given()) return none;
  if (shared_ && *shared_ != reference.coordinates) {
    warn("a texture with other coordinates than the first is ignored; " + substitute +
         " is used instead");
    return none;
  }
  try {
    const std::uint32_t texture = load_texture(reference.index, content);
    shared_ = reference.coordinates;
    return texture;
  } catch (const files::ResourceError& error) {
    warn(std::string(error.what()) + "; " + substitute + " is used instead");
    return none;
  }
}

MaterialCoordinates Converter::add(const tinygltf::Material& source, const std::string& name) {
  name_ = name;
  shared_.reset();
  Material material;
  material.name = name;
  const MetallicRoughness model = model_of(source);
  double transmission = 0.0;
  if (const auto* extension = find_extension(source.extensions, "KHR_materials_transmission")) {
    transmission = number_member(*extension, "transmissionFactor", 0.0);
  }
  if (transmission >= glass_transmission) {
    set_glass(source, model, material);
  } else {
    if (transmission > 0.0) warn("transmission below 0.5 is treated as opaque");
    set_opaque(source, model, material);
  }
  set_normal_map(source, material);
  if (reference_of(source.occlusionTexture).given())
    warn("occlusion texture is ignored, as light is traced");
  const reading::Emission emission = emission_of(source);
  set_opacity(source, emission.radiance != glm::dvec3(0.0), material);
  context_.scene.materials.push_back(std::move(material));
  context_.emission.push_back(emission);
  return {shared_.value_or(TextureCoordinates()), reference_of(source.emissiveTexture).coordinates};
}

reading::Emission Converter::emission_of(const tinygltf::Material& source) {
  reading::Emission emission;
  emission.radiance = rgb_of(source.emissiveFactor, glm::dvec3(0.0));
  if (const auto* strength = find_extension(source.extensions, "KHR_materials_emissive_strength")) {
    emission.radiance *= number_member(*strength, "emissiveStrength", 1.0);
  }
  emission.radiance *= static_cast<double>(context_.options.emissive_scale);
  emission.two_sided = source.doubleSided;
  if (!reference_of(source.emissiveTexture).given() || emission.radiance == glm::dvec3(0.0))
    return emission;
  try {
    emission.texture = load_texture(source.emissiveTexture.index, pictures::TextureContent::srgb);
  } catch (const files::ResourceError& error) {
    warn(std::string(error.what()) + "; the emissive factor is used alone");
  }
  return emission;
}

void note_blender_units(const tinygltf::Model& model, reading::ImportContext& context) {
  const bool from_blender =
      model.asset.generator.find("Khronos glTF Blender I/O") != std::string::npos;
  const bool scaled = context.options.emissive_scale != SceneLoadOptions{}.emissive_scale;
  for (std::size_t i = 0; i < context.emission.size() && from_blender && !scaled; ++i) {
    if (context.emission[i].radiance == glm::dvec3(0.0)) continue;
    context.warnings.add("material", context.scene.materials[i].name,
                         "Blender writes emission in W/(m2 sr), not cd/m2; an "
                         "emissive scale of 683 matches its lamps");
  }
}

}  // namespace

std::vector<MaterialCoordinates> add_gltf_materials(const tinygltf::Model& model,
                                                    const AccessorReader& accessors,
                                                    reading::ImportContext& context) {
  Converter converter(model, accessors, context);
  std::vector<MaterialCoordinates> coordinates;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const std::string& name = model.materials[i].name;
    coordinates.push_back(
        converter.add(model.materials[i], name.empty() ? fmt::format("material {}", i) : name));
  }
  // Only where it is used: it has a specular lobe, which makes later stages slower.
  const bool default_used =
      std::any_of(model.meshes.begin(), model.meshes.end(), [](const tinygltf::Mesh& mesh) {
        return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                           [](const tinygltf::Primitive& p) { return p.material < 0; });
      });
  if (default_used) coordinates.push_back(converter.add(tinygltf::Material(), "default"));
  note_blender_units(model, context);
  return coordinates;
}

}  // namespace photile::gltf
