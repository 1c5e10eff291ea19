#include "scene/gltf_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "photile/limits.hpp"
#include "scene/instance_recorder.hpp"
#include "scene/material_needs.hpp"

namespace photile::scene_io {
namespace {

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

bool has_triangles(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

class MeshImporter {
 public:
  MeshImporter(const tinygltf::Model& model, const AccessorReader& accessors,
               const std::vector<NodeVisit>& visits,
               const std::vector<TextureCoordinates>& coordinates, ImportContext& context)
      : model_(model),
        accessors_(accessors),
        coordinates_(coordinates),
        context_(context),
        needs_(needs_of_materials(context.scene.materials)),
        builder_(context.scene, needs_.textures, needs_.glossy || needs_.specular_paths),
        instances_(context.scene) {
    for (const NodeVisit& visit : visits) ++uses_[mesh_of(visit)];
  }

  void add(const NodeVisit& visit, std::uint64_t visit_number);
  void finish() {
    builder_.finish();
    instances_.finish();
  }

 private:
  int mesh_of(const NodeVisit& visit) const {
    return model_.nodes[static_cast<std::size_t>(visit.node)].mesh;
  }
  LocalMesh read_local(const tinygltf::Mesh& mesh, const std::string& name) const;
  void add_primitive(const tinygltf::Primitive& primitive, const NodeVisit& visit,
                     std::uint64_t visit_number, const std::string& mesh_name);
  std::vector<Corner> read_corners(const tinygltf::Primitive& primitive, std::uint32_t material,
                                   const glm::dmat4& world, const std::string& mesh_name);
  std::vector<std::uint32_t> read_indices(const tinygltf::Primitive& primitive,
                                          std::size_t corner_count, const std::string& use) const;
  std::uint32_t material_of(const tinygltf::Primitive& primitive, const std::string& use) const;
  int attribute(const tinygltf::Primitive& primitive, const std::string& name) const {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
  }

  const tinygltf::Model& model_;
  const AccessorReader& accessors_;
  const std::vector<TextureCoordinates>& coordinates_;
  ImportContext& context_;
  SceneNeeds needs_;
  MeshBuilder builder_;
  InstanceRecorder instances_;
  std::map<int, std::size_t> uses_;  ///< of each mesh
  std::vector<bool> kept_;           ///< triangles of the visit that the scene took
};

/// Whether triangles can be made of it.
bool is_usable(const tinygltf::Primitive& primitive) {
  return has_triangles(primitive.mode) && primitive.attributes.count("POSITION") > 0;
}

void MeshImporter::add(const NodeVisit& visit, std::uint64_t visit_number) {
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
  if (node.mesh < 0) return;
  if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
    throw context_.error(fmt::format("node '{}': there is no mesh {}; export it again",
                                     node_name(model_, visit.node), node.mesh));
  }
  const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
  const std::string name = mesh.name.empty() ? fmt::format("mesh {}", node.mesh) : mesh.name;
  if (node.skin >= 0) {
    context_.warnings.add("node", node_name(model_, visit.node), "skin is ignored: rest pose");
  }
  const auto first = static_cast<std::uint32_t>(context_.scene.triangles.size());
  kept_.clear();
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    if (is_usable(primitive)) {
      add_primitive(primitive, visit, visit_number, name);
    } else {
      context_.warnings.add("mesh", name,
                            has_triangles(primitive.mode) ? "has no positions; ignored"
                                                          : "points and lines are ignored");
    }
  }
  if (uses_[node.mesh] > 1) {
    instances_.record(node.mesh, visit.world, first, kept_, [&] { return read_local(mesh, name); });
  }
}

LocalMesh MeshImporter::read_local(const tinygltf::Mesh& mesh, const std::string& name) const {
  LocalMesh local;
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    if (!is_usable(primitive)) continue;
    const auto first = static_cast<std::uint32_t>(local.positions.size());
    const std::vector<float> positions =
        accessors_.floats(attribute(primitive, "POSITION"), 3, "POSITION of mesh '" + name + "'");
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
      local.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
    }
    const std::vector<std::uint32_t> indices =
        read_indices(primitive, positions.size() / 3, "mesh '" + name + "'");
    for (const auto& [a, b, c] : assemble(indices, primitive.mode)) {
      local.triangles.push_back(first + glm::uvec3(a, b, c));
    }
  }
  return local;
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
  const std::vector<std::uint32_t> indices = read_indices(primitive, corners.size(), use);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0) {
    context_.warnings.add("mesh", mesh_name, "the corners do not fill the last triangle; ignored");
  }
  // A mirrored node turns the winding of its triangles round.
  const bool mirrored = glm::determinant(glm::dmat3(visit.world)) < 0.0;
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
  const std::uint32_t light = context_.area_lights.find_or_add(
      visit_number, node.name.empty() ? mesh_name : node.name, material,
      context_.emission[material], light_group(node.extras));
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
  const TextureCoordinates& coordinates = coordinates_[material];
  const bool textured = context_.scene.materials[material].diffuse_texture != none;
  std::vector<float> uv, normals;
  if (textured) uv = read(fmt::format("TEXCOORD_{}", coordinates.set), 2);
  if (needs_.glossy || needs_.specular_paths) normals = read("NORMAL", 3);
  if (textured && uv.size() != 2 * count) {
    context_.warnings.add("mesh", mesh_name, "has no texture coordinates for its texture");
    uv.clear();
  }
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
    if (!uv.empty()) corners[i].uv = coordinates(glm::dvec2(uv[2 * i], uv[2 * i + 1]));
    if (!normals.empty()) corners[i].normal = cofactor * vector(normals);
  }
  return corners;
}

