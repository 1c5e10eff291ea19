#include "scene/gltf_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>

#include "photile/limits.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_panels.hpp"
#include "scene/gltf_primitives.hpp"
#include "scene/instance_recorder.hpp"
#include "scene/light_traits.hpp"
#include "scene/material_needs.hpp"

namespace photile::scene_io {
namespace {

class MeshImporter {
 public:
  MeshImporter(const tinygltf::Model& model, const AccessorReader& accessors,
               const std::vector<NodeVisit>& visits,
               const std::vector<MaterialCoordinates>& coordinates, ImportContext& context)
      : model_(model),
        accessors_(accessors),
        coordinates_(coordinates),
        context_(context),
        needs_(needs_of_materials(context.scene.materials)),
        builder_(context.scene, {needs_.textures, has_emission_texture(context),
                                 needs_.glossy || needs_.specular_paths}),
        instances_(context.scene) {
    for (const NodeVisit& visit : visits) ++uses_[mesh_of(visit)];
  }

  void add(const NodeVisit& visit, std::uint64_t visit_number);
  void add_panel(const NodeVisit& visit, std::uint64_t visit_number);
  void finish() {
    builder_.finish();
    instances_.finish();
  }

 private:
  int mesh_of(const NodeVisit& visit) const {
    return model_.nodes[static_cast<std::size_t>(visit.node)].mesh;
  }
  void add_primitive(const tinygltf::Primitive& primitive, const NodeVisit& visit,
                     std::uint64_t visit_number, const std::string& mesh_name);
  std::vector<Corner> read_corners(const tinygltf::Primitive& primitive, std::uint32_t material,
                                   const glm::dmat4& world, const std::string& mesh_name);
  std::uint32_t material_of(const tinygltf::Primitive& primitive, const std::string& use) const;

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  const std::vector<MaterialCoordinates>& coordinates_;
  ImportContext& context_;
  SceneNeeds needs_;
  MeshBuilder builder_;
  InstanceRecorder instances_;
  std::map<int, std::size_t> uses_;  ///< of each mesh
  std::vector<bool> kept_;           ///< triangles of the visit that the scene took
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
  LightTraits traits = light_traits(model_.nodes[static_cast<std::size_t>(visit.node)].extras, name,
                                    context_.warnings);
  traits.lumens = 0;  // the panel's own say so
  const std::uint32_t light = context_.area_lights.find_or_add(
      first_panel_object + visit_number, name, panel_material_, {panel->radiance, false}, traits);
  for (const auto& corners : panel_triangles(*panel, visit.world)) {
    std::array<Corner, 3> triangle;
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
  const std::vector<Corner> corners = read_corners(primitive, material, visit.world, mesh_name);
  const std::vector<std::uint32_t> indices =
      read_indices(primitive, corners.size(), use, accessors_, context_);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0) {
    context_.warnings.add("mesh", mesh_name, "the corners do not fill the last triangle; ignored");
  }
  // A mirrored node turns the winding of its triangles round.
  const bool mirrored = glm::determinant(glm::dmat3(visit.world)) < 0.0;
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
  const std::uint32_t light = context_.area_lights.find_or_add(
      visit_number, node.name.empty() ? mesh_name : node.name, material,
      context_.emission[material],
      light_traits(node.extras, node_name(model_, visit.node), context_.warnings));
  for (const auto& [a, b, c] : assemble(indices, primitive.mode)) {
    const std::array<Corner, 3> triangle{corners[mirrored ? c : a], corners[b],
                                         corners[mirrored ? a : c]};
    kept_.push_back(builder_.add(triangle, material, light));
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

std::vector<Corner> MeshImporter::read_corners(const tinygltf::Primitive& primitive,
                                               std::uint32_t material, const glm::dmat4& world,
                                               const std::string& mesh_name) {
  const auto read = [&](const std::string& name, int components) {
    const int accessor = attribute(primitive, name);
    if (accessor < 0) return std::vector<float>();
    return accessors_.floats(accessor, components, fmt::format("{} of mesh '{}'", name, mesh_name));
  };
  const std::vector<float> positions = read("POSITION", 3);
  const std::size_t count = positions.size() / 3;
  const MaterialCoordinates& coordinates = coordinates_[material];
  const auto read_uv = [&](bool textured, int set) {
    if (!textured) return std::vector<float>();
    std::vector<float> uv = read(fmt::format("TEXCOORD_{}", set), 2);
    if (uv.size() == 2 * count) return uv;
    context_.warnings.add("mesh", mesh_name, "has no texture coordinates for its texture");
    return std::vector<float>();
  };
  const std::vector<float> uv =
      read_uv(context_.scene.materials[material].textured(), coordinates.surface.set);
  const std::vector<float> emission_uv =
      read_uv(context_.emission[material].texture != none, coordinates.emission.set);
  std::vector<float> normals;
  if (needs_.glossy || needs_.specular_paths) normals = read("NORMAL", 3);
  if (normals.size() != 3 * count) normals.clear();

  const glm::dmat3 linear(world);
  // The cofactor matrix is the inverse transpose times the determinant: it needs no division, and
  // only the direction of a normal counts. MeshBuilder mends the sign of mirrored ones.
  const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
  std::vector<Corner> corners(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto vector = [&](const std::vector<float>& values) {
      return glm::dvec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    };
    corners[i].position = glm::dvec3(world * glm::dvec4(vector(positions), 1.0));
    const auto mapped = [&](const std::vector<float>& values, const TextureCoordinates& map) {
      return values.empty() ? glm::dvec2(0.0) : map(glm::dvec2(values[2 * i], values[2 * i + 1]));
    };
    corners[i].uv = mapped(uv, coordinates.surface);
    corners[i].emission_uv = mapped(emission_uv, coordinates.emission);
    if (!normals.empty()) corners[i].normal = cofactor * vector(normals);
  }
  return corners;
}

}  // namespace

void check_triangle_count(const tinygltf::Model& model, const AccessorReader& accessors,
                          const std::vector<NodeVisit>& visits, const ImportContext& context) {
  std::uint64_t triangles = 0;
  for (const NodeVisit& visit : visits) {
    const int mesh = model.nodes[static_cast<std::size_t>(visit.node)].mesh;
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= model.meshes.size()) continue;
    for (const tinygltf::Primitive& primitive :
         model.meshes[static_cast<std::size_t>(mesh)].primitives) {
      const std::string use = fmt::format("mesh '{}'", name_of_mesh(model, mesh));
      if (!is_usable(primitive, use, accessors)) continue;
      const int counted =
          primitive.indices >= 0 ? primitive.indices : attribute(primitive, "POSITION");
      const std::uint64_t count = accessors.count(counted, use);
      const std::uint64_t per_triangle = primitive.mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
      triangles += std::min(count, 3 * limits::max_triangles) / per_triangle;
      if (triangles > limits::max_triangles) {
        throw context.error(
            fmt::format("more than {} triangles; split the scene", limits::max_triangles));
      }
    }
  }
}

void add_gltf_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits,
                     const std::vector<MaterialCoordinates>& coordinates, ImportContext& context) {
  MeshImporter importer(model, accessors, visits, coordinates, context);
  check_panel_names(model, visits, context);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    importer.add(visits[i], i);
    importer.add_panel(visits[i], i);
  }
  importer.finish();
}

}  // namespace photile::scene_io
