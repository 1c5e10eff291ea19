// Distances and boxes.
#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <vector>

#include "geometry/box_tree.hpp"
#include "groups/automatic_radius.hpp"
#include "meshes.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::test {
namespace {

// Two oracles: FCL's triangle distance, and a bracket that needs no other library. Alternating
// projections give points of both triangles, so their distance is an upper bound; the gap between
// the triangles' extents along the direction between those points is a lower bound.

double fcl_distance(const Corners& a, const Corners& b) {
  const auto convert = [](const glm::dvec3& p) { return fcl::Vector3d(p.x, p.y, p.z); };
  const fcl::Vector3d s[3] = {convert(a[0]), convert(a[1]), convert(a[2])};
  const fcl::Vector3d t[3] = {convert(b[0]), convert(b[1]), convert(b[2])};
  fcl::Vector3d p, q;
  return fcl::detail::TriangleDistance<double>::triDistance(s, t, p, q);
}

using Point = glm::tvec3<long double>;
using LongCorners = std::array<Point, 3>;

/// Nearest point of a triangle by Voronoi regions (Ericson, "Real-Time Collision
/// Detection", 5.1.5).
Point nearest_point(const Point& p, const LongCorners& t) {
  const Point ab = t[1] - t[0], ac = t[2] - t[0];
  const long double d1 = glm::dot(ab, p - t[0]), d2 = glm::dot(ac, p - t[0]);
  if (d1 <= 0 && d2 <= 0) return t[0];
  const long double d3 = glm::dot(ab, p - t[1]), d4 = glm::dot(ac, p - t[1]);
  if (d3 >= 0 && d4 <= d3) return t[1];
  const long double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + (d1 / (d1 - d3)) * ab;
  const long double d5 = glm::dot(ab, p - t[2]), d6 = glm::dot(ac, p - t[2]);
  if (d6 >= 0 && d5 <= d6) return t[2];
  const long double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + (d2 / (d2 - d6)) * ac;
  const long double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return t[1] + ((d4 - d3) / (d4 - d3 + d5 - d6)) * (t[2] - t[1]);
  }
  return t[0] + (vb / (va + vb + vc)) * ab + (vc / (va + vb + vc)) * ac;
}

struct Bracket {
  double lower, upper;
};

Bracket bracket_distance(const Corners& a, const Corners& b) {
  const LongCorners s = {Point(a[0]), Point(a[1]), Point(a[2])};
  const LongCorners t = {Point(b[0]), Point(b[1]), Point(b[2])};
  Point p = s[0], q = t[0];
  long double lower = 0, upper = glm::distance(p, q);
  for (int iteration = 0; iteration < 20'000 && upper - lower > 1e-13L; ++iteration) {
    q = nearest_point(p, t);
    p = nearest_point(q, s);
    upper = std::min(upper, glm::distance(p, q));
    if (iteration % 16 != 0 || p == q) continue;
    const Point direction = glm::normalize(q - p);
    const auto along = [&](const Point& corner) { return glm::dot(direction, corner - p); };
    const long double s_end = std::max({along(s[0]), along(s[1]), along(s[2])});
    const long double t_start = std::min({along(t[0]), along(t[1]), along(t[2])});
    lower = std::max(lower, t_start - s_end);
  }
  return {static_cast<double>(lower), static_cast<double>(upper)};
}

Corners random_triangle(Uniform& uniform, double size) {
  const glm::dvec3 a = uniform.point(-size, size), b = uniform.point(-size, size);
  return {a, b, uniform.point(-size, size)};
}

Corners moved(Corners corners, const glm::dvec3& by) {
  for (glm::dvec3& corner : corners) corner += by;
  return corners;
}

/// A triangle of length 1 and width 1e-6.
Corners needle(Uniform& uniform) {
  const glm::dvec3 start = uniform.point(-1, 1), along = uniform.direction();
  const glm::dvec3 across = glm::normalize(glm::cross(along, uniform.direction()));
  return {start, start + along, start + uniform(0, 1) * along + 1e-6 * across};
}

/// Pairs that stress one weakness each. Sizes are about 1 m.
struct Family {
  std::string name;
  std::function<std::pair<Corners, Corners>(Uniform&)> pair;
};

