#include "gltf/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "gltf/document.hpp"
#include "gltf/lights.hpp"
#include "gltf/panels.hpp"
#include "scene/surface_models.hpp"

namespace photile::gltf {

namespace {

/// Whether a primitive's mode makes triangles.
bool has_triangles(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Corner numbers of the triangles that a primitive's mode makes of its index list.
std::vector<std::array<std::uint32_t, 3>> assemble(const std::vector<std::uint32_t>& indices,
                                                   int mode) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (indices.size() < 3) return triangles;
  const std::size_t count = indices.size() - 2;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i < count; i += 3) {
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t odd = i % 2;  // every second triangle of a strip is wound the other way
      triangles.push_back({indices[i], indices[i + 1 + odd], indices[i + 2 - odd]});
    }
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
    }
  }
  return triangles;
}

/// The index list of a primitive of `corner_count` corners; 0, 1, 2 ... where it has none. `use`
/// names the mesh in errors. Errors: InputError for an index beyond the corners.
std::vector<std::uint32_t> read_indices(const tinygltf::Primitive& primitive,
                                        std::size_t corner_count, const std::string& use,
                                        const AccessorReader& accessors,
                                        const reading::ImportContext& context) {
  if (primitive.indices < 0) {
    std::vector<std::uint32_t> indices(corner_count);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  std::vector<std::uint32_t> indices = accessors.indices(primitive.indices, "indices of " + use);
  for (const std::uint32_t index : indices) {
    if (index >= corner_count) {
      throw context.error(
          fmt::format("{}: index {} is out of range of {} vertices; export the file again", use,
                      index, corner_count));
    }
  }
  return indices;
}

}  // namespace

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

bool is_usable(const tinygltf::Primitive& primitive, const std::string& use,
               const AccessorReader& accessors) {
  const int position = attribute(primitive, "POSITION");
  return has_triangles(primitive.mode) && position >= 0 &&
         accessors.has_data(position, "POSITION of " + use);
}

std::string name_of_mesh(const tinygltf::Model& model, int mesh) {
  const std::string& name = model.meshes[static_cast<std::size_t>(mesh)].name;
  return name.empty() ? fmt::format("mesh {}", mesh) : name;
}

reading::LocalMesh read_local_mesh(const tinygltf::Model& model, int mesh,
                                   const AccessorReader& accessors,
                                   const reading::ImportContext& context) {
  const std::string use = "mesh '" + name_of_mesh(model, mesh) + "'";
  reading::LocalMesh local;
  for (const tinygltf::Primitive& primitive :
       model.meshes[static_cast<std::size_t>(mesh)].primitives) {
    if (!is_usable(primitive, use, accessors)) continue;
    const auto first = static_cast<std::uint32_t>(local.positions.size());
    const std::vector<float> positions =
        accessors.floats(attribute(primitive, "POSITION"), 3, "POSITION of " + use);
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
      local.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
    }
    const std::vector<std::uint32_t> indices =
        read_indices(primitive, positions.size() / 3, use, accessors, context);
    for (const auto& [a, b, c] : assemble(indices, primitive.mode)) {
      local.triangles.push_back(first + glm::uvec3(a, b, c));
    }
  }
  return local;
}

