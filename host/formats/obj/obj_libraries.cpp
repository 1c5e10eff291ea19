#include "obj/obj_libraries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "common/ascii_text.hpp"
#include "files/warnings.hpp"

namespace photile::obj {
namespace {

/// As written on Windows or elsewhere.
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

void read_library(const std::string& name, std::vector<tinyobj::material_t>& materials,
                  reading::ImportContext& context) {
  const std::vector<unsigned char> bytes = context.folder.read(name);
  std::string text(bytes.begin(), bytes.end());
  if (text.find('\0') != std::string::npos) {
    throw files::ResourceError("'" + name + "': NUL bytes: this is no plain text (UTF-16?)");
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a byte-order mark
  std::istringstream stream(std::move(text));
  std::map<std::string, int> index;
  std::string warning, error;
  tinyobj::LoadMtl(&index, &materials, &stream, &warning, &error);
  std::istringstream lines(warning + error);
  for (std::string line; std::getline(lines, line);) {
    if (!trimmed(line).empty()) {
      context.warnings.add(fmt::format("{}: {}", name, trimmed(line)));
    }
  }
}

}  // namespace

std::vector<tinyobj::material_t> read_obj_libraries(const std::vector<std::string>& statements,
                                                    reading::ImportContext& context) {
  std::vector<tinyobj::material_t> materials;
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
  for (tinyobj::material_t& material : materials) {
    material.name = std::string(trimmed(material.name));
  }
  return materials;
}

}  // namespace photile::obj
