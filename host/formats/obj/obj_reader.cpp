#include "obj/obj_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <istream>
#include <set>
#include <streambuf>
#include <utility>

#include "common/ascii_text.hpp"
#include "files/scene_files.hpp"
#include "photile/limits.hpp"

namespace photile::obj {

namespace {

/// A stream over bytes that stay where they are.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
};

/// Collects what the callbacks report.
class Collector {
 public:
  Collector(reading::ImportContext& context, ObjFile& file) : context_(context), file_(file) {
    file_.objects.emplace_back();
  }

  void add_position(const glm::dvec3& position) {
    context_.check_cancelled();
    file_.positions.push_back(position);
  }

  void add_face(const tinyobj::index_t* indices, int count) {
    context_.check_cancelled();
    if (count < 3) {
      context_.warnings.add("object", object_name(), "faces with fewer than 3 corners are ignored");
      return;
    }
    if (static_cast<std::uint64_t>(count) > limits::max_polygon_corners) {
      throw context_.error(fmt::format("face {} has {} corners; the limit is {}; split it",
                                       file_.faces.size() + 1, count, limits::max_polygon_corners));
    }
    file_.faces.push_back(
        {file_.corners.size(), static_cast<std::uint32_t>(count), object_, material_});
    for (int i = 0; i < count; ++i) {
      file_.corners.push_back({from_zero(indices[i].vertex_index, file_.positions.size()),
                               from_zero(indices[i].normal_index, file_.normals.size()),
                               from_zero(indices[i].texcoord_index, file_.texcoords.size())});
    }
  }

  void use_material(const std::string& name) {
    material_ = find_or_add(std::string(trimmed(name)), file_.material_names, material_index_);
  }

  void begin_object(const std::string& name) {
    object_ = find_or_add(std::string(trimmed(name)), file_.objects, object_index_);
  }

 private:
  /// OBJ counts from 1, and negative indices from the last element read so far.
  static int from_zero(int index, std::size_t count) {
    if (index > 0) return index - 1;
    if (index == 0) return -1;
    const std::int64_t absolute = static_cast<std::int64_t>(count) + index;
    return absolute < 0 ? -1 : static_cast<int>(absolute);
  }

  static std::uint32_t find_or_add(const std::string& name, std::vector<std::string>& names,
                                   std::map<std::string, std::uint32_t>& index) {
    const auto [entry, inserted] =
        index.try_emplace(name, static_cast<std::uint32_t>(names.size()));
    if (inserted) names.push_back(name);
    return entry->second;
  }

  const std::string& object_name() const { return file_.objects[object_]; }

  reading::ImportContext& context_;
  ObjFile& file_;
  std::uint32_t object_ = 0, material_ = none;
  std::map<std::string, std::uint32_t> object_index_{{"", 0}}, material_index_;
};

struct CallbackData {
  Collector collector;
  ObjFile& file;
};

tinyobj::callback_t callbacks() {
  tinyobj::callback_t result;
  using tinyobj::real_t;
  result.vertex_cb = [](void* p, real_t x, real_t y, real_t z, real_t) {
    static_cast<CallbackData*>(p)->collector.add_position({x, y, z});
  };
  result.normal_cb = [](void* p, real_t x, real_t y, real_t z) {
    static_cast<CallbackData*>(p)->file.normals.emplace_back(x, y, z);
  };
  result.texcoord_cb = [](void* p, real_t u, real_t v, real_t) {
    static_cast<CallbackData*>(p)->file.texcoords.emplace_back(u, v);
  };
  result.index_cb = [](void* p, tinyobj::index_t* indices, int count) {
    static_cast<CallbackData*>(p)->collector.add_face(indices, count);
  };
  result.usemtl_cb = [](void* p, const char* name, int) {
    static_cast<CallbackData*>(p)->collector.use_material(name);
  };
  result.group_cb = [](void* p, const char** names, int count) {
    static_cast<CallbackData*>(p)->collector.begin_object(count > 0 ? names[0] : "");
  };
  result.object_cb = [](void* p, const char* name) {
    static_cast<CallbackData*>(p)->collector.begin_object(name);
  };
  return result;
}

/// Positive vertex indices may point ahead, so they are checked when all vertices are known.
void check_corners(ObjFile& file, reading::ImportContext& context) {
  std::uint64_t bad_normals = 0, bad_texcoords = 0;
  for (std::size_t f = 0; f < file.faces.size(); ++f) {
    const ObjFace& face = file.faces[f];
    for (std::uint64_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      tinyobj::index_t& corner = file.corners[c];
      const auto beyond = [](int index, std::size_t count) {
        return index >= 0 && static_cast<std::size_t>(index) >= count;
      };
      if (corner.vertex_index < 0 || beyond(corner.vertex_index, file.positions.size())) {
        throw context.error(
            fmt::format("face {} (object '{}') has a corner without a valid vertex index; the file "
                        "has {} vertices; repair the file or export it again",
                        f + 1, file.objects[face.object], file.positions.size()));
      }
      if (beyond(corner.normal_index, file.normals.size())) {
        corner.normal_index = -1;
        ++bad_normals;
      }
      if (beyond(corner.texcoord_index, file.texcoords.size())) {
        corner.texcoord_index = -1;
        ++bad_texcoords;
      }
    }
  }
  if (bad_normals + bad_texcoords > 0) {
    context.warnings.add(fmt::format("{} normal and {} texture indices out of range are ignored",
                                     bad_normals, bad_texcoords));
  }
}

}  // namespace

