#include "gltf/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "files/warnings.hpp"
#include "gltf/json_check.hpp"

namespace photile::gltf {
namespace {

/// The JSON text of a file: all of a .gltf, the first chunk of a .glb.
std::string_view json_text(std::span<const unsigned char> bytes, bool binary) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::size_t binary_header = 20;  // file header and the header of the first chunk
  if (!binary) return text;
  if (text.size() <= binary_header) return {};
  const std::size_t length =
      bytes[12] | bytes[13] << 8 | bytes[14] << 16 | static_cast<std::size_t>(bytes[15]) << 24;
  return text.substr(binary_header, length);
}

/// tinygltf asks for a file under several folders; SceneFolder alone decides what is read.
tinygltf::FsCallbacks file_callbacks(files::SceneFolder& folder) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string&, void*) { return true; };
  callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error,
                               const std::string& path, void* user) {
    try {
      *bytes = static_cast<files::SceneFolder*>(user)->read(path);
      return true;
    } catch (const files::ResourceError& refusal) {
      *error = refusal.what();
      return false;
    }
  };
  callbacks.WriteWholeFile = nullptr;
  callbacks.user_data = &folder;
  return callbacks;
}

/// Keeps a picture of a data: URI encoded. Pictures in a buffer view come without their bounds
/// checked; they are read later, by way of the checked view.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  image->as_is = true;
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

std::string first_line(std::string text) {
  text.erase(std::find(text.begin(), text.end(), '\n'), text.end());
  return text.empty() ? "not a glTF file" : text;
}

}  // namespace

tinygltf::Model read_gltf(reading::ImportContext& context) {
  std::vector<unsigned char> bytes = context.folder.read_scene_file();
  const std::string_view magic(reinterpret_cast<const char*>(bytes.data()),
                               std::min<std::size_t>(bytes.size(), 4));
  const bool binary = magic == "glTF";
  const auto size = static_cast<unsigned int>(bytes.size());
  // tinygltf 2.7 leaves the 8 bytes of the second chunk's header out of its length check.
  bytes.resize(bytes.size() + 8, 0);
  const std::string_view json = json_text(std::span(bytes).first(size), binary);
  check_json(json, context);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(file_callbacks(context.folder));
  loader.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  bool loaded = false;
  try {
    loaded =
        binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, "")
               : loader.LoadASCIIFromString(&model, &error, &warning,
                                            reinterpret_cast<const char*>(bytes.data()), size, "");
  } catch (const nlohmann::json::exception&) {  // its text means something to programmers alone
    error = "a value of another type than the format has";
  }
  if (!loaded) {
    check_required_extensions(json, context);
    throw context.error("malformed glTF: " + first_line(error) + "; export it again");
  }
  if (!error.empty()) context.warnings.add("malformed glTF: " + first_line(error));
  check_extensions(model, context);
  return model;
}

double number_member(const tinygltf::Value& object, const std::string& key, double fallback) {
  if (!object.Has(key) || !object.Get(key).IsNumber()) return fallback;
  const double value = object.Get(key).GetNumberAsDouble();
  return std::isfinite(value) ? value : fallback;
}

int integer_member(const tinygltf::Value& object, const std::string& key, int fallback) {
  constexpr double smallest = std::numeric_limits<int>::min(),
                   largest = std::numeric_limits<int>::max();
  return static_cast<int>(std::clamp(number_member(object, key, fallback), smallest, largest));
}

std::string string_member(const tinygltf::Value& object, const std::string& key) {
  if (!object.Has(key) || !object.Get(key).IsString()) return {};
  return object.Get(key).Get<std::string>();
}

glm::dvec3 vector_member(const tinygltf::Value& object, const std::string& key,
                         const glm::dvec3& fallback) {
  glm::dvec3 result = fallback;
  if (!object.Has(key) || !object.Get(key).IsArray()) return result;
  const tinygltf::Value& array = object.Get(key);
  for (int i = 0; i < 3 && static_cast<std::size_t>(i) < array.ArrayLen(); ++i) {
    const tinygltf::Value& element = array.Get(i);
    if (element.IsNumber() && std::isfinite(element.GetNumberAsDouble())) {
      result[i] = element.GetNumberAsDouble();
    }
  }
  return result;
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

glm::dvec3 rgb_of(const std::vector<double>& values, const glm::dvec3& fallback) {
  if (values.size() < 3) return fallback;
  const glm::dvec3 rgb(values[0], values[1], values[2]);
  return std::isfinite(rgb.r + rgb.g + rgb.b) ? rgb : fallback;
}

std::string decoded_uri(const std::string& uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned int byte = 0;
    const char* digits = uri.data() + i + 1;
    const bool escape = uri[i] == '%' && i + 2 < uri.size() &&
                        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    decoded += escape ? static_cast<char>(byte) : uri[i];
    if (escape) i += 2;
  }
  return decoded;
}

}  // namespace photile::gltf
