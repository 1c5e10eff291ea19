// Which parts of a surface light reaches.
#include <catch2/catch.hpp>
#include <map>
#include <utility>

#include "geometry/disjoint_sets.hpp"
#include "photile/device/surface.h"
#include "photile/surface_index.hpp"
#include "photon_sets.hpp"
#include "surface/boundary_edges.hpp"
#include "surface/coplanar_regions.hpp"
#include "surface/smooth_components.hpp"
#include "surface/unlit_sides.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;
using surface::BoundaryEdge;
using surface::BoundaryEdges;

// Parts of lit triangles that no photon reaches.

/// In the plane z = 0; the right angle comes first.
using Isosceles = std::array<glm::vec3, 3>;

glm::vec3 middle_of(const Isosceles& t) { return (t[0] + t[1] + t[2]) / 3.0f; }

std::array<Isosceles, 2> halves_of(const Isosceles& t) {
  const glm::vec3 foot = 0.5f * (t[1] + t[2]);
  return {{{foot, t[0], t[1]}, {foot, t[2], t[0]}}};
}

/// One photon in each of 2^depth equal parts.
void spread(const Isosceles& t, int depth, Photons& photons) {
  if (depth == 0) {
    photons.position.push_back(middle_of(t));
    return;
  }
  for (const Isosceles& half : halves_of(t)) spread(half, depth - 1, photons);
}

TEST_CASE("ten photons on a half tell that a half of it is dark, by chance one time in 500") {
  const Isosceles whole{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  const auto [bright, dim] = halves_of(whole);
  const auto [lit, dark] = halves_of(dim);
  Scene scene = empty_scene();
  add_triangle(scene, whole[0], whole[1], whole[2]);
  const glm::vec3 above(0, 0, 1);
  add_triangle(scene, whole[0] + above, whole[1] + above, whole[2] + above);
  const surface::SurfaceMesh mesh(scene);
  for (const std::uint32_t on_lit : {9u, 10u}) {
    Photons photons;
    spread(bright, 6, photons);
    photons.position.insert(photons.position.end(), on_lit, middle_of(lit));
    // The next photon lies over the unlit region, on the other triangle.
    const std::uint32_t own = 64 + on_lit;
    photons.position.push_back(middle_of(dark) + above);
    photons.first_of = {0, own, own, own + 1, own + 1};
    const auto parts =
        surface::find_unlit_regions(mesh, photons, std::vector<std::uint8_t>(4, 0), {}, 0.05);
    CAPTURE(on_lit);
    REQUIRE(parts.size() == (on_lit == 10 ? 1 : 0));
    for (const DarkPart& part : parts) {
      CHECK(part.oriented_face == 0);
      CHECK(glm::distance(middle_of(part.corner), middle_of(dark)) < 1e-6f);
    }
  }
}

TEST_CASE("of hundreds of unlit regions the one is found that a hit lies in") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {2, 0.3f, 0.1f}, {0.2f, 2, 0.7f}, 1}});
  const Photons everywhere = uniform_photons(scene, 100'000, 67, false);
  Photons photons;
  std::mt19937_64 random(68);
  for (std::size_t i = 0; i < everywhere.size(); ++i) {
    const glm::vec3& p = everywhere.position[i];
    const bool in_a_square = std::sin(20 * p.x) > 0 && std::sin(20 * p.y) > 0;
    if (in_a_square) add_photon(photons, scene, p, everywhere.oriented_face[i], random);
  }
  photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
  const SurfaceIndex index = index_surface(scene, photons, 0.05, 60);
  REQUIRE(index.unlit_regions.size() >= 200);
  const PrimaryHits hits = uniform_hits(scene, 2000, 69, false);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::uint32_t own = hits.oriented_face[i];
    const glm::dvec3 normal(face_normal(scene, own)), hit(hits.position[i]);
    const auto holds_hit = [&](const DarkPart& part) {
      double least = 1, greatest = -1;
      for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec3 from(part.corner[c]), to(part.corner[(c + 1) % 3]);
        const double left = glm::dot(normal, glm::cross(to - from, hit - from));
        least = std::min(least, left);
        greatest = std::max(greatest, left);
      }
      return part.oriented_face == own && (least >= 0 || greatest <= 0);
    };
    const bool expected =
        std::any_of(index.unlit_regions.begin(), index.unlit_regions.end(), holds_hit);
    CAPTURE(i);
    CHECK((index.component_at(own, hits.position[i]) == PHOTILE_UNLIT_REGION) == expected);
    dark += expected ? 1 : 0;
  }
  CHECK(dark >= 500);
  for (const DarkPart& part : index.unlit_regions) {
    for (const glm::vec3& corner : part.corner) {
      CHECK(index.component_at(part.oriented_face, corner) == PHOTILE_UNLIT_REGION);
    }
  }
}

