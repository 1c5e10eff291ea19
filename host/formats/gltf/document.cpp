#include "gltf/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  } catch (const nlohmann::json::exception&) {  // its text means something to programmers alone
    error = "a value of another type than the format has";
  }
  if (!loaded) {
    throw context.error("malformed glTF: " + first_line(error) + "; export it again");
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

/// Where bytes are described: what is no number there would be read as another one.
constexpr std::array<std::string_view, 3> of_bytes{"accessors", "bufferViews", "buffers"};
/// Members of those that number parts of the file or constants of the format: 32 bits.
constexpr std::array<std::string_view, 3> numbers{"buffer", "bufferView", "componentType"};
/// Members of those that count bytes or elements: whole as JSON keeps numbers, 32 bits where an
/// accessor is sparse.
constexpr std::array<std::string_view, 4> sizes{"byteLength", "byteOffset", "byteStride", "count"};
/// Members anywhere that number parts of the file. tinygltf cuts them off at 32 bits; others that
/// are wrong name nothing, and nothing may ask for it.
constexpr std::array<std::string_view, 11> indices{"camera",   "index",  "indices", "input",
                                                   "material", "mesh",   "node",    "output",
                                                   "sampler",  "source", "skin"};
constexpr std::array<std::string_view, 3> lists{"children", "joints", "nodes"};

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

  bool null() { return value(!is_whole(), "null"); }
  bool boolean(bool) { return value(!is_whole(), "true or false"); }
  bool number_integer(number_integer_t number) {
    const bool fits = levels_.empty() || levels_.back().most == most_size || number >= -most_int;
    return value(fits && !is_whole(), number);
  }
  bool number_float(number_float_t number, const string_t&) { return value(!is_whole(), number); }
  bool number_unsigned(number_unsigned_t number) {
    return value(levels_.empty() || number <= levels_.back().most, number);
  }
  bool string(string_t& text) {
    const bool listed = levels_.size() == 2 && levels_.back().array;
    if (listed && levels_.front().key == "extensionsRequired") required.push_back(text);
    return value(!is_whole(), "a text");
  }
  bool binary(binary_t&) { return value(!is_whole(), "binary"); }

  bool start_object(std::size_t) { return enter(false); }
  bool start_array(std::size_t) { return enter(true); }
  bool end_object() { return leave(); }
  bool end_array() { return leave(); }
  bool key(string_t& name) {
    Level& level = levels_.back();
    level.key = name;
    if (!level.free) set_requested(level);
    return true;
  }

  bool parse_error(std::size_t place, const std::string&, const nlohmann::json::exception& error) {
    constexpr int number_overflow = 406;
    problem = fmt::format("malformed glTF: what ends at byte {} is {}", place,
                          error.id == number_overflow ? "too large a number" : "no JSON");
    return false;
  }

 private:
  /// An array or object that is open.
  struct Level {
    bool array, free;            ///< free: not of the format itself
    std::string key = {};        ///< of the member that comes, in an object
    std::uint64_t elements = 0;  ///< begun, in an array
    /// Whether what comes is a whole number, and up to which.
    bool whole = false;
    std::uint64_t most = most_size;
  };

  /// The member of the n-th level from the innermost, which are objects.
  std::string_view member(std::size_t n) const {
    return n < levels_.size() ? std::string_view(levels_[levels_.size() - 1 - n].key) : "";
  }

  /// Whether what comes has to be a whole number.
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

  /// Shown where it is not what the format has there.
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
    if (is_whole()) return value(false, array ? "a list" : "an object");
    begin_value();
    if (levels_.size() == 2 && !check_count()) return false;
    Level level{.array = array, .free = false};
    if (!levels_.empty()) {
      const Level& around = levels_.back();
      const bool foreign = !around.array && (around.key == "extras" || around.key == "extensions");
      level.free = around.free || foreign;
      const bool list = array && !level.free && !around.array && is_one_of(lists, around.key);
      if (list) level.most = most_int;
    }
    levels_.push_back(level);
    if (levels_.size() <= static_cast<std::size_t>(limits::max_json_depth)) return true;
    problem = fmt::format("JSON nested more than {} levels deep; export it again",
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
    problem = fmt::format("more than {} {}, which is the limit; split the scene", most, array);
    return false;
  }

  std::vector<Level> levels_;
};

}  // namespace

std::vector<std::string> check_json(std::string_view json, const reading::ImportContext& context) {
  JsonCheck check;
  if (nlohmann::json::sax_parse(json, &check)) return std::move(check.required);
  const bool malformed = check.problem.starts_with("malformed");
  throw context.error(check.problem + (malformed ? "; export it again" : ""));
}

}  // namespace photile::gltf
