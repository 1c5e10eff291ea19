// Which triangles share a chart, and which point of the surface a node stands for.
#include "cache/charts.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "test_scenes.hpp"

namespace photile::test {

using cache::Charts;

namespace {

std::set<std::uint32_t> charts_of(const Charts& charts) {
  return {charts.chart_of().begin(), charts.chart_of().end()};
}

glm::dvec3 point_of(const Scene& scene, const Charts::Support& support) {
  const auto [a, b, c] = scene.corners(support.where.triangle);
  return glm::dvec3(a) + double{support.where.u} * glm::dvec3(b - a) +
         double{support.where.v} * glm::dvec3(c - a);
}

Scene below_a_lamp(SceneBuilder& builder) {
  builder.add(point_light("lamp", {0, 0, 1}));
  return builder.build();
}

}  // namespace

TEST_CASE("A wall is one chart a side, however finely it is cut") {
  for (const int cells : {1, 7}) {
    const Scene box = closed_box(diffuse(0.5f), cells);
    const Charts charts(box, 0.04, 60);
    CHECK(charts.size() == 12);  // six walls, inside and outside
    for (std::uint32_t t = 0; t < box.triangle_count(); ++t) {
      CHECK(charts.chart_of()[oriented(t, 0)] != charts.chart_of()[oriented(t, 1)]);
    }
  }
}

TEST_CASE("Tiles that touch along edges only share a chart") {
  // A wide tile beside two narrow ones: no two share both corners of an edge.
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({1, 0, 0}, {1, 0, 0}, {0, 0.4f, 0}, 1, white);
  builder.grid({1, 0.4f, 0}, {1, 0, 0}, {0, 0.6f, 0}, 1, white);
  CHECK(Charts(below_a_lamp(builder), 0.04, 60).size() == 2);
}

TEST_CASE("Plates that lie on each other have charts of their own") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, white);
  builder.grid({0.2f, 0.2f, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}, 1, white);
  builder.grid({0, 0, 0.001f}, {1, 0, 0}, {0, 1, 0}, 2, white);
  CHECK(charts_of(Charts(below_a_lamp(builder), 0.04, 60)).size() == 6);
}

TEST_CASE("Mirrors and glass have no chart") {
  const Scene scene = plate(mirror(1.0f), 1.0f);
  CHECK(charts_of(Charts(scene, 0.04, 60)) == std::set<std::uint32_t>{none});
}

TEST_CASE("The corners of a rectangle are nodes, and so are places on it") {
  SceneBuilder builder;
  // Turned, of no whole number of cells.
  const glm::vec3 u = 1.13f * glm::normalize(glm::vec3(0.6f, 0.8f, 0.1f));
  const glm::vec3 v = 0.57f * glm::normalize(glm::cross(u, glm::vec3(0.3f, 0.1f, 0.9f)));
  const glm::vec3 origin(2, 1, 0.5f);
  builder.grid(origin, u, v, 3, builder.add(diffuse(0.5f)));
  const Scene scene = below_a_lamp(builder);
  Charts charts(scene, 0.04, 60);
  constexpr int levels = 4;
  // Within a corner a node lies farther off than from an edge.
  constexpr double inset = 6 * defaults::node_inset * 0.04 / 8;
  for (std::uint32_t i = 0; i < charts.size(); ++i) {
    const cache::Chart& chart = charts[i];
    CHECK(chart.columns * chart.rows == 29 * 15);
    charts.prepare(i);
    const std::uint32_t last_x = chart.columns << (levels - 1), last_y = chart.rows << (levels - 1);
    std::set<int> met;
    for (const std::uint32_t x : {0u, last_x}) {
      for (const std::uint32_t y : {0u, last_y}) {
        const glm::dvec3 point = point_of(scene, charts.support({i, x, y}, levels));
        int corner = 0;
        for (const glm::vec3& expected : {origin, origin + u, origin + v, origin + u + v}) {
          if (glm::length(point - glm::dvec3(expected)) < inset) met.insert(corner);
          ++corner;
        }
      }
    }
    CHECK(met.size() == 4);
    // A node within: the point of the plane below it.
    const Charts::Support support = charts.support({i, 101, 40}, levels);
    const glm::dvec3 position = chart.origin + 101.0 / 8 * chart.spacing.x * chart.across +
                                40.0 / 8 * chart.spacing.y * chart.along;
    CHECK(glm::length(point_of(scene, support) - position) < 1.5 * inset / 6);
    CHECK(charts.chart_of()[oriented(support.where.triangle, support.side)] == i);
  }
}

TEST_CASE("A node beyond an edge stands for the nearest point of the edge") {
  // A right triangle: the far half of its rectangle has no surface.
  SceneBuilder builder;
  builder.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.add(diffuse(0.5f)));
  const Scene scene = below_a_lamp(builder);
  Charts charts(scene, 0.04, 60);
  for (std::uint32_t i = 0; i < charts.size(); ++i) {
    charts.prepare(i);
    const cache::Chart& chart = charts[i];
    for (std::uint32_t x = 0; x <= chart.columns; ++x) {
      for (std::uint32_t y = 0; y <= chart.rows; ++y) {
        const glm::dvec3 position =
            chart.origin + x * chart.spacing.x * chart.across + y * chart.spacing.y * chart.along;
        // The nearest point of the triangle x, y >= 0, x + y <= 1, by cases.
        glm::dvec2 p = glm::max(glm::dvec2(position), 0.0);
        if (position.x + position.y > 1) {
          const double t = glm::clamp(0.5 * (1 + position.x - position.y), 0.0, 1.0);
          p = {t, 1 - t};
        }
        const glm::dvec3 point = point_of(scene, charts.support({i, x, y}, 1));
        const double off = glm::length(point - glm::dvec3(p, 0.0));
        REQUIRE(off < 4 * defaults::node_inset * 0.04);
        // Nodes at the edge are within it.
        REQUIRE(std::min({point.x, point.y, (1 - point.x - point.y) / std::sqrt(2.0)}) >
                0.4 * defaults::node_inset * std::min(chart.spacing.x, chart.spacing.y));
      }
    }
  }
}

TEST_CASE("Owners in charts of many triangles are those that looking at all finds") {
  // A wavy sheet: charts of many triangles, none of them flat.
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  const auto at = [](int i, int j) {
    const double x = 0.031 * i, y = 0.023 * j;
    return glm::vec3(x, y, 0.01 * std::sin(9 * x) * std::cos(7 * y));
  };
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j)
      builder.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), white);
  }
  const Scene scene = below_a_lamp(builder);
  Charts with_trees(scene, 0.04, 60);
  const Charts without(scene, 0.04, 60);
  for (std::uint32_t i = 0; i < with_trees.size(); ++i) {
    with_trees.prepare(i);
    const cache::Chart& chart = with_trees[i];
    for (std::uint32_t x = 0; x <= 8 * chart.columns; x += 3) {
      for (std::uint32_t y = 0; y <= 8 * chart.rows; y += 5) {
        const auto a = with_trees.support({i, x, y}, 4), b = without.support({i, x, y}, 4);
        REQUIRE(a.where.triangle == b.where.triangle);
        REQUIRE(a.where.u == b.where.u);
        REQUIRE(a.where.v == b.where.v);
        REQUIRE(a.side == b.side);
      }
    }
  }
}

}  // namespace photile::test
