#include "obj/obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "common/ascii_text.hpp"
#include "files/warnings.hpp"

namespace photile::obj {

namespace {

constexpr std::string_view blanks = " \t\r";

/// Cuts the first word off `line`.
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

ObjTextFindings examine_obj_text(std::string& text) {
  if (text.find('\0') != std::string::npos) {
    throw files::ResourceError("NUL bytes: this is no plain text (UTF-16?); save it as UTF-8");
  }
  join_continued_lines(text);
  constexpr std::array<std::string_view, 7> understood{"vn", "vt", "f", "o", "g", "usemtl", "s"};
  ObjTextFindings findings;
  std::uint64_t vertices = 0;
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) std::fill(text.begin(), text.begin() + 3, ' ');
  while (!rest.empty()) {
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