// Sides that no photon reaches, by what their component lets expect.

/// The unlit sides of a plate of 200 equal triangles, where so many photons landed on the front of
/// each triangle, and none on the first ones.
std::vector<std::uint32_t> unlit_sides(std::uint32_t on_each, std::uint32_t empty) {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 10}});
  const surface::SurfaceMesh mesh(scene);
  std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
  for (std::uint32_t t = empty; t < scene.triangle_count(); ++t) landed[oriented(t, 0)] = on_each;
  const auto connections = surface::find_connections(mesh, 0.1, 60);
  const auto dark = surface::find_unlit_sides(mesh, connections,
                                              surface::join_components(mesh, connections), landed);
  std::vector<std::uint32_t> found;
  for (std::uint32_t s = 0; s < dark.size(); ++s) {
    if (dark[s] != 0) found.push_back(s);
  }
  return found;
}

TEST_CASE("sides are dark together where 40 photons are expected and none landed") {
  std::vector<std::uint32_t> first_row;
  for (std::uint32_t t = 0; t < 20; ++t) first_row.push_back(oriented(t, 0));
  CHECK(unlit_sides(20, 20) == first_row);  // 18 expected on each
  CHECK(unlit_sides(5, 20).empty());        // 4.5 on each: too few to tell
  CHECK(unlit_sides(50, 1) == std::vector<std::uint32_t>{0});
  CHECK(unlit_sides(20, 1).empty());  // 19.9, and no neighbour that is dark as well
}

// How much of lit surface lies open under what lies on it.

constexpr double radius = 0.1;

/// A floor of 1 x 1 m under tiles of 0.1 m, `side` wide and `thickness` above it.
Scene tiled_floor(float side, float thickness) {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const glm::vec3 corner(0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), 1e-4f);
      builder.box(corner, corner + glm::vec3(side, side, thickness), white, false);
    }
  }
  return builder.build();
}

/// The floor's upper side, where photons landed on all that looks up, or on nothing else.
float floor_exposure(const Scene& scene, bool tiles_lit) {
  std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
  std::uint32_t floor = none;
  for (std::uint32_t s = 0; s < landed.size(); ++s) {
    const bool is_floor = triangle_of(s) < 2;
    landed[s] = face_normal(scene, s).z > 0.9 && (is_floor || tiles_lit);
    if (is_floor && landed[s] != 0 && floor == none) floor = s;
  }
  return index_surface(scene, landed, radius, 60).open_fraction[floor];
}

TEST_CASE("a floor under tiles lies open in the joints") {
  // Joints take 1 - 0.95^2 = 9.75% of the floor, of which 64 points tell within a few hundredths.
  CHECK(floor_exposure(tiled_floor(0.095f, 0.005f), true) == Approx(0.0975).margin(0.08));
}

TEST_CASE("a floor that is covered by less than half counts as open") {
  CHECK(floor_exposure(tiled_floor(0.06f, 0.005f), true) == 1.0f);
}

