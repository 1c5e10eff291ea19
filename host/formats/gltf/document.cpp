#include "gltf/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/foreign_text.hpp"
#include "files/scene_files.hpp"
#include "gltf/binary_file.hpp"
#include "photile/limits.hpp"

namespace photile::gltf {

namespace {

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
  return text.empty() ? "not a glTF file" : shortened(text, 2 * longest_quote);
}

}  // namespace

tinygltf::Model read_gltf(reading::ImportContext& context) {
  std::vector<unsigned char> bytes = context.folder.read_scene_file();
  const std::string_view whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const bool binary = BinaryFile::is(whole);
  const BinaryFile parts(whole);
  const std::string_view json = binary ? parts.json : whole;
  check_required_extensions(check_json(json, context), context);
  std::string changed = without_packed_parts(json);
  if (!changed.empty()) {
    if (binary) changed = BinaryFile::head(changed, parts.rest.size()).append(parts.rest);
    bytes.assign(changed.begin(), changed.end());
  }
  const auto size = static_cast<unsigned int>(bytes.size());
  // tinygltf 2.7 leaves the 8 bytes of the second chunk's header out of its length check.
  bytes.resize(bytes.size() + 8, 0);
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
  } catch (const nlohmann::json::exception&) {  // its text is meaningful to programmers only
    error = "a value has the wrong type";
  }
  if (!loaded) {
    throw context.error("malformed glTF: " + first_line(error) + "; export the file again");
  }
  if (!error.empty()) context.warnings.add("malformed glTF: " + first_line(error));
  warn_of_extensions(model, context);
  unpack_meshes(model, context);
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