std::vector<std::uint32_t> MeshImporter::read_indices(const tinygltf::Primitive& primitive,
                                                      std::size_t corner_count,
                                                      const std::string& use) const {
  if (primitive.indices < 0) {
    std::vector<std::uint32_t> indices(corner_count);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  std::vector<std::uint32_t> indices = accessors_.indices(primitive.indices, "indices of " + use);
  for (const std::uint32_t index : indices) {
    if (index >= corner_count) {
      throw context_.error(
          fmt::format("{}: index {} of {} vertices; export it again", use, index, corner_count));
    }
  }
  return indices;
}

/// Refuses scenes whose shared meshes multiply beyond the limit before any is read.
void check_triangle_count(const tinygltf::Model& model, const AccessorReader& accessors,
                          const std::vector<NodeVisit>& visits, const ImportContext& context) {
  std::uint64_t triangles = 0;
  for (const NodeVisit& visit : visits) {
    const int mesh = model.nodes[static_cast<std::size_t>(visit.node)].mesh;
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= model.meshes.size()) continue;
    for (const tinygltf::Primitive& primitive :
         model.meshes[static_cast<std::size_t>(mesh)].primitives) {
      const auto position = primitive.attributes.find("POSITION");
      const int counted = primitive.indices >= 0                   ? primitive.indices
                          : position == primitive.attributes.end() ? -1
                                                                   : position->second;
      if (counted < 0) continue;
      const std::uint64_t count = accessors.count(counted, "a mesh");
      const std::uint64_t per_triangle = primitive.mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
      triangles += std::min(count, 3 * limits::max_triangles) / per_triangle;
      if (triangles > limits::max_triangles) {
        throw context.error(
            fmt::format("more than {} triangles; split the scene", limits::max_triangles));
      }
    }
  }
}

}  // namespace

void add_gltf_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits,
                     const std::vector<TextureCoordinates>& coordinates, ImportContext& context) {
  check_triangle_count(model, accessors, visits, context);
  MeshImporter importer(model, accessors, visits, coordinates, context);
  for (std::size_t i = 0; i < visits.size(); ++i) importer.add(visits[i], i);
  importer.finish();
}

}  // namespace photile::scene_io
