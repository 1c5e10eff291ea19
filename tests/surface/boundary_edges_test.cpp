// The search for edges that run along each other, beside all pairs.
#include "surface/boundary_edges.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>
#include <utility>

namespace photile::test {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;
using surface::BoundaryEdge;
using surface::BoundaryEdges;

/// Edges of 3 mm to 2 m on lines through a room, their ends up to `offset` metres beside the lines.
std::vector<BoundaryEdge> edges_on_lines(int lines, int edges_of_a_line, double offset) {
  std::mt19937 engine(7);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const auto point = [&](double size) {
    return glm::dvec3(number(-size, size), number(-size, size), number(-size, size));
  };
  std::vector<BoundaryEdge> edges;
  for (int line = 0; line < lines; ++line) {
    const glm::dvec3 origin = point(1), along = glm::normalize(point(1));
    for (int i = 0; i < edges_of_a_line; ++i) {
      const double from = number(-1, 1), length = std::pow(10, number(-2.5, 0.3));
      const double to = from + std::copysign(length, number(-1, 1));
      const auto end = [&](double t) { return glm::vec3(origin + t * along + point(offset)); };
      edges.push_back({end(from), end(to), static_cast<std::uint32_t>(edges.size())});
    }
  }
  return edges;
}

}  // namespace

TEST_CASE("edges that run along each other are found as by looking at all pairs") {
  constexpr double tolerance = 1e-3;
  for (const double offset : {0.0, 0.5e-3, 1e-3, 0.1}) {
    const std::vector<BoundaryEdge> edges = edges_on_lines(40, 20, offset);
    Pairs expected, found;
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      for (std::uint32_t j = i + 1; j < edges.size(); ++j) {
        if (surface::run_along(edges[i], edges[j], tolerance)) expected.insert({i, j});
      }
    }
    const BoundaryEdges search(edges, tolerance);
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      search.visit_along(i, [&](const BoundaryEdge& a, const BoundaryEdge& b) {
        found.insert({a.triangle, b.triangle});
      });
    }
    INFO("ends " << offset << " m beside the lines, " << expected.size() << " pairs");
    if (offset < 0.01) CHECK(expected.size() > 200);
    CHECK(found == expected);
  }
}

}  // namespace photile::test