TEST_CASE("what is higher than a fifth of the radius, or lit from below, covers nothing") {
  const auto open_fraction = [](float height, bool lit_below) {
    SceneBuilder room;
    const std::uint32_t white = room.add(diffuse(0.5f));
    room.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
    room.grid({0, 0, height}, {1, 0, 0}, {0, 1, 0}, 1, white);
    const Scene scene = room.build();
    std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
    for (std::uint32_t s = 0; s < landed.size(); ++s) {
      landed[s] = lit_below || face_normal(scene, s).z > 0;
    }
    const SurfaceIndex index = index_surface(scene, landed, radius, 60);
    float least = 1;
    for (const float one : index.open_fraction) least = std::min(least, one);
    return least;
  };
  CHECK(open_fraction(0.015f, false) == 0.0f);
  CHECK(open_fraction(0.025f, false) == 1.0f);
  CHECK(open_fraction(0.015f, true) == 1.0f);
}

// The search for edges that run along each other, beside all pairs.

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

TEST_CASE("of thousands of edges in one place each meets no more than it may") {
  constexpr int count = 3'000;
  const BoundaryEdges search(edges_on_lines(1, count, 0), 1e-3);
  const BoundaryEdges bundle(std::vector<BoundaryEdge>(count, {{0, 0, 0}, {1, 2, 3}, 0}), 1e-3);
  for (const BoundaryEdges* edges : {&search, &bundle}) {
    int visits = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      edges->visit_along(i, [&](const BoundaryEdge&, const BoundaryEdge&) { ++visits; });
    }
    CHECK(visits > count);  // all pairs: 4,498,500
    CHECK(visits <= 2 * count * BoundaryEdges::most_along);
  }
}

// What belongs to one component of surface, and what light reaches with it.

constexpr double sheet_radius = 0.1;

surface::SmoothComponents components_of(const Scene& scene, double angle = 60) {
  return surface::find_smooth_components(surface::SurfaceMesh(scene), sheet_radius, angle);
}

/// Smooth components of the sides that look along +z.
std::set<std::uint32_t> sheets_facing_up(const Scene& scene) {
  const surface::SmoothComponents components = components_of(scene);
  std::set<std::uint32_t> found;
  for (std::uint32_t s = 0; s < components.of.size(); ++s) {
    if (face_normal(scene, s).z > 0.9) found.insert(components.of[s]);
  }
  return found;
}

TEST_CASE("a plate of any triangulation has two components, its sides") {
  for (const int cells : {1, 5}) {
    const Scene scene = plate(diffuse(0.5f), 1.0f, cells);
    const surface::SmoothComponents components = components_of(scene);
    CHECK(components.count == 2);
    CHECK(sheets_facing_up(scene).size() == 1);
  }
}

TEST_CASE("a box has twelve components, and two where its edges do not part them") {
  SceneBuilder builder;
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(diffuse(0.5f)), false, 3);
  const Scene scene = builder.build();
  CHECK(components_of(scene, 60).count == 12);
  CHECK(components_of(scene, 91).count == 2);
}

TEST_CASE("components of a curved surface follow it round, however its triangles are wound") {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 24, 16);
  CHECK(components_of(scene).count == 2);
  // Corners in another order turn a triangle's sides over.
  for (std::size_t t = 0; t < scene.triangle_count(); t += 3) {
    std::swap(scene.triangles[t].y, scene.triangles[t].z);
  }
  CHECK(components_of(scene).count == 2);
}

/// Triangles round one edge, at random or at even angles, half of them wound the other way.
Scene fan(int count, bool random) {
  std::mt19937 engine(3);
  Scene scene = empty_scene();
  for (int i = 0; i < count; ++i) {
    const double share =
        random ? std::uniform_real_distribution<double>(0, 1)(engine) : double(i) / count;
    const double turn = 2 * glm::pi<double>() * share;
    const glm::vec3 tip(std::cos(turn), std::sin(turn), 0.1);
    const glm::vec3 low(0, 0, -1), high(0, 0, 1);
    if (engine() % 2 == 0) {
      add_triangle(scene, low, high, tip);
    } else {
      add_triangle(scene, high, low, tip);
    }
  }
  return scene;
}

