// Patches: a partition of the triangles, with groups that are those of the triangles, renamed.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"

using namespace photile;

namespace {

Scene torus() {
  Scene scene = test::empty_scene();
  test::add_torus(scene, 1.0f, 0.4f, 64, 32);
  return scene;
}

/// Finely tessellated plates: a floor, a wall, a thin table top, half of whose faces are wound the
/// other way.
Scene room_corner() {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 24);
  test::add_plate(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}, 16);
  test::add_plate(scene, {0.5f, 0.5f, 0.7f}, {1, 0, 0}, {0, 1, 0}, 12);
  test::add_plate(scene, {0.5f, 0.5f, 0.72f}, {0, 1, 0}, {1, 0, 0}, 12);
  return scene;
}

void check_partition(const Scene& scene, const Patches& patches) {
  REQUIRE(patches.map_of.size() == 2 * scene.triangle_count());
  std::vector<int> times(scene.triangle_count(), 0);
  for (std::uint32_t patch = 0; patch < patches.count(); ++patch) {
    CHECK_FALSE(patches.of(patch).empty());
    CHECK(std::is_sorted(patches.of(patch).begin(), patches.of(patch).end()));
    for (const std::uint32_t member : patches.of(patch)) {
      ++times[triangle_of(member)];
      CHECK(patches.map(member) == 2 * patch);
      CHECK(patches.map(member ^ 1u) == 2 * patch + 1);
    }
  }
  CHECK(std::all_of(times.begin(), times.end(), [](int count) { return count == 1; }));
}

/// The groups of patches by their definition: the maps of the members of the triangles' groups.
void check_renamed(const Scene& scene, const NeighbourGroups& of_patches) {
  const NeighbourGroups of_triangles =
      find_neighbour_groups(scene, {of_patches.radius, of_patches.angle_degrees});
  std::size_t wrong = 0;
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    std::set<std::uint32_t> expected;
    for (const std::uint32_t member : of_triangles.of(s)) {
      expected.insert(of_patches.patches.map(member));
    }
    const auto found = of_patches.of(s);
    if (!std::equal(found.begin(), found.end(), expected.begin(), expected.end())) ++wrong;
  }
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE(
    "every triangle is in one patch, and the groups of patches are those of their triangles") {
  const MapMode mode = GENERATE(MapMode::patch, MapMode::automatic);
  const double radius = GENERATE(0.05, 0.3);
  for (const Scene& scene : {torus(), room_corner()}) {
    CAPTURE(radius, scene.triangle_count());
    const Patches patches = find_patches(scene, radius, mode);
    check_partition(scene, patches);
    const NeighbourGroups groups = find_patch_groups(scene, patches, {radius, 60});
    check_renamed(scene, groups);

    const Photons photons = test::uniform_photons(scene, 20'000, 3);
    const NeighbourGroups merged = merge_patches(scene, groups, photons);
    CHECK(merged.patches.count() <= patches.count());
    check_partition(scene, merged.patches);
    check_renamed(scene, merged);
  }
}

TEST_CASE("a flat surface is one patch, whatever its winding and the number of its triangles") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 10);
  for (std::size_t t = 0; t < scene.triangle_count(); t += 3) {
    std::swap(scene.triangles[t].y, scene.triangles[t].z);
  }
  const Patches patches = find_patches(scene, 0.1, MapMode::patch);
  CHECK(patches.count() == 1);
  // The map of either side holds the sides that face one way.
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    CHECK(patches.map(s) == (sided_normal(scene, s).z > 0 ? patches.map(1) : patches.map(0)));
  }
}

TEST_CASE("distant plates in one plane stay apart") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3);
  test::add_plate(scene, {50, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3);
  CHECK(find_patches(scene, 0.1, MapMode::patch).count() == 2);
}

TEST_CASE(
    "joining the inner side of a thin plate to the outer side of the other saves references") {
  const Scene scene = room_corner();
  const double radius = 0.1;
  Patches apart;  // each triangle by itself: the finest patches there are
  apart.first_of.push_back(0);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    apart.members.push_back(sided(t, 0));
    apart.first_of.push_back(t + 1);
    apart.map_of.insert(apart.map_of.end(), {sided(t, 0), sided(t, 1)});
  }
  const NeighbourGroups groups = find_patch_groups(scene, apart, {radius, 60});
  const NeighbourGroups merged =
      merge_patches(scene, groups, test::uniform_photons(scene, 20'000, 4));
  check_renamed(scene, merged);
  CHECK(merged.patches.count() < apart.count() / 4);
  // The two faces of the table top are 2 cm apart, a fifth of the radius: what faces up of either
  // shares a map.
  const auto map_above = [&](std::uint32_t triangle) {
    const std::uint32_t up = sided_normal(scene, sided(triangle, 0)).z > 0 ? 0 : 1;
    return merged.patches.map(sided(triangle, up));
  };
  std::set<std::uint32_t> above, below;
  for (std::uint32_t t = 2 * (24 * 24 + 16 * 16); t < scene.triangle_count(); ++t) {
    (scene.corners(t)[0].z > 0.71f ? above : below).insert(map_above(t));
  }
  CHECK(above == below);
}

TEST_CASE("a patch joins another only where its queries would not look at most photons in vain") {
  // The ridge of a roof, with a narrow floor above it. The slopes lean 50 degrees either way, so
  // that photons of the floor are neighbours on both, and those of one slope none on the other.
  const float across = 0.05f * std::cos(glm::radians(50.0f));
  const float down = 0.05f * std::sin(glm::radians(50.0f));
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {across, 0, -down}, {0, 0.05f, 0}, 1);           // right
  test::add_plate(scene, {-across, 0, -down}, {across, 0, down}, {0, 0.05f, 0}, 1);  // left
  test::add_plate(scene, {-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0.05f, 0}, 1);       // floor
  Patches patches;  // the right slope, and the left one with the floor
  patches.first_of = {0, 2, 6};
  for (std::uint32_t t = 0; t < 6; ++t) {
    patches.members.push_back(sided(t, 0));
    const std::uint32_t front = t < 2 ? 0 : 2;
    patches.map_of.insert(patches.map_of.end(), {front, front + 1});
  }
  const NeighbourGroups groups = find_patch_groups(scene, patches, {0.2, 60});

  std::mt19937_64 random(7);
  const auto lit = [&](std::size_t right, std::size_t left, std::size_t floor) {
    const std::array counts{right, left, floor};
    Photons photons;
    for (std::uint32_t plate = 0; plate < 3; ++plate) {
      for (std::size_t i = 0; i < counts[plate]; ++i) {
        const std::uint32_t triangle = 2 * plate + i % 2;
        test::add_photon(photons, scene, test::random_point(scene, triangle, random),
                         sided(triangle, 0), random);
      }
    }
    return merge_patches(scene, groups, sort_by_sided_triangle(photons, 12)).patches.count();
  };
  // The patch of the left slope holds all photons of the right one's: those of both slopes agree
  // with the floor. What it holds besides are the photons on the left slope.
  CHECK(lit(500, 10, 500) == 1);
  CHECK(lit(500, 900, 500) == 1);   // 1000 of 1900 shared: more than half
  CHECK(lit(500, 1100, 500) == 2);  // 1000 of 2100
  CHECK(lit(10, 5000, 10) == 2);    // a dark slope beside one hundreds of times as bright
}

TEST_CASE("naive and triangle maps have no patches") {
  CHECK(find_patches(torus(), 0.1, MapMode::naive).empty());
  CHECK(find_patches(torus(), 0.1, MapMode::triangle).empty());
}
