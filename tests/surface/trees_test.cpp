// Trees over surfaces and planes.
#include <catch2/catch.hpp>
#include <functional>

#include "photon_sets.hpp"
#include "surface/coplanar_regions.hpp"
#include "surface/surface_tree.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

// The search for triangles of other planes, beside all pairs.

/// Triangles of other regions within the radius, by looking at all.
std::set<std::uint32_t> others_within(const surface::SurfaceMesh& mesh,
                                      const surface::CoplanarRegions& regions,
                                      std::uint32_t triangle, double radius) {
  const geometry::Box box = geometry::triangle_box(mesh.scene, triangle);
  std::set<std::uint32_t> found;
  for (std::uint32_t other = 0; other < mesh.scene.triangle_count(); ++other) {
    if (mesh.counts(other) && regions.plane[other] != regions.plane[triangle] &&
        geometry::squared_distance(box, geometry::triangle_box(mesh.scene, other)) <=
            radius * radius) {
      found.insert(other);
    }
  }
  return found;
}

TEST_CASE("triangles of other planes are all found, and none of the own") {
  SceneBuilder builder;
  const std::uint32_t material = builder.add(diffuse(0.5f));
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), material, true, 12);
  builder.box(glm::vec3(0.2f, 0.2f, 0.01f), glm::vec3(0.5f), material, false, 5);
  Scene scene = builder.build();
  add_torus(scene, 0.3f, 0.1f, 12, 8);
  const surface::SurfaceMesh mesh(scene);
  for (const double radius : {0.02, 0.15}) {
    const surface::CoplanarRegions regions = surface::find_coplanar_regions(mesh, radius);
    const surface::PlaneTree planes(mesh, regions);
    for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
      std::set<std::uint32_t> visited;
      planes.visit_others(triangle, geometry::triangle_box(scene, triangle), radius,
                          [&](std::uint32_t other) {
                            visited.insert(other);
                            return false;
                          });
      bool own_plane = false, missed = false;
      for (const std::uint32_t other : visited) {
        own_plane |= regions.plane[other] == regions.plane[triangle];
      }
      for (const std::uint32_t other : others_within(mesh, regions, triangle, radius)) {
        missed |= visited.count(other) == 0;
      }
      INFO("triangle " << triangle << ", radius " << radius);
      REQUIRE(!own_plane);
      REQUIRE(!missed);
    }
  }
}

TEST_CASE("of two triangles at an angle each finds the other") {
  Scene scene = empty_scene();
  add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  const surface::SurfaceMesh mesh(scene);
  const surface::CoplanarRegions regions = surface::find_coplanar_regions(mesh, 0.1);
  const surface::PlaneTree planes(mesh, regions);
  for (const std::uint32_t triangle : {0u, 1u}) {
    std::vector<std::uint32_t> found;
    planes.visit_others(triangle, geometry::triangle_box(scene, triangle), 0.1,
                        [&](std::uint32_t other) {
                          found.push_back(other);
                          return false;
                        });
    CHECK(found == std::vector<std::uint32_t>{1 - triangle});
  }
}

TEST_CASE("a search for triangles of other planes ends where it is told to") {
  const Scene scene = closed_box(diffuse(0.5f), 4);
  const surface::SurfaceMesh mesh(scene);
  const surface::CoplanarRegions regions = surface::find_coplanar_regions(mesh, 0.1);
  const surface::PlaneTree planes(mesh, regions);
  int visits = 0;
  planes.visit_others(0, geometry::triangle_box(scene, 0), 2.0,
                      [&](std::uint32_t) { return ++visits == 3; });
  CHECK(visits == 3);
}

// The tree over pieces of surface: complete, within its boxes, and no deeper than its stack.

surface::SurfacePiece piece_at(const glm::vec3& centre, const glm::vec3& size) {
  surface::SurfacePiece piece;
  piece.box.extend(centre - size);
  piece.box.extend(centre + size);
  return piece;
}

