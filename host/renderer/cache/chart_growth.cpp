#include <algorithm>
#include <cmath>

#include "cache/charts.hpp"
#include "photile/neighbour_groups.hpp"
#include "surface/smooth_components.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::cache {
namespace {

using surface::SurfaceMesh;

/// Largest angle between the normal of a chart and those of its triangles, and of a fold within
/// it: the projection on the chart's plane keeps lengths to 6%.
constexpr double largest_angle_degrees = 20;

glm::dvec3 normal_of(const SurfaceMesh& mesh, std::uint32_t oriented_face) {
  const glm::dvec3& normal = mesh.normal[triangle_of(oriented_face)];
  return side_of(oriented_face) == 0 ? normal : -normal;
}

/// Tiles, whose edges run along each other, are of one chart only where the surface does not fold.
constexpr double least_cosine_of_tiles = 1 - 1e-6;

/// Per triangle the oriented faces that continue its side 0.
IndexRows continuations_of(const SurfaceMesh& mesh,
                           std::span<const surface::Connection> connections, double least_cosine) {
  return rows_of(mesh.normal.size(), [&](const auto& put) {
    for (const auto& [a, b, flip, shared] : connections) {
      const double cosine = glm::dot(mesh.normal[a], normal_of(mesh, oriented(b, flip)));
      if (!(cosine >= (shared ? least_cosine : least_cosine_of_tiles))) continue;
      put(a, oriented(b, flip));
      put(b, oriented(a, flip));
    }
  });
}

/// Opaque triangles that are the first at their position, largest first.
std::vector<std::uint32_t> seeds_of(const SurfaceMesh& mesh) {
  std::vector<double> area(mesh.normal.size());
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t t = 0; t < area.size(); ++t) {
    area[t] = triangle_area(mesh.scene, t);
    if (mesh.stores(t) && mesh.counts(t)) seeds.push_back(t);
  }
  std::sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
    return area[a] != area[b] ? area[a] > area[b] : a < b;
  });
  return seeds;
}

class Growth {
 public:
  Growth(const SurfaceMesh& mesh, double spacing, double angle_degrees)
      : mesh_(mesh),
        height_(spacing),
        least_cosine_(std::cos(glm::radians(std::min(largest_angle_degrees, angle_degrees))) -
                      cosine_slack),
        continuations_(continuations_of(
            mesh, surface::find_connections(mesh, spacing, angle_degrees), least_cosine_)) {
    result_.chart_of.assign(mesh.original.size(), none);
  }

  ChartGrowth grow() {
    for (const std::uint32_t triangle : seeds_of(mesh_)) {
      for (const std::uint32_t side : {0u, 1u}) grow_from(oriented(triangle, side));
    }
    return std::move(result_);
  }

 private:
  void grow_from(std::uint32_t seed) {
    if (result_.chart_of[seed] != none) return;
    const auto chart = static_cast<std::uint32_t>(result_.seed.size());
    result_.seed.push_back(seed);
    result_.chart_of[seed] = chart;
    normal_ = normal_of(mesh_, seed);
    point_ = glm::dvec3(mesh_.scene.corners(triangle_of(seed))[0]);
    members_.assign(1, seed);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const std::uint32_t member = members_[i];
      for (const std::uint32_t continuation : continuations_.of(triangle_of(member))) {
        const std::uint32_t next = continuation ^ side_of(member);
        if (result_.chart_of[next] != none || !fits(next)) continue;
        result_.chart_of[next] = chart;
        members_.push_back(next);
      }
    }
  }

  bool fits(std::uint32_t oriented_face) const {
    if (!(glm::dot(normal_of(mesh_, oriented_face), normal_) >= least_cosine_)) return false;
    for (const glm::vec3& corner : mesh_.scene.corners(triangle_of(oriented_face))) {
      if (!(std::abs(glm::dot(glm::dvec3(corner) - point_, normal_)) <= height_)) return false;
    }
    return true;
  }

  const SurfaceMesh& mesh_;
  const double height_, least_cosine_;
  const IndexRows continuations_;
  ChartGrowth result_;
  std::vector<std::uint32_t> members_;
  glm::dvec3 normal_{0.0}, point_{0.0};
};

}  // namespace

ChartGrowth grow_charts(const Scene& scene, double spacing, double angle_degrees) {
  const SurfaceMesh mesh(scene);
  ChartGrowth growth = Growth(mesh, spacing, angle_degrees).grow();
  for (std::size_t s = 0; s < growth.chart_of.size(); ++s) {
    growth.chart_of[s] = growth.chart_of[mesh.original[s]];
  }
  return growth;
}

}  // namespace photile::cache
