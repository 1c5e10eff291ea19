#include "bake/write_baked.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "gltf/binary_file.hpp"
#include "image/display.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"

namespace photile::bake {
namespace {

using nlohmann::json;

constexpr int gltf_float = 5126;  ///< the component type

/// "room.gltf" and "bin": "room.bin", beside it.
std::filesystem::path beside(const std::filesystem::path& file, const std::string& ending) {
  return file.parent_path() / fmt::format("{}.{}", file.stem().string(), ending);
}

std::filesystem::path layer_file(const std::filesystem::path& file, std::size_t layer) {
  return beside(file, fmt::format("light{:02}.exr", layer));
}

std::filesystem::path texture_file(const std::filesystem::path& file, std::uint32_t texture) {
  return beside(file, fmt::format("colour{:02}.png", texture));
}

/// The name of a file beside a glTF file as a URI, in which other bytes than these are escaped.
std::string uri_of(const std::filesystem::path& file) {
  constexpr std::string_view unreserved =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string uri;
  for (const char byte : file.filename().string()) {
    if (unreserved.find(byte) != std::string_view::npos) {
      uri += byte;
    } else {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(byte));
    }
  }
  return uri;
}

/// Textures of base colours, each once, ascending.
std::vector<std::uint32_t> textures_of(const Scene& scene) {
  std::vector<std::uint32_t> textures;
  for (const Material& material : scene.materials) {
    if (material.diffuse_texture != none) textures.push_back(material.diffuse_texture);
  }
  std::sort(textures.begin(), textures.end());
  textures.erase(std::unique(textures.begin(), textures.end()), textures.end());
  return textures;
}

/// Texels as they are.
std::vector<std::uint8_t> texels_of(const Texture& texture) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < texture.height(); ++y) {
    for (int x = 0; x < texture.width(); ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(texture.width()),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(texture.height()));
      const glm::vec4 texel = texture.sample_data(uv);
      for (int c = 0; c < 4; ++c) {
        bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0f * texel[c])));
      }
    }
  }
  return bytes;
}

void write_layer(const std::filesystem::path& file, const BakedLight& baked, std::size_t layer,
                 const LightMix& mix) {
  const std::vector<glm::vec3> texels = baked.layer(layer);
  const MixedLight& light = mix.lights[layer];
  const glm::vec3 scale(mix.power_in_picture(light) * glm::dvec3(light.tint));
  Image image;
  image.width = static_cast<int>(baked.width());
  image.height = static_cast<int>(baked.height());
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float>& plane = image.add(std::string(1, "RGB"[channel]));
    for (std::size_t i = 0; i < texels.size(); ++i) plane[i] = scale[channel] * texels[i][channel];
  }
  std::size_t lost = 0;
  for (const std::vector<float>& plane : image.channels) {
    lost += static_cast<std::size_t>(std::count_if(
        plane.begin(), plane.end(), [](float value) { return !std::isfinite(value); }));
  }
  if (lost > 0) {
    throw InputError(
        fmt::format("light '{}': {} of {} values of its texture are infinite or not numbers; "
                    "reduce its power",
                    light.name, lost, 3 * image.pixels()));
  }
  image.attributes["photile.light"] = light.name;
  write_exr(file, image);
}

bool is_binary(const std::filesystem::path& file) { return file.extension() == ".glb"; }

/// A glTF document under construction, with its buffer: two files, or one.
class Document {
 public:
  explicit Document(const std::filesystem::path& file) : file_(file), output_(file) {}

  /// Accessor of an array, which goes to the buffer.
  template <class Vector>
  std::size_t add(const std::vector<Vector>& values) {
    json& accessors = json_["accessors"];
    const std::size_t view = add_bytes(values.data(), values.size() * sizeof(Vector));
    Vector low = values.front(), high = low;
    for (const Vector& value : values) low = glm::min(low, value), high = glm::max(high, value);
    json accessor{{"bufferView", view},
                  {"componentType", gltf_float},
                  {"count", values.size()},
                  {"type", fmt::format("VEC{}", Vector::length())}};
    for (int i = 0; i < Vector::length(); ++i) {
      accessor["min"].push_back(low[i]);
      accessor["max"].push_back(high[i]);
    }
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  /// Adds a picture of base colours: a separate file, or a part of the buffer.
  ///   own   that file
  void add_picture(const std::filesystem::path& own, const Texture& texture) {
    const std::vector<std::uint8_t> texels = texels_of(texture);
    if (is_binary(file_)) {
      const auto png = image::png_bytes(output_, texture.width(), texture.height(), texels);
      json_["images"].push_back(
          {{"bufferView", add_bytes(png.data(), png.size())}, {"mimeType", "image/png"}});
    } else {
      OutputFile picture(own);
      image::encode_png(picture, texture.width(), texture.height(), texels);
      picture.commit();
      json_["images"].push_back({{"uri", uri_of(own)}});
    }
    json_["textures"].push_back({{"source", json_["images"].size() - 1}});
  }

  json& operator[](const char* key) { return json_[key]; }

  void write() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "photile"}};
    json_["buffers"] = {{{"byteLength", buffer_.size()}}};
    if (is_binary(file_)) {
      write_binary();
    } else {
      const std::filesystem::path buffer = beside(file_, "bin");
      json_["buffers"][0]["uri"] = uri_of(buffer);
      write_file(buffer, buffer_);
      const std::string text = json_text(json_);
      output_.write(text.data(), text.size());
    }
    output_.commit();
  }

 private:
  /// The number of the view of these bytes.
  std::size_t add_bytes(const void* bytes, std::size_t count) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4);  // numbers lie at multiples of their size
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", count}});
    buffer_.append(static_cast<const char*>(bytes), count);
    return json_["bufferViews"].size() - 1;
  }

  void write_binary() {
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    const std::string chunk = gltf::BinaryFile::buffer_head(buffer_.size());
    const std::string head =
        gltf::BinaryFile::head(json_text(json_), chunk.size() + buffer_.size());
    if (head.size() + chunk.size() + buffer_.size() > std::numeric_limits<std::uint32_t>::max()) {
      output_.fail("a .glb has at most 4 GiB; write a .gltf");
    }
    for (const std::string_view part :
         {std::string_view(head), std::string_view(chunk), std::string_view(buffer_)}) {
      output_.write(part.data(), part.size());
    }
  }

  const std::filesystem::path file_;
  OutputFile output_;
  json json_;
  std::string buffer_;
};