namespace {

glm::dvec3 vector_at(const std::vector<float>& values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

glm::dvec2 mapped(const std::vector<float>& uv, std::size_t vertex, const TextureCoordinates& map) {
  return uv.empty() ? glm::dvec2(0.0) : map(glm::dvec2(uv[2 * vertex], uv[2 * vertex + 1]));
}

/// The cofactor matrix is the inverse transpose times the determinant: it needs no division, and
/// only the direction of a normal counts. MeshBuilder mends the sign of mirrored ones.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

/// The attributes as the file has them, one after another: 3 floats a vertex, 4 of tangents, 2 of
/// coordinates. All but the positions are empty where they are absent or not requested.
struct VertexAttributes {
  std::vector<float> positions, normals, tangents, uv, emission_uv;
};

/// Each vertex is placed when a triangle asks for it: all of them at once would take several times
/// the memory of the file, which takes longer to get than to fill.
class PlacedVertices {
 public:
  /// `coordinates` is kept.
  PlacedVertices(VertexAttributes attributes, const MaterialCoordinates& coordinates,
                 const glm::dmat4& world);

  std::size_t size() const { return attributes_.positions.size() / 3; }
  scene::Corner operator[](std::uint32_t vertex) const;

 private:
  VertexAttributes attributes_;
  const MaterialCoordinates& coordinates_;
  glm::dmat4 world_;
  glm::dmat3 normal_matrix_;
};

PlacedVertices::PlacedVertices(VertexAttributes attributes, const MaterialCoordinates& coordinates,
                               const glm::dmat4& world)
    : attributes_(std::move(attributes)),
      coordinates_(coordinates),
      world_(world),
      normal_matrix_(cofactors(glm::dmat3(world))) {}

scene::Corner PlacedVertices::operator[](std::uint32_t vertex) const {
  const std::size_t i = vertex;
  const auto& [positions, normals, tangents, uv, emission_uv] = attributes_;
  scene::Corner corner;
  corner.position = glm::dvec3(world_ * glm::dvec4(vector_at(positions, 3 * i), 1.0));
  corner.uv = mapped(uv, i, coordinates_.surface);
  corner.emission_uv = mapped(emission_uv, i, coordinates_.emission);
  if (!normals.empty()) corner.normal = normal_matrix_ * vector_at(normals, 3 * i);
  if (tangents.empty()) return corner;
  corner.tangent = glm::dmat3(world_) * vector_at(tangents, 4 * i);
  // The cofactors of a mirrored node turn the normal round, and with it the bitangent.
  corner.handedness = double{tangents[4 * i + 3]};
  return corner;
}

bool has_normal_map(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.normal_texture != none; });
}

/// The material and the emission of a primitive's triangles.
struct Surface {
  std::uint32_t material;
  reading::Emission emission;
};

class MeshImporter {
 public:
  MeshImporter(const tinygltf::Model& model, const AccessorReader& accessors,
               const std::vector<NodeVisit>& visits,
               const std::vector<MaterialCoordinates>& coordinates, reading::ImportContext& context)
      : model_(model),
        accessors_(accessors),
        coordinates_(coordinates),
        context_(context),
        needs_(scene::needs_of_materials(context.scene.materials)),
        builder_(context.scene, {needs_.textures, reading::has_emission_texture(context), true,
                                 has_normal_map(context.scene)}),
        instances_(context.scene),
        plain_materials_(context.scene) {
    for (const NodeVisit& visit : visits) ++uses_[visit.source->mesh];
  }

  void add(const NodeVisit& visit, std::uint64_t visit_number);
  void add_panel(const NodeVisit& visit, std::uint64_t visit_number);
  void finish() {
    builder_.finish();
    scene::drop_flat_normals(context_.scene, needs_);
    instances_.finish();
  }

 private:
  void add_primitive(const tinygltf::Primitive& primitive, const NodeVisit& visit,
                     std::uint64_t visit_number, const std::string& mesh_name);
  PlacedVertices read_vertices(const tinygltf::Primitive& primitive, const glm::dmat4& world,
                               const std::string& mesh_name, Surface& surface);
  std::vector<float> read_attribute(const tinygltf::Primitive& primitive, const std::string& name,
                                    int components, const std::string& mesh_name) const;
  std::vector<float> read_coordinates(const tinygltf::Primitive& primitive, int set,
                                      std::size_t corner_count, const std::string& mesh_name,
                                      const std::string& what);
  std::uint32_t material_of(const tinygltf::Primitive& primitive, const std::string& use) const;

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  const std::vector<MaterialCoordinates>& coordinates_;
  reading::ImportContext& context_;
  SceneNeeds needs_;
  scene::MeshBuilder builder_;
  reading::InstanceRecorder instances_;
  std::map<int, std::size_t> uses_;  ///< of each mesh
  std::vector<bool> kept_;           ///< triangles of the visit that the scene took
  reading::PlainMaterials plain_materials_;
  std::uint32_t panel_material_ = none;
};