/// Checks the boxes and counts each piece; returns the most entries a traversal's stack may hold.
int check_tree(const surface::SurfaceTree& tree, const std::vector<surface::SurfacePiece>& pieces) {
  std::vector<int> seen(pieces.size(), 0);
  int deepest = 0, outside = 0;
  const std::function<void(std::uint32_t, int)> visit = [&](std::uint32_t index, int depth) {
    deepest = std::max(deepest, depth);
    const PhotileSurfaceNode& node = tree.nodes.at(index);
    for (int i = 0; i < PHOTILE_SURFACE_WIDTH; ++i) {
      if (node.child[i] == PHOTILE_SURFACE_NONE) continue;
      if ((node.child[i] & PHOTILE_SURFACE_LEAF) == 0) {
        visit(node.child[i], depth + 1);
        continue;
      }
      for (const std::uint32_t p : tree.leaves.at(node.child[i] & ~PHOTILE_SURFACE_LEAF)) {
        ++seen.at(p);
        const geometry::Box& box = pieces[p].box;
        outside += box.lower.x < node.lower_x[i] || box.lower.y < node.lower_y[i] ||
                   box.lower.z < node.lower_z[i] || box.upper.x > node.upper_x[i] ||
                   box.upper.y > node.upper_y[i] || box.upper.z > node.upper_z[i];
      }
    }
  };
  visit(0, 1);
  CHECK(outside == 0);
  CHECK(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
  for (const auto& leaf : tree.leaves) CHECK(leaf.size() <= PHOTILE_SURFACE_WIDTH);
  return 7 * deepest + 1;
}

TEST_CASE("every piece is in one leaf, within the boxes above it") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-3.0f, 3.0f);
  std::exponential_distribution<float> size(20.0f);
  for (const int count : {0, 1, 8, 9, 1000, 20'000}) {
    std::vector<surface::SurfacePiece> pieces;
    for (int i = 0; i < count; ++i) {
      pieces.push_back(piece_at({place(random), place(random), place(random)},
                                {size(random), size(random), size(random)}));
    }
    CAPTURE(count);
    CHECK(check_tree(surface::build_surface_tree(pieces), pieces) <= PHOTILE_SURFACE_STACK);
  }
}

TEST_CASE("pieces in one point, or ever farther apart, do not make the tree deep") {
  std::vector<surface::SurfacePiece> same(5000, piece_at(glm::vec3(1.0f), glm::vec3(0.1f)));
  CHECK(check_tree(surface::build_surface_tree(same), same) <= PHOTILE_SURFACE_STACK);
  std::vector<surface::SurfacePiece> apart;
  for (int i = 0; i < 5000; ++i)
    apart.push_back(piece_at(glm::vec3(std::ldexp(1.0f, i % 200 - 100), 0, 0), glm::vec3(0.0f)));
  CHECK(check_tree(surface::build_surface_tree(apart), apart) <= PHOTILE_SURFACE_STACK);
}

TEST_CASE(
    "no tree is deeper than ten levels and the logarithm of its pieces to the base of eight") {
  // Clusters within clusters, each a 32nd as large as the one around it: what splits by area part
  // in a level of the tree leaves all of the last one, whose centres coincide, together.
  std::vector<surface::SurfacePiece> pieces;
  float size = 1;
  for (int level = 0; level < 10; ++level, size /= 32) {
    for (int i = 1; i <= 128; ++i) {
      const float place = 0.1f + static_cast<float>(i) / 128;
      pieces.push_back(piece_at(glm::vec3(size * place), glm::vec3(1e-3f * size)));
    }
  }
  pieces.resize(32'768, piece_at(glm::vec3(0.0f), glm::vec3(size)));  // 8^5
  CHECK(check_tree(surface::build_surface_tree(pieces), pieces) <= 7 * (10 + 5) + 1);
}

}  // namespace
}  // namespace photile::test