json material_of(const Scene& scene, const Material& material,
                 const std::map<std::uint32_t, std::size_t>& texture_number) {
  // Materials without a texture here become matt with the same total reflectance.
  glm::vec3 colour = material.diffuse + material.specular;
  if (material.metallic_roughness != none) {
    colour = glm::vec3(scene.metallic_roughness[material.metallic_roughness].base_color);
  }
  colour = glm::min(colour, glm::vec3(1.0f));
  json surface{{"baseColorFactor", {colour.r, colour.g, colour.b, 1.0}},
               {"metallicFactor", 0.0},
               {"roughnessFactor", 1.0}};
  if (material.diffuse_texture != none && !scene.corner_uv.empty()) {
    surface["baseColorTexture"] = {{"index", texture_number.at(material.diffuse_texture)}};
  }
  return {{"name", material.name}, {"pbrMetallicRoughness", surface}};
}

/// Baked sides of a material, each a separate triangle that faces the side from which it is
/// visible.
json primitive_of(const Scene& scene, const BakedLight& baked,
                  const std::vector<std::uint32_t>& sides, std::uint32_t material,
                  Document& document) {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> colours, lights;
  for (const std::uint32_t s : sides) {
    const std::uint32_t t = triangle_of(s);
    const auto corners = scene.corners(t);
    const auto light = baked.corners(s);
    for (const DrawnTriangle& triangle : baked.drawn(s)) {
      for (const glm::vec3& weights : triangle) {
        positions.push_back(at_weights(corners, weights));
        lights.push_back(at_weights(light, weights));
        if (!scene.corner_uv.empty()) colours.push_back(at_weights(scene.corner_uv[t], weights));
      }
    }
  }
  // A second set needs a first one.
  if (colours.empty()) colours.assign(positions.size(), glm::vec2(0.0f));
  json primitive{{"material", material}};
  primitive["attributes"] = {{"POSITION", document.add(positions)},
                             {"TEXCOORD_0", document.add(colours)},
                             {"TEXCOORD_1", document.add(lights)}};
  return primitive;
}

}  // namespace

std::vector<std::filesystem::path> files_of(const std::filesystem::path& file, const Scene& scene,
                                            const LightMix& mix) {
  std::vector<std::filesystem::path> files{file};
  for (std::size_t i = 0; i < mix.lights.size(); ++i) files.push_back(layer_file(file, i));
  if (is_binary(file)) return files;
  files.push_back(beside(file, "bin"));
  for (const std::uint32_t texture : textures_of(scene)) {
    files.push_back(texture_file(file, texture));
  }
  return files;
}

void write_baked(const std::filesystem::path& file, const Scene& scene, const BakedLight& baked,
                 const LightMix& mix) {
  Document document(file);
  std::map<std::uint32_t, std::size_t> texture_number;
  for (const std::uint32_t texture : textures_of(scene)) {
    document.add_picture(texture_file(file, texture), scene.textures[texture]);
    texture_number.emplace(texture, texture_number.size());
  }
  std::vector<std::vector<std::uint32_t>> sides(scene.materials.size());
  for (const std::uint32_t side : baked.sides()) {
    sides[scene.triangle_material[triangle_of(side)]].push_back(side);
  }
  json mesh;
  for (std::uint32_t m = 0; m < sides.size(); ++m) {
    document["materials"].push_back(material_of(scene, scene.materials[m], texture_number));
    if (sides[m].empty()) continue;
    mesh["primitives"].push_back(primitive_of(scene, baked, sides[m], m, document));
  }
  document["meshes"] = {mesh};
  document["nodes"] = {
      {{"mesh", 0}, {"translation", {scene.origin.x, scene.origin.y, scene.origin.z}}}};
  json layers;
  for (std::size_t i = 0; i < mix.lights.size(); ++i) {
    const MixedLight& light = mix.lights[i];
    write_layer(layer_file(file, i), baked, i, mix);
    layers.push_back({{"light", light.name},
                      {"uri", uri_of(layer_file(file, i))},
                      {"texCoord", 1},
                      {"power", light.power},
                      {"unit", symbol_of(light.unit)},
                      {"tint", {light.tint.r, light.tint.g, light.tint.b}}});
  }
  document["scenes"] = {
      {{"nodes", {0}},
       {"extras",
        {{"photile",
          {{"light_maps", layers},
           {"irradiance", mix.unit() == PowerUnit::lumen ? "lm/m2" : "W/m2"}}}}}}};
  document["scene"] = 0;
  document.write();
}

}  // namespace photile::bake
