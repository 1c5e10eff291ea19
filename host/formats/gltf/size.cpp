#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "gltf/primitives.hpp"
#include "gltf/steps.hpp"
#include "photile/limits.hpp"

namespace photile::gltf {
namespace {

/// A triangle takes three indices at least, of a byte each.
constexpr std::uint64_t least_bytes_per_triangle = 3;

/// Beyond any limit, and small enough to be added and multiplied by any number of visits.
constexpr std::uint64_t too_many = 3 * limits::max_triangles;

/// The triangles of a primitive, and no fewer than the work on its vertices is worth: a mesh may
/// have vertices that no triangle uses, and primitives without triangles take time, too.
std::uint64_t cost_of(const tinygltf::Primitive& primitive, std::uint64_t buffer_bytes,
                      const std::string& use, const AccessorReader& accessors) {
  if (!is_usable(primitive, use, accessors)) return 1;
  // Accessors of more elements are refused, by what they ask for, when they are read.
  const std::uint64_t vertices = std::min(accessors.count(attribute(primitive, "POSITION"), use),
                                          limits::max_implicit_elements + buffer_bytes);
  const std::uint64_t corners =
      primitive.indices >= 0 ? accessors.count(primitive.indices, use) : vertices;
  const std::uint64_t per_triangle = primitive.mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
  return std::clamp<std::uint64_t>(std::max(corners / per_triangle, vertices / 3), 1, too_many);
}

std::uint64_t cost_of_mesh(const tinygltf::Model& model, int mesh, std::uint64_t buffer_bytes,
                           const AccessorReader& accessors) {
  const std::string use = fmt::format("mesh '{}'", name_of_mesh(model, mesh));
  std::uint64_t cost = 0;
  for (const tinygltf::Primitive& primitive :
       model.meshes[static_cast<std::size_t>(mesh)].primitives) {
    cost = std::min(cost + cost_of(primitive, buffer_bytes, use, accessors), too_many);
  }
  return cost;
}

std::uint64_t bytes_of_buffers(const tinygltf::Model& model) {
  std::uint64_t bytes = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) bytes += buffer.data.size();
  return bytes;
}

}  // namespace

void check_scene_size(const tinygltf::Model& model, const AccessorReader& accessors,
                      const std::vector<NodeVisit>& visits, const reading::ImportContext& context) {
  std::vector<std::uint64_t> places(model.meshes.size(), 0);
  for (const NodeVisit& visit : visits) {
    const int mesh = model.nodes[static_cast<std::size_t>(visit.node)].mesh;
    if (mesh >= 0 && static_cast<std::size_t>(mesh) < places.size()) {
      ++places[static_cast<std::size_t>(mesh)];
    }
  }
  const std::uint64_t buffer_bytes = bytes_of_buffers(model);
  std::uint64_t triangles = 0, most = 0;
  int largest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == 0) continue;
    const auto mesh = static_cast<int>(i);
    const std::uint64_t placed = places[i] * cost_of_mesh(model, mesh, buffer_bytes, accessors);
    triangles += placed;
    if (placed > most) {
      most = placed;
      largest = mesh;
    }
  }
  if (triangles > limits::max_triangles) {
    throw context.error(fmt::format(
        "{} triangles, {} of them by {} places of mesh '{}'; the limit is {}; split the "
        "scene",
        triangles, most, places[static_cast<std::size_t>(largest)], name_of_mesh(model, largest),
        limits::max_triangles));
  }
  const std::uint64_t held = buffer_bytes / least_bytes_per_triangle + model.nodes.size();
  const std::uint64_t most_placed =
      std::max(limits::unchecked_triangles, held * limits::max_triangle_expansion);
  if (triangles > most_placed) {
    throw context.error(
        fmt::format("{} triangles from a file that holds no more than {}; the limit for it is {}; "
                    "repeat fewer: {} are of mesh '{}', in {} places",
                    triangles, held, most_placed, most, name_of_mesh(model, largest),
                    places[static_cast<std::size_t>(largest)]));
  }
}

}  // namespace photile::gltf
