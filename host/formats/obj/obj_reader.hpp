// An OBJ file as its statements say it, read by tinyobjloader's callback interface, which keeps
// polygons of any size and tells bad indices from good ones.
#pragma once

#include <tiny_obj_loader.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "reading/import_context.hpp"

namespace photile::obj {

struct ObjFace {
  std::uint64_t first_corner;
  std::uint32_t corner_count;
  std::uint32_t object;    ///< index in ObjFile::objects
  std::uint32_t material;  ///< index in ObjFile::materials, or `none` before any usemtl
};

struct ObjFile {
  std::vector<glm::dvec3> positions, normals;
  std::vector<glm::dvec2> texcoords;      ///< as in the file: (0,0) is the lower left corner
  std::vector<tinyobj::index_t> corners;  ///< from 0; -1 = not given or out of range
  std::vector<ObjFace> faces;
  std::vector<std::string> objects;         ///< names of objects and groups; "" before the first
  std::vector<std::string> material_names;  ///< as usemtl names them
};

/// Reads `text`, without the material libraries that it names (obj_text.hpp). Errors:
/// InputError naming the face with an impossible vertex index.
ObjFile read_obj(std::string& text, reading::ImportContext& context);

}  // namespace photile::obj