std::vector<Family> families() {
  return {
      {"apart or intersecting",
       [](Uniform& u) {
         const Corners a = random_triangle(u, 1);
         return std::pair{a, moved(random_triangle(u, 1), u.point(-2, 2))};
       }},
      {"sharing a corner",
       [](Uniform& u) {
         const Corners a = random_triangle(u, 1);
         Corners b = random_triangle(u, 1);
         b[0] = a[1];
         return std::pair{a, b};
       }},
      {"corner on a face",
       [](Uniform& u) {
         const Corners a = random_triangle(u, 1);
         Corners b = random_triangle(u, 1);
         const double s = u(0, 0.5), t = u(0, 0.5);
         b[0] = a[0] + s * (a[1] - a[0]) + t * (a[2] - a[0]);
         return std::pair{a, b};
       }},
      {"coplanar",
       [](Uniform& u) {
         Corners a = random_triangle(u, 1), b = moved(random_triangle(u, 1), u.point(-1, 1));
         for (int i = 0; i < 3; ++i) a[i].z = b[i].z = 0.5;
         return std::pair{a, b};
       }},
      {"in parallel planes",
       [](Uniform& u) {
         Corners a = random_triangle(u, 1), b = moved(random_triangle(u, 1), u.point(-2, 2));
         for (int i = 0; i < 3; ++i) a[i].z = 0, b[i].z = 0.125;
         return std::pair{a, b};
       }},
      {"with parallel edges",
       [](Uniform& u) {
         const Corners a = random_triangle(u, 1);
         Corners b = moved(random_triangle(u, 1), u.point(-2, 2));
         b[1] = b[0] + u(-2, 2) * (a[1] - a[0]);
         return std::pair{a, b};
       }},
      {"with nearly parallel edges",
       [](Uniform& u) {
         const Corners a = random_triangle(u, 1);
         Corners b = moved(random_triangle(u, 1), u.point(-2, 2));
         b[1] = b[0] + u(-2, 2) * (a[1] - a[0]) + 1e-8 * u.direction();
         return std::pair{a, b};
       }},
      {"needles",
       [](Uniform& u) {
         const Corners a = needle(u);
         return std::pair{a, needle(u)};
       }},
      {"a needle and a triangle",
       [](Uniform& u) {
         const Corners a = needle(u);
         return std::pair{a, random_triangle(u, 1)};
       }},
      {"a segment and a triangle",
       [](Uniform& u) {
         Corners a = random_triangle(u, 1);
         a[2] = a[1];
         return std::pair{a, random_triangle(u, 1)};
       }},
      {"a point and a triangle",
       [](Uniform& u) {
         const glm::dvec3 p = u.point(-2, 2);
         return std::pair{Corners{p, p, p}, random_triangle(u, 1)};
       }},
  };
}

