#include "gltf/primitives.hpp"

#include <fmt/format.h>

#include <numeric>

namespace photile::gltf {

bool has_triangles(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

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
          fmt::format("{}: index {} of {} vertices; export it again", use, index, corner_count));
    }
  }
  return indices;
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

}  // namespace photile::gltf