ObjFile read_obj(std::string& text, reading::ImportContext& context) {
  ObjFile file;
  CallbackData data{Collector(context, file), file};
  MemoryBuffer buffer(text);
  std::istream stream(&buffer);
  // tinyobjloader's own warnings only repeat, less precisely, what the reader and the collector
  // say.
  tinyobj::LoadObjWithCallback(stream, callbacks(), &data, nullptr, nullptr, nullptr);
  check_corners(file, context);
  return file;
}

namespace {

constexpr std::string_view blanks = " \t\r";

}  // namespace

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

void join_continued_lines(std::string& text) {
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
    std::size_t end = at + 1;
    if (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') std::fill(&text[at], &text[end] + 1, ' ');
  }
}

namespace {

bool starts_a_number(std::string_view word) {
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
  if (!word.empty() && word[0] == '.') word.remove_prefix(1);
  return !word.empty() && word[0] >= '0' && word[0] <= '9';
}

void examine_vertex(std::string_view rest, std::uint64_t vertex, ObjTextFindings& findings) {
  int numbers = 0;
  bool readable = true;
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
    readable &= numbers >= 3 || starts_a_number(word);
    ++numbers;
  }
  if (!readable || numbers < 3) findings.unreadable_vertices.insert(vertex);
  findings.vertex_colors |= numbers >= 6;
}

}  // namespace

ObjTextFindings examine_obj_text(std::string& text, reading::ImportContext& context) {
  if (text.find('\0') != std::string::npos) {
    throw files::ResourceError(
        "it contains NUL bytes and is not plain text (UTF-16?); save it as UTF-8");
  }
  join_continued_lines(text);
  constexpr std::array<std::string_view, 7> understood{"vn", "vt", "f", "o", "g", "usemtl", "s"};
  ObjTextFindings findings;
  std::uint64_t vertices = 0;
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) std::fill(text.begin(), text.begin() + 3, ' ');
  while (!rest.empty()) {
    context.check_cancelled();
    std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::string_view keyword = take_word(line);
    if (keyword == "v") {
      examine_vertex(line, vertices++, findings);
    } else if (keyword == "mtllib") {
      findings.libraries.emplace_back(trimmed(line));
    } else if (!keyword.empty() && keyword[0] != '#' &&
               std::find(understood.begin(), understood.end(), keyword) == understood.end()) {
      ++findings.ignored_statements[std::string(keyword.substr(0, 20))];
    }
  }
  return findings;
}

namespace {

/// A file's name as written on Windows or elsewhere, with slashes.
std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

/// The names between blanks; a backslash keeps the blank after it.
std::vector<std::string> names_between_blanks(const std::string& statement) {
  std::vector<std::string> names(1);
  for (std::size_t i = 0; i < statement.size(); ++i) {
    const bool kept = statement[i] == '\\' && i + 1 < statement.size() && statement[i + 1] == ' ';
    if (kept) {
      names.back() += statement[++i];
    } else if (statement[i] != ' ' && statement[i] != '\t') {
      names.back() += statement[i];
    } else if (!names.back().empty()) {
      names.emplace_back();
    }
  }
  if (names.back().empty()) names.pop_back();
  for (std::string& name : names) name = with_slashes(name);
  return names;
}

std::vector<std::string> names_in(const std::string& statement, const files::SceneFolder& folder) {
  std::string whole = with_slashes(statement);
  if (folder.holds(whole)) return {std::move(whole)};
  return names_between_blanks(statement);
}

void read_library(const std::string& name, std::vector<MtlMaterial>& materials,
                  reading::ImportContext& context) {
  const std::vector<unsigned char> bytes = context.folder.read(name);
  std::string text(bytes.begin(), bytes.end());
  if (text.find('\0') != std::string::npos) {
    throw files::ResourceError("'" + name + "' contains NUL bytes and is not plain text (UTF-16?)");
  }
  for (MtlMaterial& material : read_mtl(name, std::move(text), context)) {
    materials.push_back(std::move(material));
  }
}

}  // namespace

std::vector<MtlMaterial> read_obj_libraries(const std::vector<std::string>& statements,
                                            reading::ImportContext& context) {
  std::vector<MtlMaterial> materials;
  std::set<std::string> known;
  for (const std::string& statement : statements) {
    for (const std::string& name : names_in(statement, context.folder)) {
      if (!known.insert(name).second) continue;
      try {
        read_library(name, materials, context);
      } catch (const files::ResourceError& error) {
        context.warnings.add(
            fmt::format("material library {}; its materials become mid grey (0.5)", error.what()));
      }
    }
  }
  return materials;
}

}  // namespace photile::obj
