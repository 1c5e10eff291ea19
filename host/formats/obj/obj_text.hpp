// What tinyobjloader passes over in silence, found by a look at the first word of each line.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_set>
#include <vector>

namespace photile::obj {

struct ObjTextFindings {
  /// Vertices (counted from 0) with a coordinate that is no finite number: "nan", "inf", a word.
  /// tinyobjloader reads those as 0.
  std::unordered_set<std::uint64_t> unreadable_vertices;
  std::map<std::string, std::uint64_t> ignored_statements;  ///< keyword -> lines
  bool vertex_colors = false;
  std::vector<std::string> libraries;  ///< what follows each mtllib
};

/// Looks through OBJ text. Lines that end in a backslash are joined with the next in place, which
/// the OBJ format asks for and tinyobjloader does not do. Errors: ResourceError when the bytes are
/// no text.
ObjTextFindings examine_obj_text(std::string& text);

}  // namespace photile::obj