void MeshImporter::add(const NodeVisit& visit, std::uint64_t visit_number) {
  const tinygltf::Node& node = *visit.source;
  if (node.mesh < 0) return;
  const tinygltf::Mesh* const mesh = element(model_.meshes, node.mesh);
  if (mesh == nullptr) {
    throw context_.error(fmt::format("node '{}': there is no mesh {}; export the file again",
                                     node_name(model_, visit.node), node.mesh));
  }
  const std::string name = name_of_mesh(model_, node.mesh);
  if (node.skin >= 0) {
    context_.warnings.add("node", node_name(model_, visit.node),
                          "its skin is ignored; the rest pose is used");
  }
  const auto first = static_cast<std::uint32_t>(context_.scene.triangles.size());
  kept_.clear();
  for (const tinygltf::Primitive& primitive : mesh->primitives) {
    if (!has_triangles(primitive.mode)) {
      context_.warnings.add("mesh", name, "points and lines are ignored");
    } else if (!is_usable(primitive, fmt::format("mesh '{}'", name), accessors_)) {
      context_.warnings.add("mesh", name, "has no positions; ignored");
    } else {
      add_primitive(primitive, visit, visit_number, name);
    }
  }
  if (uses_[node.mesh] > 1) {
    instances_.record(node.mesh, visit.world, first, kept_,
                      [&] { return read_local_mesh(model_, node.mesh, accessors_, context_); });
  }
}

void MeshImporter::add_panel(const NodeVisit& visit, std::uint64_t visit_number) {
  const std::optional<Panel> panel = panel_of(model_, visit.node, context_);
  if (!panel) return;
  const std::string name = node_name(model_, visit.node);
  if (panel_material_ == none) {
    panel_material_ = static_cast<std::uint32_t>(context_.scene.materials.size());
    context_.scene.materials.emplace_back().name = "panel";  // black
  }
  reading::LightTraits traits = light_traits(visit.source->extras, name, context_.warnings);
  traits.lumens = 0;  // the panel's radiance holds them
  traits.lamp = lamp_of(*visit.source, "EXT_lights_area");
  const std::uint32_t light =
      context_.area_lights.find_or_add(reading::first_panel_object + visit_number, name,
                                       panel_material_, {panel->radiance, false}, traits);
  for (const auto& corners : panel_triangles(*panel, visit.world)) {
    std::array<scene::Corner, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i].position = corners[i];
    builder_.add(triangle, panel_material_, light);
  }
}

void MeshImporter::add_primitive(const tinygltf::Primitive& primitive, const NodeVisit& visit,
                                 std::uint64_t visit_number, const std::string& mesh_name) {
  if (!primitive.targets.empty()) {
    context_.warnings.add("mesh", mesh_name,
                          "its morph targets are ignored; the rest pose is used");
  }
  if (primitive.attributes.count("COLOR_0") > 0) {
    context_.warnings.add("mesh", mesh_name, "vertex colours are ignored");
  }
  const std::string use = fmt::format("mesh '{}'", mesh_name);
  const std::uint32_t material = material_of(primitive, use);
  Surface surface{material, context_.emission[material]};
  const PlacedVertices vertices = read_vertices(primitive, visit.world, mesh_name, surface);
  const std::vector<std::uint32_t> indices =
      read_indices(primitive, vertices.size(), use, accessors_, context_);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0) {
    context_.warnings.add("mesh", mesh_name, "the last triangle lacks corners; ignored");
  }
  // A mirrored node turns the winding of its triangles round.
  const bool mirrored = glm::determinant(glm::dmat3(visit.world)) < 0.0;
  const tinygltf::Node& node = *visit.source;
  reading::LightTraits traits =
      light_traits(node.extras, node_name(model_, visit.node), context_.warnings);
  traits.lamp = fmt::format("mesh {}", node.mesh);
  const std::uint32_t light = context_.area_lights.find_or_add(
      visit_number, node.name.empty() ? mesh_name : node.name, material, surface.emission, traits);
  for (const auto& [a, b, c] : assemble(indices, primitive.mode)) {
    context_.check_cancelled();
    const std::array<scene::Corner, 3> triangle{vertices[mirrored ? c : a], vertices[b],
                                                vertices[mirrored ? a : c]};
    kept_.push_back(builder_.add(triangle, surface.material, light));
  }
}

