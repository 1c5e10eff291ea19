#include "gltf/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "gltf/document.hpp"
#include "gltf/light_traits.hpp"
#include "gltf/panels.hpp"
#include "gltf/primitives.hpp"
#include "gltf/vertices.hpp"
#include "reading/instance_recorder.hpp"
#include "reading/plain_material.hpp"
#include "scene/surface_models.hpp"

namespace photile::gltf {
namespace {

bool has_normal_map(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.normal_texture != none; });
}

/// What the triangles of a primitive are made of.
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
    for (const NodeVisit& visit : visits) ++uses_[mesh_of(visit)];
  }

  void add(const NodeVisit& visit, std::uint64_t visit_number);
  void add_panel(const NodeVisit& visit, std::uint64_t visit_number);
  void finish() {
    builder_.finish();
    scene::drop_flat_normals(context_.scene, needs_);
    instances_.finish();
  }

 private:
  int mesh_of(const NodeVisit& visit) const {
    return model_.nodes[static_cast<std::size_t>(visit.node)].mesh;
  }
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
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
  if (node.mesh < 0) return;
  if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
    throw context_.error(fmt::format("node '{}': there is no mesh {}; export it again",
                                     node_name(model_, visit.node), node.mesh));
  }
  const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
  const std::string name = name_of_mesh(model_, node.mesh);
  if (node.skin >= 0) {
    context_.warnings.add("node", node_name(model_, visit.node), "skin is ignored: rest pose");
  }
  const auto first = static_cast<std::uint32_t>(context_.scene.triangles.size());
  kept_.clear();
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
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
  reading::LightTraits traits = light_traits(
      model_.nodes[static_cast<std::size_t>(visit.node)].extras, name, context_.warnings);
  traits.lumens = 0;  // the panel's own say so
  traits.lamp = lamp_of(model_.nodes[static_cast<std::size_t>(visit.node)], "EXT_lights_area");
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
    context_.warnings.add("mesh", mesh_name, "morph targets are ignored: rest pose");
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
    context_.warnings.add("mesh", mesh_name, "the corners do not fill the last triangle; ignored");
  }
  // A mirrored node turns the winding of its triangles round.
  const bool mirrored = glm::determinant(glm::dmat3(visit.world)) < 0.0;
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
  reading::LightTraits traits =
      light_traits(node.extras, node_name(model_, visit.node), context_.warnings);
  traits.lamp = fmt::format("mesh {}", node.mesh);
  const std::uint32_t light = context_.area_lights.find_or_add(
      visit_number, node.name.empty() ? mesh_name : node.name, material, surface.emission, traits);
  for (const auto& [a, b, c] : assemble(indices, primitive.mode)) {
    const std::array<scene::Corner, 3> triangle{vertices[mirrored ? c : a], vertices[b],
                                                vertices[mirrored ? a : c]};
    kept_.push_back(builder_.add(triangle, surface.material, light));
  }
}

std::uint32_t MeshImporter::material_of(const tinygltf::Primitive& primitive,
                                        const std::string& use) const {
  const std::size_t default_material = model_.materials.size();
  if (primitive.material < 0) return static_cast<std::uint32_t>(default_material);
  if (static_cast<std::size_t>(primitive.material) >= default_material) {
    throw context_.error(
        fmt::format("{}: there is no material {}; export it again", use, primitive.material));
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
/// wants it and what is used instead.
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

/// What `surface` cannot have for lack of coordinates is taken from it.
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
    uv = read_coordinates(
        primitive, coordinates.surface.set, count, mesh_name,
        fmt::format("the textures of material '{}'; {} is used instead", name,
                    material.diffuse_texture == none ? "what its factors say" : "mid grey (0.5)"));
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
    importer.add(visits[i], i);
    importer.add_panel(visits[i], i);
  }
  importer.finish();
}

}  // namespace photile::gltf