TEST_CASE("triangle distance agrees with FCL on 100000 random pairs") {
  Uniform uniform(1);
  double worst = 0;
  int intersecting = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Corners a = random_triangle(uniform, 1);
    const Corners b = moved(random_triangle(uniform, 1), uniform.point(-1, 1));
    const double found = triangle_triangle_distance(a, b);
    intersecting += found == 0;
    worst = std::max(worst, std::abs(found - fcl_distance(a, b)));
  }
  CHECK(worst < 1e-12);
  CHECK(intersecting > 1'000);  // both cases are met
  CHECK(intersecting < 99'000);
}

TEST_CASE("triangle distance lies in its bracket for every family of adversarial pairs") {
  for (const Family& family : families()) {
    Uniform uniform(2);
    double worst = 0;
    int tight = 0;
    constexpr int pairs = 1'000;
    for (int i = 0; i < pairs; ++i) {
      const auto [a, b] = family.pair(uniform);
      const double found = triangle_triangle_distance(a, b);
      const Bracket bracket = bracket_distance(a, b);
      tight += bracket.upper - bracket.lower < 1e-6;
      worst = std::max({worst, bracket.lower - found, found - bracket.upper});
    }
    INFO(family.name);
    CHECK(worst < 1e-13);
    CHECK(tight > pairs * 9 / 10);
  }
}

TEST_CASE("triangle distance is symmetric and does not depend on the order of corners") {
  for (const Family& family : families()) {
    Uniform uniform(3);
    double worst = 0;
    for (int i = 0; i < 1'000; ++i) {
      const auto [a, b] = family.pair(uniform);
      const double found = triangle_triangle_distance(a, b);
      worst = std::max({worst, std::abs(found - triangle_triangle_distance(b, a)),
                        std::abs(found - triangle_triangle_distance({a[2], a[0], a[1]}, b)),
                        std::abs(found - triangle_triangle_distance(a, {b[1], b[0], b[2]}))});
    }
    INFO(family.name);
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("triangle distance keeps its precision 100 km from the origin") {
  const glm::dvec3 offset(100'000, -100'000, 65'536);
  Uniform uniform(4);
  for (int i = 0; i < 1'000; ++i) {
    // Corners on a lattice of 2^-10 m: moving them by the offset is exact.
    Corners a = random_triangle(uniform, 1024), b = random_triangle(uniform, 1024);
    for (int j = 0; j < 3; ++j) a[j] = glm::floor(a[j]) / 1024.0, b[j] = glm::floor(b[j]) / 1024.0;
    const double near = triangle_triangle_distance(a, b);
    CHECK(triangle_triangle_distance(moved(a, offset), moved(b, offset)) ==
          Approx(near).margin(1e-13));
  }
}

TEST_CASE("triangle distance equals known answers") {
  const Corners a = {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)};
  // Face above face, corner above face, edge beside edge, corner beside corner.
  CHECK(triangle_triangle_distance(a, moved(a, {0.1, 0.1, 2})) == 2);
  CHECK(triangle_triangle_distance(a, {{{0.25, 0.25, 3}, {9, 9, 9}, {-9, 9, 9}}}) == 3);
  CHECK(triangle_triangle_distance(a, {{{-4, 0.25, 0}, {-4, 0.5, 0}, {-9, 0, 5}}}) == 4);
  CHECK(triangle_triangle_distance(a, moved(a, {4, 4, 0})) == Approx(std::sqrt(3.5 * 3.5 * 2)));
  CHECK(triangle_triangle_distance(a, {{{-3, -4, 0}, {-9, -9, 1}, {-9, -9, -1}}}) == 5);
  // Crossed edges: one runs along x at height 0, the other along y at height 1 / 2.
  CHECK(triangle_triangle_distance({{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}}},
                                   {{{0, -1, 0.5}, {0, 1, 0.5}, {0, 0, 2}}}) == 0.5);
  // Pierced, touching, overlapping in a plane, one inside the other, identical.
  CHECK(triangle_triangle_distance(a, {{{0.2, 0.2, -1}, {0.2, 0.3, 1}, {0.3, 0.2, 1}}}) == 0);
  CHECK(triangle_triangle_distance(a, {{{0.25, 0.25, 0}, {0, 0, 1}, {1, 0, 1}}}) == 0);
  CHECK(triangle_triangle_distance(a, moved(a, {0.25, 0.25, 0})) == 0);
  CHECK(triangle_triangle_distance(a, {{{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}}}) == 0);
  CHECK(triangle_triangle_distance(a, a) == 0);
}

// Boxes near a box, against a look at each.

std::vector<geometry::Box> random_boxes(std::size_t count, Uniform& uniform) {
  std::vector<geometry::Box> boxes(count);
  for (geometry::Box& box : boxes) {
    const glm::vec3 corner(uniform.point(0, 1));
    box.extend(corner);
    box.extend(corner + glm::vec3(uniform.point(0, 0.1)));
  }
  return boxes;
}

TEST_CASE("a tree visits every box within the distance, each once") {
  const std::size_t count = GENERATE(1u, 2u, 5u, 100u, 20'000u);  // the last is built in parallel
  Uniform uniform(count);
  std::vector<geometry::Box> boxes = random_boxes(count, uniform);
  if (count == 100) boxes.assign(count, boxes.front());  // all in one place
  const geometry::BoxTree tree(boxes);
  for (const geometry::Box& query : random_boxes(50, uniform)) {
    constexpr float limit = 0.01f;
    std::vector<int> visits(count, 0);
    tree.visit_within(query, limit, [&](std::uint32_t box) {
      ++visits[box];
      return false;
    });
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const bool near = geometry::squared_distance(boxes[i], query) <= limit;
      if (visits[i] > 1 || (near && visits[i] == 0)) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a tree visits the boxes that overlap one, each once, and no others") {
  const std::size_t count = GENERATE(0u, 1u, 5u, 20'000u);
  Uniform uniform(count);
  const std::vector<geometry::Box> boxes = random_boxes(count, uniform);
  const geometry::BoxTree tree(boxes);
  std::vector<geometry::Box> queries = random_boxes(50, uniform);
  if (count > 0) queries.push_back(boxes.front());
  std::size_t wrong = 0, met = 0;
  for (const geometry::Box& query : queries) {
    std::vector<int> visits(count, 0);
    tree.visit_overlapping(boxes, query, [&](std::uint32_t box) { ++visits[box]; });
    for (std::size_t i = 0; i < count; ++i) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        apart = apart || boxes[i].upper[axis] < query.lower[axis] ||
                query.upper[axis] < boxes[i].lower[axis];
      }
      if (visits[i] != (apart ? 0 : 1)) ++wrong;
      if (!apart) ++met;
    }
  }
  CHECK(wrong == 0);
  CHECK((met > 0) == (count > 0));
}

TEST_CASE("a tree without boxes visits none, and a visit that returns true is the last") {
  int visits = 0;
  const auto stop = [&](std::uint32_t) { return ++visits > 0; };
  geometry::Box everywhere;
  everywhere.extend(glm::vec3(-1e6f));
  everywhere.extend(glm::vec3(1e6f));
  geometry::BoxTree(std::vector<geometry::Box>{}).visit_within(everywhere, 1, stop);
  CHECK(visits == 0);
  Uniform uniform(1);
  geometry::BoxTree(random_boxes(30, uniform)).visit_within(everywhere, 1, stop);
  CHECK(visits == 1);
}

// Distances to the m-th nearest photon, against all distances sorted.

/// Sheets, a dense lump, points that coincide, and one far away.
std::vector<glm::vec3> uneven_positions(std::size_t count) {
  Uniform uniform(count);
  std::vector<glm::vec3> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 point(uniform.point(0, 4));
    positions.push_back(i % 4 == 0   ? glm::vec3(point.x, point.y, 0)
                        : i % 4 == 1 ? glm::vec3(0, point.y, point.z)
                        : i % 4 == 2 ? glm::vec3(1) + 1e-3f * point
                                     : glm::vec3(2, 3, 0));
  }
  positions.back() = glm::vec3(1e4f);
  return positions;
}

TEST_CASE("the m-th nearest photon is that of all distances sorted") {
  const std::size_t count = GENERATE(2u, 31u, 1000u, 20'000u);
  const std::vector<glm::vec3> positions = uneven_positions(count);
  const groups::PhotonBlocks blocks(positions, count);
  REQUIRE(blocks.size() == count);
  std::vector<float> scratch;
  for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / 50)) {
    std::vector<double> squared;
    for (const glm::vec3& position : positions) {
      const glm::dvec3 offset = glm::dvec3(position) - glm::dvec3(positions[i]);
      squared.push_back(glm::dot(offset, offset));
    }
    std::sort(squared.begin(), squared.end());
    for (const std::size_t m : {std::size_t{1}, count / 20, count / 2, count - 1}) {
      CAPTURE(count, i, m);
      CHECK(blocks.squared_distance(i, m, scratch) == Approx(squared[m]).epsilon(1e-5));
    }
  }
}

TEST_CASE("of more positions than requested those in equal steps are taken") {
  std::vector<glm::vec3> positions;
  for (int i = 0; i < 100; ++i) positions.emplace_back(i, 0, 0);
  const groups::PhotonBlocks blocks(positions, 10);  // 5, 15, ... 95
  CHECK(blocks.size() == 10);
  std::vector<float> scratch;
  CHECK(blocks.squared_distance(0, 1, scratch) == 100);
  CHECK(blocks.squared_distance(9, 9, scratch) == 8100);
}

}  // namespace
}  // namespace photile::test