const tinygltf::Value* light_of_extension(const tinygltf::Model& model,
                                          const std::string& extension, double number) {
  const tinygltf::Value* const defined = find_extension(model.extensions, extension);
  if (defined == nullptr || !defined->Has("lights")) return nullptr;
  const tinygltf::Value& lights = defined->Get("lights");
  const std::size_t count = lights.IsArray() ? lights.ArrayLen() : 0;
  const bool there = number >= 0.0 && number < static_cast<double>(count);
  return there ? &lights.Get(static_cast<int>(number)) : nullptr;
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

namespace {

/// Members that describe bytes, where tinygltf would read a value that is not a number as another
/// number.
constexpr std::array<std::string_view, 3> of_bytes{"accessors", "bufferViews", "buffers"};
/// Members of those that number parts of the file or constants of the format: 32 bits.
constexpr std::array<std::string_view, 3> numbers{"buffer", "bufferView", "componentType"};
/// Members of those that count bytes or elements: whole as JSON keeps numbers, 32 bits where an
/// accessor is sparse.
constexpr std::array<std::string_view, 4> sizes{"byteLength", "byteOffset", "byteStride", "count"};
/// Members anywhere that number parts of the file. tinygltf cuts them off at 32 bits; others that
/// are wrong refer to nothing, which has no effect.
constexpr std::array<std::string_view, 11> indices{"camera",   "index",  "indices", "input",
                                                   "material", "mesh",   "node",    "output",
                                                   "sampler",  "source", "skin"};
constexpr std::array<std::string_view, 3> lists{"children", "joints", "nodes"};

/// A member that decides on light, shape or view.
struct ValueMember {
  static constexpr int number = 0, boolean = -1;
  std::string_view owner, name;  ///< the owner: as its file's member or list is called
  int what;                      ///< or of how many numbers a list has to be
};
constexpr std::array values{
    ValueMember{"nodes", "matrix", 16},
    ValueMember{"nodes", "translation", 3},
    ValueMember{"nodes", "rotation", 4},
    ValueMember{"nodes", "scale", 3},
    ValueMember{"KHR_node_visibility", "visible", ValueMember::boolean},
    ValueMember{"perspective", "yfov", ValueMember::number},
    ValueMember{"perspective", "aspectRatio", ValueMember::number},
    ValueMember{"materials", "emissiveFactor", 3},
    ValueMember{"materials", "alphaCutoff", ValueMember::number},
    ValueMember{"materials", "doubleSided", ValueMember::boolean},
    ValueMember{"pbrMetallicRoughness", "baseColorFactor", 4},
    ValueMember{"pbrMetallicRoughness", "metallicFactor", ValueMember::number},
    ValueMember{"pbrMetallicRoughness", "roughnessFactor", ValueMember::number},
    ValueMember{"normalTexture", "scale", ValueMember::number},
    ValueMember{"lights", "color", 3},
    ValueMember{"lights", "intensity", ValueMember::number},
    ValueMember{"lights", "rotation", 4},
    ValueMember{"lights", "size", ValueMember::number},
    ValueMember{"rect", "aspect", ValueMember::number},
    ValueMember{"spot", "innerConeAngle", ValueMember::number},
    ValueMember{"spot", "outerConeAngle", ValueMember::number},
    ValueMember{"EXT_lights_ies", "multiplier", ValueMember::number},
    ValueMember{"EXT_lights_ies", "color", 3},
    ValueMember{"KHR_materials_emissive_strength", "emissiveStrength", ValueMember::number},
    ValueMember{"KHR_materials_ior", "ior", ValueMember::number},
    ValueMember{"KHR_materials_specular", "specularFactor", ValueMember::number},
    ValueMember{"KHR_materials_specular", "specularColorFactor", 3},
    ValueMember{"KHR_materials_transmission", "transmissionFactor", ValueMember::number},
    ValueMember{"KHR_materials_volume", "thicknessFactor", ValueMember::number},
    ValueMember{"KHR_materials_volume", "attenuationDistance", ValueMember::number},
    ValueMember{"KHR_materials_volume", "attenuationColor", 3},
    ValueMember{"KHR_texture_transform", "offset", 2},
    ValueMember{"KHR_texture_transform", "scale", 2},
    ValueMember{"KHR_texture_transform", "rotation", ValueMember::number},
};

constexpr std::int64_t most_int = std::numeric_limits<int>::max();
constexpr std::uint64_t most_exact = std::uint64_t{1} << std::numeric_limits<double>::digits;
constexpr std::uint64_t most_size = std::numeric_limits<std::uint64_t>::max();

template <std::size_t count>
bool is_one_of(const std::array<std::string_view, count>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Takes the parts of a JSON text in turn; false ends the reading, with `problem` set.
class JsonCheck {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  std::string problem;
  std::vector<std::string> required;  ///< extensions

  bool null() { return is_value("null") && value(!is_whole(), "null"); }
  bool boolean(bool) { return is_value("true or false") && value(!is_whole(), "true or false"); }
  bool number_integer(number_integer_t number) {
    if (!is_value(a_number)) return false;
    const bool fits = levels_.empty() || levels_.back().most == most_size || number >= -most_int;
    return value(fits && !is_whole(), number);
  }
  bool number_float(number_float_t number, const string_t&) {
    return is_value(a_number) && value(!is_whole(), number);
  }
  bool number_unsigned(number_unsigned_t number) {
    if (!is_value(a_number)) return false;
    return value(levels_.empty() || number <= levels_.back().most, number);
  }
  bool string(string_t& text) {
    const bool listed = levels_.size() == 2 && levels_.back().array;
    if (listed && levels_.front().key == "extensionsRequired") required.push_back(text);
    return is_value("a text") && value(!is_whole(), "a text");
  }
  bool binary(binary_t&) { return value(!is_whole(), "binary"); }

  bool start_object(std::size_t) { return enter(false); }
  bool start_array(std::size_t) { return enter(true); }
  bool end_object() { return leave(); }
  bool end_array() {
    const Level& level = levels_.back();
    if (level.requested && level.elements != static_cast<std::uint64_t>(level.requested->what)) {
      return is_value(fmt::format("a list of {} numbers", level.elements));
    }
    return leave();
  }
  bool key(string_t& name) {
    Level& level = levels_.back();
    level.key = name;
    level.requested = requested_of(level);
    if (!level.free) set_requested(level);
    return true;
  }

  bool parse_error(std::size_t place, const std::string&, const nlohmann::json::exception& error) {
    constexpr int number_overflow = 406;
    problem = fmt::format(
        "malformed glTF: at byte {} {}", place,
        error.id == number_overflow ? "a number is too large" : "the file is not valid JSON");
    return false;
  }

 private:
  static constexpr std::string_view a_number = "a number", a_list = "a list";

  /// An array or object that is open.
  struct Level {
    bool array, free;            ///< free: not of the format itself
    std::string key = {};        ///< of the member that comes, in an object
    std::uint64_t elements = 0;  ///< begun, in an array
    /// Whether the next value has to be a whole number, and its upper bound.
    bool whole = false;
    std::uint64_t most = most_size;
    /// The type that the next member needs; in an array, that of the array's member.
    const ValueMember* requested = nullptr;
    bool extras = false;  ///< or within some
  };

  const ValueMember* requested_of(const Level& level) const {
    if (level.extras || levels_.size() < 2) return nullptr;
    // In a list, the owner is called as the list.
    const bool listed = levels_[levels_.size() - 2].array && levels_.size() > 2;
    const std::string& owner = levels_[levels_.size() - (listed ? 3 : 2)].key;
    const auto* const found = std::find_if(values.begin(), values.end(), [&](const auto& each) {
      return each.name == level.key && each.owner == owner;
    });
    return found == values.end() ? nullptr : &*found;
  }

  /// Whether the next value, or the list that ends, is of the type that its member needs.
  bool is_value(std::string_view shown) {
    if (levels_.empty() || levels_.back().requested == nullptr) return true;
    const Level& level = levels_.back();
    const int what = level.requested->what;
    const bool is_number = shown == a_number;
    if (what == ValueMember::boolean ? shown == "true or false"
                                     : is_number && (level.array || what == ValueMember::number)) {
      return true;
    }
    if (!level.array && what > 0 && shown == a_list) return true;
    std::string path = place();
    if (level.array) path.erase(path.rfind('['));
    problem =
        fmt::format("malformed glTF: {} {} {}, not {}", path,
                    level.array && !shown.starts_with(a_list) ? "has" : "is", shown,
                    what == ValueMember::boolean  ? "true or false"
                    : what == ValueMember::number ? std::string(a_number)
                                                  : fmt::format("a list of {} numbers", what));
    return false;
  }

  /// The member of the n-th level from the innermost, which are objects.
  std::string_view member(std::size_t n) const {
    return n < levels_.size() ? std::string_view(levels_[levels_.size() - 1 - n].key) : "";
  }

  /// Whether the next value has to be a whole number.
  bool is_whole() const { return !levels_.empty() && levels_.back().whole; }

  void set_requested(Level& level) const {
    const bool bytes = is_one_of(of_bytes, levels_.front().key);
    const bool number = bytes && is_one_of(numbers, level.key);
    const bool size = bytes && is_one_of(sizes, level.key);
    const bool sparse = member(1) == "sparse" || member(2) == "sparse";
    level.whole = number || size;
    const bool index = is_one_of(indices, level.key) || member(1) == "attributes";
    level.most = number || (size && sparse) || index ? most_int : size ? most_exact : most_size;
  }

  void begin_value() {
    if (!levels_.empty()) ++levels_.back().elements;
  }

  /// The type that the format requires, for messages.
  template <class Shown>
  bool value(bool is_sound, const Shown& shown) {
    begin_value();
    if (is_sound) return true;
    problem = fmt::format("malformed glTF: {} is {}, not a whole number from 0 to {}", place(),
                          shown, levels_.back().most);
    return false;
  }

  /// "bufferViews[0].byteOffset". Their names are plain where a number is requested.
  std::string place() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.array) {
        text += fmt::format("[{}]", level.elements - 1);
      } else {
        text += (text.empty() ? "" : ".") + level.key;
      }
    }
    return text;
  }

  bool enter(bool array) {
    if (!is_value(array ? a_list : "an object")) return false;
    if (is_whole()) return value(false, array ? a_list : "an object");
    begin_value();
    if (levels_.size() == 2 && !check_count()) return false;
    Level level{.array = array, .free = false};
    if (!levels_.empty()) {
      const Level& around = levels_.back();
      const bool foreign = !around.array && (around.key == "extras" || around.key == "extensions");
      level.free = around.free || foreign;
      level.extras = around.extras || (!around.array && around.key == "extras");
      if (array && !around.array) level.requested = around.requested;
      const bool list = array && !level.free && !around.array && is_one_of(lists, around.key);
      if (list) level.most = most_int;
    }
    levels_.push_back(level);
    if (levels_.size() <= static_cast<std::size_t>(limits::max_json_depth)) return true;
    problem = fmt::format("the JSON is nested more than {} levels deep; export the file again",
                          limits::max_json_depth);
    return false;
  }

  bool leave() {
    levels_.pop_back();
    return true;
  }

  /// Checks the number of elements of an array of the outermost object.
  bool check_count() {
    const std::string& array = levels_.front().key;
    const std::uint64_t most = array == "nodes"       ? limits::max_nodes
                               : array == "materials" ? limits::max_materials - 1
                                                      : most_size;
    if (levels_.back().elements <= most) return true;
    problem = fmt::format("the file has more than {} {}, which is the limit; split the scene", most,
                          array);
    return false;
  }

  std::vector<Level> levels_;
};

}  // namespace

std::vector<std::string> check_json(std::string_view json, const reading::ImportContext& context) {
  JsonCheck check;
  if (nlohmann::json::sax_parse(json, &check)) return std::move(check.required);
  const bool malformed = check.problem.starts_with("malformed");
  throw context.error(check.problem + (malformed ? "; export the file again" : ""));
}

}  // namespace photile::gltf