TEST_CASE("the blades of a fan are joined as by all pairs, of which few are looked at") {
  for (const int count : {65, 80, 300}) {
    for (const bool random : {false, true}) {
      const Scene scene = fan(count, random);
      const surface::SurfaceMesh mesh(scene);
      for (const double angle : {0.5, 2.0, 5.0, 20.0, 60.0, 120.0}) {
        CAPTURE(count, random, angle);
        geometry::DisjointSets pairs(2 * scene.triangle_count());
        for (const surface::MeshEdge& a : mesh.edges) {
          for (const surface::MeshEdge& b : mesh.edges) {
            if (a.triangle == b.triangle || a.low != b.low || a.high != b.high) continue;
            if (!(surface::fold_cosine(mesh, a, b) >= std::cos(glm::radians(angle)) - 1e-6)) {
              continue;
            }
            for (const std::uint32_t side : {0u, 1u}) {
              pairs.join(oriented(a.triangle, side),
                         oriented(b.triangle, side ^ surface::flip_between(a, b)));
            }
          }
        }
        std::map<std::uint32_t, std::uint32_t> component_of;
        const surface::SmoothComponents components = components_of(scene, angle);
        bool same = true;
        for (std::uint32_t s = 0; s < components.of.size(); ++s) {
          same &= component_of.try_emplace(pairs.find(s), components.of[s]).first->second ==
                  components.of[s];
        }
        CHECK(same);
        CHECK(component_of.size() == components.count);
      }
      CHECK(surface::find_connections(mesh, sheet_radius, 60).size() <= 8 * scene.triangle_count());
    }
  }
}

TEST_CASE("coplanar pieces that touch make one component without a common corner") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({1, 0.2f, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);  // as tiles are laid
  CHECK(sheets_facing_up(builder.build()).size() == 1);
  builder.grid({2.5f, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);  // half a metre beyond
  CHECK(sheets_facing_up(builder.build()).size() == 2);
}

TEST_CASE("wherever they lie, pieces connect along a longer edge, and not beyond its end") {
  for (const float shift : {-3.0f, 0.0f, 3.0f}) {
    const auto components_beside = [&](float from, float to) {
      SceneBuilder builder;
      const std::uint32_t white = builder.add(diffuse(0.5f));
      builder.grid({0, shift, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
      builder.grid({1, shift + from, 0}, {1, 0, 0}, {0, to - from, 0}, 1, white);
      return sheets_facing_up(builder.build()).size();
    };
    CAPTURE(shift);
    CHECK(components_beside(-0.5f, 1.5f) == 1);
    CHECK(components_beside(1.5f, 2.5f) == 2);
  }
}

TEST_CASE("pieces that overlap in a plane stay apart") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 0.5f, 0}, 1, white);  // from the same edge on
  CHECK(sheets_facing_up(builder.build()).size() == 2);
}

TEST_CASE("mirrors are no part of the components of what is round them") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  const std::uint32_t silver = builder.add(mirror(0.9f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, silver);
  CHECK(sheets_facing_up(builder.build()).size() == 2);
}

TEST_CASE("of coincident triangles the first stands for all, on the side that looks as they do") {
  Scene scene = empty_scene();
  add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(scene, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});  // wound the other way
  add_triangle(scene, {1, 0, 0}, {0, 1, 0}, {0, 0, 0});
  const surface::SurfaceMesh mesh(scene);
  CHECK(mesh.original == std::vector<std::uint32_t>{0, 1, 1, 0, 0, 1});
}

// Coplanar regions: their extent, and the edges that bound them.

double border_length(const surface::CoplanarRegions& regions) {
  double length = 0;
  for (const surface::BorderEdge& edge : regions.borders)
    length += glm::distance(edge.from, edge.to);
  return length;
}

