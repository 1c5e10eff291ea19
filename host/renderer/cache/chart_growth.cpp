#include <tsl/robin_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "cache/charts.hpp"
#include "surface/sheets.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::cache {
namespace {

using surface::MeshEdge;
using surface::SurfaceMesh;

/// Largest angle between the normal of a chart and those of its triangles, and of a fold within
/// it: the projection on the chart's plane keeps lengths to 6%.
constexpr double largest_angle_degrees = 20;

/// Edges that more triangles share than this join nothing: all pairs of them would be too many.
constexpr std::size_t most_triangles_of_edge = 8;

/// Sided triangles that continue each other over an edge, in compressed sparse rows by the sided
/// triangle on side 0.
struct Continuations {
  std::vector<std::uint32_t> first, next;
};

Continuations continuations_of(const SurfaceMesh& mesh, double least_cosine) {
  struct Link {
    std::uint32_t from, to;  ///< triangle, sided triangle that continues its side 0
  };
  std::vector<Link> links;
  mesh.for_each_edge([&](std::span<const MeshEdge> edges) {
    if (edges.size() > most_triangles_of_edge) return;
    for (const MeshEdge& a : edges) {
      for (const MeshEdge& b : edges) {
        if (&a == &b || !(surface::fold_cosine(mesh, a, b) >= least_cosine)) continue;
        links.push_back({a.triangle, sided(b.triangle, surface::flip_between(a, b))});
      }
    }
  });
  Continuations result;
  result.first.assign(mesh.corner.size() + 1, 0);
  result.next.resize(links.size());
  for (const Link& link : links) ++result.first[link.from + 1];
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  std::vector<std::uint32_t> place(result.first.begin(), result.first.end() - 1);
  for (const Link& link : links) result.next[place[link.from]++] = link.to;
  return result;
}

glm::dvec3 normal_of(const SurfaceMesh& mesh, std::uint32_t sided_triangle) {
  const glm::dvec3& normal = mesh.normal[triangle_of(sided_triangle)];
  return side_of(sided_triangle) == 0 ? normal : -normal;
}

/// Opaque triangles that are the first at their place, largest first.
std::vector<std::uint32_t> seeds_of(const SurfaceMesh& mesh) {
  std::vector<double> area(mesh.corner.size());
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
                      1e-6),
        continuations_(continuations_of(mesh, least_cosine_)) {
    result_.chart_of.assign(mesh.original.size(), none);
  }

  ChartGrowth grow() {
    for (const std::uint32_t triangle : seeds_of(mesh_)) {
      for (const std::uint32_t side : {0u, 1u}) grow_from(sided(triangle, side));
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
      const std::uint32_t member = members_[i], triangle = triangle_of(member);
      for (std::uint32_t j = continuations_.first[triangle]; j < continuations_.first[triangle + 1];
           ++j) {
        const std::uint32_t next = continuations_.next[j] ^ side_of(member);
        if (result_.chart_of[next] != none || !fits(next)) continue;
        result_.chart_of[next] = chart;
        members_.push_back(next);
      }
    }
  }

  bool fits(std::uint32_t sided_triangle) const {
    if (!(glm::dot(normal_of(mesh_, sided_triangle), normal_) >= least_cosine_)) return false;
    for (const glm::vec3& corner : mesh_.scene.corners(triangle_of(sided_triangle))) {
      if (!(std::abs(glm::dot(glm::dvec3(corner) - point_, normal_)) <= height_)) return false;
    }
    return true;
  }

  const SurfaceMesh& mesh_;
  const double height_, least_cosine_;
  const Continuations continuations_;
  ChartGrowth result_;
  std::vector<std::uint32_t> members_;
  glm::dvec3 normal_{0.0}, point_{0.0};
};

/// A sheet and a plane, rounded: two planes that differ by rounding have the same but for the few
/// that lie at a border, whose charts stay apart.
using Plane = std::array<std::int64_t, 5>;

struct PlaneHash {
  std::size_t operator()(const Plane& plane) const {
    std::uint64_t hash = 0;
    for (const std::int64_t part : plane) {
      hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9E3779B97F4A7C15ull;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Joins charts of one sheet in one plane.
void join_tiles(const SurfaceMesh& mesh, const surface::Sheets& sheets, double spacing,
                ChartGrowth& growth) {
  // No round numbers, for modellers place planes at those.
  constexpr double normal_steps = 1037.13;
  const double height_steps = 40.37 / spacing;
  tsl::robin_map<Plane, std::uint32_t, PlaneHash> chart_of_plane;
  std::vector<std::uint32_t> joined, seed;
  for (const std::uint32_t s : growth.seed) {
    const glm::dvec3 normal = normal_of(mesh, s);
    const glm::dvec3 point(mesh.scene.corners(triangle_of(s))[0]);
    const glm::dvec3 rounded = glm::round(normal * normal_steps);
    const Plane plane{sheets.of[s], std::llround(rounded.x), std::llround(rounded.y),
                      std::llround(rounded.z),
                      std::llround(glm::dot(point, normal) * height_steps)};
    const auto [entry, is_new] =
        chart_of_plane.insert({plane, static_cast<std::uint32_t>(seed.size())});
    if (is_new) seed.push_back(s);
    joined.push_back(entry->second);
  }
  for (std::uint32_t& chart : growth.chart_of) {
    if (chart != none) chart = joined[chart];
  }
  growth.seed = std::move(seed);
}

}  // namespace

ChartGrowth grow_charts(const Scene& scene, double spacing, double angle_degrees) {
  const SurfaceMesh mesh(scene);
  ChartGrowth growth = Growth(mesh, spacing, angle_degrees).grow();
  join_tiles(mesh, surface::find_sheets(mesh, spacing, angle_degrees), spacing, growth);
  for (std::size_t s = 0; s < growth.chart_of.size(); ++s) {
    growth.chart_of[s] = growth.chart_of[mesh.original[s]];
  }
  return growth;
}

}  // namespace photile::cache
