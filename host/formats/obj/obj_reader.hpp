// An OBJ file as its statements say it, read by tinyobjloader's callback interface, which keeps
// polygons of any size and distinguishes invalid indices.
#pragma once

#include <tiny_obj_loader.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "obj/mtl_reader.hpp"
#include "reading/import_context.hpp"

namespace photile::obj {

struct ObjFace {
  std::uint64_t first_corner;
  std::uint32_t corner_count;
  std::uint32_t object;    ///< index in ObjFile::objects
  std::uint32_t material;  ///< index in ObjFile::material_names, or `none` before any usemtl
};

struct ObjFile {
  std::vector<glm::dvec3> positions, normals;
  std::vector<glm::dvec2> texcoords;      ///< as in the file: (0,0) is the lower left corner
  std::vector<tinyobj::index_t> corners;  ///< from 0; -1 = not given or out of range
  std::vector<ObjFace> faces;
  std::vector<std::string> objects;         ///< names of objects and groups; "" before the first
  std::vector<std::string> material_names;  ///< as usemtl names them
};

/// Reads `text`, without the material libraries that it names (read_obj_libraries). Errors:
/// InputError naming the face with an impossible vertex index.
ObjFile read_obj(std::string& text, reading::ImportContext& context);

// What tinyobjloader ignores silently: lines by their first words, and material libraries.

struct ObjTextFindings {
  /// Vertices (counted from 0) with a coordinate that is no finite number: "nan", "inf", a word.
  /// tinyobjloader reads those as 0.
  std::unordered_set<std::uint64_t> unreadable_vertices;
  std::map<std::string, std::uint64_t> ignored_statements;  ///< keyword -> lines
  bool vertex_colors = false;
  std::vector<std::string> libraries;  ///< what follows each mtllib
};

/// Cuts the first word off a line; "" where there is none.
std::string_view take_word(std::string_view& line);

/// Joins lines that end in a backslash with the next, in place.
void join_continued_lines(std::string& text);

/// Looks through OBJ text. Lines that end in a backslash are joined with the next in place, which
/// the OBJ format asks for and tinyobjloader does not do. Errors: ResourceError when the bytes are
/// no text; Interrupted.
ObjTextFindings examine_obj_text(std::string& text, reading::ImportContext& context);

/// The materials of the libraries that mtllib statements name, from the scene's folder, in their
/// order. A statement may name several files. Names with blanks are written with backslashes before
/// them or, by most exporters, without: the file that the whole statement names comes first.
///   statements   what follows each `mtllib`
/// Libraries that cannot be read are named in a warning. Errors: those of read_mtl.
std::vector<MtlMaterial> read_obj_libraries(const std::vector<std::string>& statements,
                                            reading::ImportContext& context);

/// Fills the context's scene from its OBJ file. Errors: InputError.
void import_obj(reading::ImportContext& context);

}  // namespace photile::obj
