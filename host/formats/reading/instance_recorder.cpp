#include "reading/instance_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace photile::reading {
namespace {

/// An instance costs Embree about as much memory as so many triangles, and each ray that meets its
/// box the move into the mesh's space.
constexpr std::ptrdiff_t least_triangles = 64;

/// Triangles that sharing a mesh must save, about a megabyte of Embree's memory: less is not worth
/// the moves, nor the buffers that each mesh takes for itself.
constexpr std::size_t least_saved_triangles = 16'384;

/// Whether the transform is a scale along the axes, then a rotation or mirror, then a translation:
/// the columns of its linear part are at right angles. The inverse of such a transform moves a
/// point with an error of some roundings of its world coordinates, which is what the clearance of
/// host/renderer/trace/surface.cpp allows for; a skew multiplies that error.
bool keeps_right_angles(const glm::dmat4& world) {
  constexpr double tolerance = 1e-5;  // a float matrix of a rotation is not exact
  const glm::dmat3 linear(world);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(linear[i]);
    if (!std::isfinite(length) || !(length > 0)) return false;
    const glm::dvec3& other = linear[(i + 1) % 3];
    if (std::abs(glm::dot(linear[i], other)) > tolerance * length * glm::length(other)) {
      return false;
    }
  }
  return true;
}

std::vector<glm::uvec3> kept_triangles(const LocalMesh& local, const std::vector<bool>& kept) {
  std::vector<glm::uvec3> triangles;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (kept[t]) triangles.push_back(local.triangles[t]);
  }
  return triangles;
}

/// Of the triangles alone: vertices that belong to none may be anything.
glm::dvec3 centre_of(const LocalMesh& local, const std::vector<glm::uvec3>& triangles) {
  glm::dvec3 low = local.positions[triangles.front().x], high = low;
  for (const glm::uvec3& triangle : triangles) {
    for (int c = 0; c < 3; ++c) {
      low = glm::min(low, local.positions[triangle[c]]);
      high = glm::max(high, local.positions[triangle[c]]);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

void InstanceRecorder::record(int mesh, const glm::dmat4& world, std::uint32_t first_triangle,
                              const std::vector<bool>& kept,
                              const std::function<LocalMesh()>& read) {
  if (std::count(kept.begin(), kept.end(), true) < least_triangles) return;
  if (!keeps_right_angles(world)) return;
  const auto [entry, is_new] = meshes_.try_emplace(mesh);
  Mesh& known = entry->second;
  if (is_new) {
    const LocalMesh local = read();
    known.shared.triangles = kept_triangles(local, kept);
    // Around the centre, since small coordinates lose least.
    known.centre = centre_of(local, known.shared.triangles);
    for (const glm::dvec3& position : local.positions) {
      known.shared.vertices.emplace_back(position - known.centre);
    }
    known.kept = kept;
  } else if (known.kept != kept) {
    return;
  }
  glm::dmat4 from_centre = world;
  from_centre[3] = world * glm::dvec4(known.centre, 1.0);
  known.places.push_back({first_triangle, glm::mat4x3(from_centre)});
}

void InstanceRecorder::finish() {
  for (auto& [number, mesh] : meshes_) {
    const std::size_t places = std::max<std::size_t>(1, mesh.places.size());
    if ((places - 1) * mesh.shared.triangles.size() < least_saved_triangles) continue;
    const auto index = static_cast<std::uint32_t>(scene_.shared_meshes.size());
    scene_.shared_meshes.push_back(std::move(mesh.shared));
    for (const Place& place : mesh.places) {
      scene_.instances.push_back({index, place.first_triangle, place.to_world});
    }
  }
  std::sort(scene_.instances.begin(), scene_.instances.end(),
            [](const MeshInstance& a, const MeshInstance& b) {
              return a.first_triangle < b.first_triangle;
            });
  meshes_.clear();
}

}  // namespace photile::reading
