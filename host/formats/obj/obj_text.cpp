#include "obj/obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

}  // namespace photile::obj