std::uint32_t MeshImporter::material_of(const tinygltf::Primitive& primitive,
                                        const std::string& use) const {
  if (primitive.material < 0)
    return static_cast<std::uint32_t>(model_.materials.size());  // default
  if (element(model_.materials, primitive.material) == nullptr) {
    throw context_.error(
        fmt::format("{}: there is no material {}; export the file again", use, primitive.material));
  }
  return static_cast<std::uint32_t>(primitive.material);
}

std::vector<float> MeshImporter::read_attribute(const tinygltf::Primitive& primitive,
                                                const std::string& name, int components,
                                                const std::string& mesh_name) const {
  const int accessor = attribute(primitive, name);
  if (accessor < 0) return {};
  return accessors_.floats(accessor, components, fmt::format("{} of mesh '{}'", name, mesh_name));
}

/// TEXCOORD_`set`; empty, with a warning, where the primitive lacks it. `what` says which texture
/// needs it and what is used instead.
std::vector<float> MeshImporter::read_coordinates(const tinygltf::Primitive& primitive, int set,
                                                  std::size_t corner_count,
                                                  const std::string& mesh_name,
                                                  const std::string& what) {
  const std::string name = fmt::format("TEXCOORD_{}", set);
  std::vector<float> uv = read_attribute(primitive, name, 2, mesh_name);
  if (uv.size() == 2 * corner_count) return uv;
  context_.warnings.add("mesh", mesh_name, fmt::format("has no {} for {}", name, what));
  return {};
}

/// Removes from `surface` the textures that the primitive has no coordinates for.
PlacedVertices MeshImporter::read_vertices(const tinygltf::Primitive& primitive,
                                           const glm::dmat4& world, const std::string& mesh_name,
                                           Surface& surface) {
  VertexAttributes vertices;
  auto& [positions, normals, tangents, uv, emission_uv] = vertices;
  positions = read_attribute(primitive, "POSITION", 3, mesh_name);
  const std::size_t count = positions.size() / 3;
  const MaterialCoordinates& coordinates = coordinates_[surface.material];
  const Material& material = context_.scene.materials[surface.material];
  const std::string name = material.name;
  normals = read_attribute(primitive, "NORMAL", 3, mesh_name);
  if (normals.size() != 3 * count) normals.clear();
  if (material.normal_texture != none && !normals.empty()) {
    tangents = read_attribute(primitive, "TANGENT", 4, mesh_name);
  }
  if (tangents.size() != 4 * count) tangents.clear();
  if (surface.emission.texture != none) {
    emission_uv = read_coordinates(
        primitive, coordinates.emission.set, count, mesh_name,
        fmt::format("the emission of material '{}'; the emissive factor is used alone", name));
    if (emission_uv.empty()) surface.emission.texture = none;
  }
  if (material.textured()) {
    uv = read_coordinates(primitive, coordinates.surface.set, count, mesh_name,
                          fmt::format("the textures of material '{}'; {} is used instead", name,
                                      material.diffuse_texture == none ? "its base-colour factor"
                                                                       : "mid grey (0.5)"));
    if (uv.empty() && count > 0) surface.material = plain_materials_.of(surface.material);
  }
  return {std::move(vertices), coordinates, world};
}

}  // namespace

void add_gltf_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits,
                     const std::vector<MaterialCoordinates>& coordinates,
                     reading::ImportContext& context) {
  MeshImporter importer(model, accessors, visits, coordinates, context);
  check_panel_names(model, visits, context);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const std::size_t before = context.scene.triangles.size();
    importer.add(visits[i], i);
    const std::size_t added = context.scene.triangles.size() - before;
    if (added > 0) {
      context.scene.report.meshes.push_back({node_name(model, visits[i].node), added});
    }
    importer.add_panel(visits[i], i);
  }
  importer.finish();
}

}  // namespace photile::gltf
