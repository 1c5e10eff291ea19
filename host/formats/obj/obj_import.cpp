#include "obj/obj_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "files/warnings.hpp"
#include "obj/mtl_materials.hpp"
#include "obj/obj_reader.hpp"
#include "obj/obj_text.hpp"
#include "photile/limits.hpp"
#include "reading/plain_material.hpp"
#include "reading/polygon_triangulator.hpp"
#include "reading/scene_origin.hpp"
#include "scene/coordinate_limit.hpp"
#include "scene/mesh_builder.hpp"
#include "scene/surface_models.hpp"

namespace photile::obj {
namespace {

void report_findings(const ObjTextFindings& findings, files::Warnings& warnings) {
  if (findings.vertex_colors) warnings.add("vertex colours are ignored");
  for (const auto& [keyword, lines] : findings.ignored_statements) {
    warnings.add("statement", keyword, "not a surface or not understood; ignored");
  }
}

/// Adds the materials that faces use. Returns the scene's material of each usemtl name, and one
/// more for faces without any.
std::vector<std::uint32_t> add_materials(const ObjFile& file,
                                         const std::vector<tinyobj::material_t>& defined,
                                         reading::ImportContext& context) {
  if (file.material_names.size() + 1 > limits::max_materials) {
    throw context.error(fmt::format("more than {} materials", limits::max_materials));
  }
  std::map<std::string, const tinyobj::material_t*> library;
  for (const tinyobj::material_t& material : defined) {
    library.emplace(material.name, &material);
  }
  pictures::TextureStore textures(context.scene, context.folder);
  std::vector<std::uint32_t> index;
  for (const std::string& name : file.material_names) {
    index.push_back(static_cast<std::uint32_t>(context.scene.materials.size()));
    if (const auto found = library.find(name); found != library.end()) {
      add_mtl_material(*found->second, textures, context);
    } else {
      context.warnings.add("material", name, "not defined in any material library; mid grey (0.5)");
      add_missing_material(name, context);
    }
  }
  const bool some_without = std::any_of(file.faces.begin(), file.faces.end(),
                                        [](const ObjFace& face) { return face.material == none; });
  index.push_back(static_cast<std::uint32_t>(context.scene.materials.size()));
  if (some_without) {
    context.warnings.add("faces without usemtl become mid grey (0.5)");
    add_missing_material("default", context);
  }
  return index;
}

scene::Corner corner_of(const ObjFile& file, const tinyobj::index_t& index) {
  scene::Corner corner;
  corner.position = file.positions[static_cast<std::size_t>(index.vertex_index)];
  if (index.normal_index >= 0) {
    corner.normal = file.normals[static_cast<std::size_t>(index.normal_index)];
  }
  if (index.texcoord_index >= 0) {
    const glm::dvec2 uv = file.texcoords[static_cast<std::size_t>(index.texcoord_index)];
    corner.uv = {uv.x, 1.0 - uv.y};  // OBJ puts (0,0) at the lower left corner
    corner.emission_uv = corner.uv;
  }
  return corner;
}

void add_face(const ObjFile& file, const ObjFace& face, std::uint32_t material,
              scene::MeshBuilder& builder, reading::PlainMaterials& plain_materials,
              reading::ImportContext& context) {
  std::vector<scene::Corner> corners;
  std::vector<glm::dvec3> positions;
  bool has_coordinates = true;
  for (std::uint64_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
    corners.push_back(corner_of(file, file.corners[c]));
    positions.push_back(corners.back().position);
    has_coordinates &= file.corners[c].texcoord_index >= 0;
  }
  reading::Emission emission = context.emission[material];
  const Material& wanted = context.scene.materials[material];
  const bool is_plain = !has_coordinates && wanted.textured();
  if (is_plain || (!has_coordinates && emission.texture != none)) {
    context.warnings.add("material", wanted.name,
                         "faces without texture coordinates have its factors, and mid grey (0.5) "
                         "in place of map_Kd");
    emission.texture = none;
  }
  const std::uint32_t light =
      context.area_lights.find_or_add(face.object, file.objects[face.object], material, emission);
  if (is_plain) material = plain_materials.of(material);
  if (corners.size() == 3) {
    builder.add({corners[0], corners[1], corners[2]}, material, light);
    return;
  }
  ++context.scene.report.polygons_triangulated;
  if (!std::all_of(positions.begin(), positions.end(), scene::within_limit)) {
    // No plane to triangulate in: the whole polygon is lost, as many triangles as it would give.
    context.scene.report.non_finite_triangles += corners.size() - 2;
    return;
  }
  const reading::Triangulation triangulation = reading::triangulate_polygon(positions);
  if (!triangulation.simple) {
    context.warnings.add("object", file.objects[face.object],
                         "a polygon crosses itself; its triangulation may overlap or leave gaps");
  }
  for (const auto& [a, b, c] : triangulation.triangles) {
    builder.add({corners[a], corners[b], corners[c]}, material, light);
  }
}

void turn(ObjFile& file, const glm::dmat3& turn) {
  if (turn == glm::dmat3(1.0)) return;
  for (auto* vectors : {&file.positions, &file.normals}) {
    for (glm::dvec3& vector : *vectors) vector = turn * vector;
  }
}

/// Chooses Scene::origin (scene_origin.hpp) and counts all positions from there.
void move_to_origin(ObjFile& file, Scene& scene) {
  reading::SceneOrigin origin;
  const auto position = [&](std::uint64_t corner) {
    return file.positions[static_cast<std::size_t>(file.corners[corner].vertex_index)];
  };
  for (const ObjFace& face : file.faces) {
    // A fan stands for the polygon's triangles: their sizes are all that counts.
    for (std::uint32_t c = 2; c < face.corner_count; ++c) {
      origin.add({position(face.first_corner), position(face.first_corner + c - 1),
                  position(face.first_corner + c)});
    }
  }
  scene.origin = origin.best();
  for (glm::dvec3& at : file.positions) at -= scene.origin;
}

}  // namespace

void import_obj(reading::ImportContext& context) {
  if (!context.options.panels.empty()) {
    throw UsageError(fmt::format("panel at node {}: nodes are what glTF files have; this is an OBJ",
                                 context.options.panels.front().node));
  }
  if (!context.options.scene.empty()) {
    throw UsageError(fmt::format("scene {}: only glTF files hold several scenes; this is an OBJ",
                                 context.options.scene));
  }
  const std::vector<unsigned char> bytes = context.folder.read_scene_file();
  std::string text(bytes.begin(), bytes.end());
  ObjTextFindings findings;
  try {
    findings = examine_obj_text(text);
  } catch (const files::ResourceError& error) {
    throw context.error(error.what());
  }
  report_findings(findings, context.warnings);
  ObjFile file = read_obj(text, context);
  for (const std::uint64_t vertex : findings.unreadable_vertices) {
    if (vertex < file.positions.size()) {
      file.positions[vertex] = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    }
  }
  turn(file, context.scene.turn);
  move_to_origin(file, context.scene);
  context.scene.unit = PowerUnit::watt;
  const std::vector<std::uint32_t> material_index =
      add_materials(file, read_obj_libraries(findings.libraries, context), context);
  const SceneNeeds needs = scene::needs_of_materials(context.scene.materials);
  scene::MeshBuilder builder(context.scene,
                             {needs.textures, reading::has_emission_texture(context), true});
  reading::PlainMaterials plain_materials(context.scene);
  for (const ObjFace& face : file.faces) {
    const std::size_t name = face.material == none ? material_index.size() - 1 : face.material;
    add_face(file, face, material_index[name], builder, plain_materials, context);
  }
  builder.finish();
  scene::drop_flat_normals(context.scene, needs);
}

}  // namespace photile::obj