TEST_CASE("a plate is one region, bounded by its outline, for any triangulation") {
  for (const int cells : {1, 3, 20}) {
    const Scene scene = plate(diffuse(0.5f), 1.0f, cells);
    const surface::CoplanarRegions regions =
        surface::find_coplanar_regions(surface::SurfaceMesh(scene), 0.1);
    const std::set<std::uint32_t> numbers(regions.of_triangle.begin(), regions.of_triangle.end());
    CHECK(numbers.size() == 1);
    CHECK(numbers.count(PHOTILE_NO_REGION) == 0);
    CHECK(regions.borders.size() == static_cast<std::size_t>(4 * cells));
    CHECK(border_length(regions) == Approx(4.0));
    for (const surface::BorderEdge& edge : regions.borders) {
      const glm::vec3 middle = 0.5f * (edge.from + edge.to);
      CHECK(glm::length(edge.inward) == Approx(1.0));
      CHECK(glm::dot(edge.inward, middle) == Approx(-0.5));  // towards the plate's centre
    }
  }
}

TEST_CASE("faces of a box bound each other; small ones are looked at triangle by triangle") {
  SceneBuilder builder;
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(diffuse(0.5f)), false, 4);
  const Scene scene = builder.build();
  const surface::SurfaceMesh mesh(scene);
  const surface::CoplanarRegions large = surface::find_coplanar_regions(mesh, 0.1);
  CHECK(border_length(large) == Approx(24.0));
  const surface::CoplanarRegions small = surface::find_coplanar_regions(mesh, 2.0);
  CHECK(small.borders.empty());
  CHECK(std::set<std::uint32_t>(small.plane.begin(), small.plane.end()).size() == 6);
}

TEST_CASE("a curved surface has no regions, and slow curvature adds up") {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 24, 16);
  CHECK(surface::find_coplanar_regions(surface::SurfaceMesh(scene), 0.3).borders.empty());
  // A cylinder of 1 km: neighbouring strips of 2 cm fold by 2e-5 rad, as flat as rounding leaves a
  // plane. Over its 40 m the normals turn by 0.04 rad.
  Scene slow = empty_scene();
  const auto at = [](int i) { return glm::vec3(0.02f * static_cast<float>(i), 0.0f, 0.0f); };
  const auto height = [](glm::vec3 p) { return glm::vec3(p.x, p.y, p.x * p.x / 2000.0f); };
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 up(0, 1, 0), a = height(at(i)), b = height(at(i + 1));
    add_triangle(slow, a, b, b + up);
    add_triangle(slow, a, b + up, a + up);
  }
  const surface::CoplanarRegions regions =
      surface::find_coplanar_regions(surface::SurfaceMesh(slow), 0.1);
  std::map<std::uint32_t, std::pair<double, double>> lean;  // of each region's normals
  const surface::SurfaceMesh mesh(slow);
  for (std::uint32_t t = 0; t < slow.triangle_count(); ++t) {
    const double x = mesh.normal[t].x;
    const auto [entry, isnew] = lean.try_emplace(regions.plane[t], x, x);
    entry->second = {std::min(entry->second.first, x), std::max(entry->second.second, x)};
  }
  CHECK(lean.size() > 20);
  for (const auto& [plane, range] : lean) CHECK(range.second - range.first < 2e-3);
}

TEST_CASE("an edge of three triangles in a plane bounds all of them") {
  Scene scene = empty_scene();
  add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(scene, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  add_triangle(scene, {1, 0, 0}, {2, 2, 0}, {0, 1, 0});  // overlaps the second
  const surface::CoplanarRegions regions =
      surface::find_coplanar_regions(surface::SurfaceMesh(scene), 0.1);
  CHECK(std::set<std::uint32_t>(regions.plane.begin(), regions.plane.end()).size() == 3);
}

}  // namespace
}  // namespace photile::test
