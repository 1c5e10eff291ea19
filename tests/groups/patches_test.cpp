// Patches: a partition of the triangles, with groups that are those of the triangles, renamed.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <set>
#include <span>
#include <utility>

#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"

namespace photile::test {
namespace {

Scene torus() {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 64, 32);
  return scene;
}

/// Finely tessellated plates: a floor, a wall, a thin table top, half of whose faces are wound the
/// other way.
Scene room_corner() {
  return scene_of_plates({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 24},
                          {{0, 0, 0}, {0, 2, 0}, {0, 0, 2}, 16},
                          {{0.5f, 0.5f, 0.7f}, {1, 0, 0}, {0, 1, 0}, 12},
                          {{0.5f, 0.5f, 0.72f}, {0, 1, 0}, {1, 0, 0}, 12}});
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

struct Bounds {
  glm::dvec3 low, high;
};

double squared_gap(const Bounds& a, const Bounds& b) {
  const glm::dvec3 gap = glm::max(glm::dvec3(0), glm::max(a.low - b.high, b.low - a.high));
  return glm::dot(gap, gap);
}

/// The groups of patches by their definition, pair by pair: the maps of oriented faces whose boxes
/// lie within the radius and whose normals agree. Where the distance is the radius but for
/// rounding, either is right. Members of the groups of triangles themselves are among them.
void check_groups(const Scene& scene, const NeighbourGroups& of_patches) {
  const double squared_radius = of_patches.radius * of_patches.radius;
  const double cos_angle = std::cos(glm::radians(of_patches.angle_degrees));
  std::vector<Bounds> bounds;
  std::vector<glm::dvec3> normals;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    bounds.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
    normals.push_back(face_normal(scene, oriented(t, 0)));
  }
  const NeighbourGroups of_triangles =
      find_neighbour_groups(scene, {of_patches.radius, of_patches.angle_degrees});
  std::size_t wrong = 0;
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    const glm::dvec3 normal = face_normal(scene, s);
    std::set<std::uint32_t> least, most;
    for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
      const double squared = squared_gap(bounds[triangle_of(s)], bounds[t]);
      if (squared > 1.0001 * squared_radius) continue;
      for (const std::uint32_t side : {0u, 1u}) {
        const bool own = s == oriented(t, side);
        if (!own && !normals_agree(normal, side == 0 ? normals[t] : -normals[t], cos_angle)) {
          continue;
        }
        const std::uint32_t map = of_patches.patches.map(oriented(t, side));
        most.insert(map);
        if (squared < 0.9999 * squared_radius) least.insert(map);
      }
    }
    for (const std::uint32_t member : of_triangles.of(s)) {
      least.insert(of_patches.patches.map(member));
    }
    const auto found = of_patches.of(s);
    if (!std::is_sorted(found.begin(), found.end()) ||
        !std::includes(found.begin(), found.end(), least.begin(), least.end()) ||
        !std::includes(most.begin(), most.end(), found.begin(), found.end())) {
      ++wrong;
    }
  }
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE(
    "every triangle is in one patch, and the groups of patches are those of their triangles' "
    "boxes") {
  const MapMode mode = GENERATE(MapMode::patch, MapMode::automatic);
  const double radius = GENERATE(0.05, 0.3);
  for (const Scene& scene : {torus(), room_corner()}) {
    CAPTURE(radius, scene.triangle_count());
    const Patches patches = find_patches(scene, radius, mode);
    check_partition(scene, patches);
    const NeighbourGroups groups = find_patch_groups(scene, patches, {radius, 60});
    check_groups(scene, groups);

    const Photons photons = uniform_photons(scene, 20'000, 3);
    const NeighbourGroups merged = merge_patches(scene, groups, photons);
    CHECK(merged.patches.count() <= patches.count());
    check_partition(scene, merged.patches);
    check_groups(scene, merged);
  }
}

TEST_CASE("a patch whose normals cancel has the groups of its triangles' boxes") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1},
                                 {{0, 0, 0.01f}, {0, 1, 0}, {1, 0, 0}, 1},
                                 {{1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  Patches patches;
  patches.first_of = {0, 4, 6};
  for (std::uint32_t t = 0; t < 6; ++t) {
    patches.members.push_back(oriented(t, 0));
    const std::uint32_t front = t < 4 ? 0 : 2;
    patches.map_of.insert(patches.map_of.end(), {front, front + 1});
  }
  check_groups(scene, find_patch_groups(scene, patches, {0.1, 60}));
}

TEST_CASE("patches nearer than the radius by little more than rounding are neighbours") {
  const float gap = 0.0999999f;
  Scene scene = empty_scene();
  add_triangle(scene, {-1, 0, 0}, {0, 0, 0}, {0, 1, 0});
  add_triangle(scene, {gap, 0, 0}, {1, 0, 0}, {gap, 1, 0});
  const NeighbourGroups groups =
      find_patch_groups(scene, {{0, 1, 2, 3}, {0, 1, 2}, {0, 2}}, {0.1, 60});
  CHECK(groups.of(0).size() == 2);
}

TEST_CASE("oriented faces without photons have empty groups, and the others theirs") {
  const Scene scene = room_corner();
  std::vector<std::uint8_t> landed(2 * scene.triangle_count());
  for (std::size_t s = 0; s < landed.size(); ++s) landed[s] = s % 3 == 0 ? 1 : 0;
  const auto check = [&](const NeighbourGroups& all, const NeighbourGroups& found) {
    std::size_t wrong = 0;
    for (std::uint32_t s = 0; s < landed.size(); ++s) {
      const auto expected = landed[s] != 0 ? all.of(s) : std::span<const std::uint32_t>{};
      const auto own = found.of(s);
      if (!std::equal(own.begin(), own.end(), expected.begin(), expected.end())) ++wrong;
    }
    CHECK(wrong == 0);
  };
  const NeighbourGroupParameters parameters{0.1, 60};
  check(find_neighbour_groups(scene, parameters),
        find_neighbour_groups(scene, parameters, Progress::none(), landed));
  const Patches patches = find_patches(scene, 0.1, MapMode::automatic);
  check(find_patch_groups(scene, patches, parameters),
        find_patch_groups(scene, patches, parameters, Progress::none(), landed));
}

TEST_CASE("photons that are still to come find the groups of triangles where none has landed") {
  const Scene scene = room_corner();
  Photons photons = uniform_photons(scene, 20'000, 5);
  std::fill(photons.oriented_face.begin(), photons.oriented_face.end(), 0u);
  photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
  const auto of_others = [&](MapUsers users) {
    const NeighbourGroups groups =
        find_map_groups(scene, photons, MapMode::automatic, {0.1, 60}, Progress::none(), users);
    return groups.offsets.back() - groups.of(0).size();
  };
  CHECK(of_others(MapUsers::these_photons) == 0);
  CHECK(of_others(MapUsers::any_photons) >=
        2 * scene.triangle_count() - 1);  // each its own at least
}

TEST_CASE("a flat surface is one patch, whatever its winding and the number of its triangles") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 10}});
  for (std::size_t t = 0; t < scene.triangle_count(); t += 3) {
    std::swap(scene.triangles[t].y, scene.triangles[t].z);
  }
  const Patches patches = find_patches(scene, 0.1, MapMode::patch);
  CHECK(patches.count() == 1);
  // The map of either side holds the sides that face one way.
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    CHECK(patches.map(s) == (face_normal(scene, s).z > 0 ? patches.map(1) : patches.map(0)));
  }
}

TEST_CASE("distant plates in one plane stay apart") {
  Scene scene = scene_of_plates(
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3}, {{50, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3}});
  CHECK(find_patches(scene, 0.1, MapMode::patch).count() == 2);
}

TEST_CASE(
    "joining the inner side of a thin plate to the outer side of the other saves references") {
  const Scene scene = room_corner();
  const double radius = 0.1;
  Patches apart;  // each triangle by itself: the finest patches there are
  apart.first_of.push_back(0);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    apart.members.push_back(oriented(t, 0));
    apart.first_of.push_back(t + 1);
    apart.map_of.insert(apart.map_of.end(), {oriented(t, 0), oriented(t, 1)});
  }
  const NeighbourGroups groups = find_patch_groups(scene, apart, {radius, 60});
  const NeighbourGroups merged = merge_patches(scene, groups, uniform_photons(scene, 20'000, 4));
  check_groups(scene, merged);
  CHECK(merged.patches.count() < apart.count() / 4);
  // The two faces of the table top are 2 cm apart, a fifth of the radius: what faces up of either
  // shares a map.
  const auto map_above = [&](std::uint32_t triangle) {
    const std::uint32_t up = face_normal(scene, oriented(triangle, 0)).z > 0 ? 0 : 1;
    return merged.patches.map(oriented(triangle, up));
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
  Scene scene = empty_scene();
  add_plate(scene, {0, 0, 0}, {across, 0, -down}, {0, 0.05f, 0}, 1);           // right
  add_plate(scene, {-across, 0, -down}, {across, 0, down}, {0, 0.05f, 0}, 1);  // left
  add_plate(scene, {-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0.05f, 0}, 1);       // floor
  Patches patches;  // the right slope, and the left one with the floor
  patches.first_of = {0, 2, 6};
  for (std::uint32_t t = 0; t < 6; ++t) {
    patches.members.push_back(oriented(t, 0));
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
        add_photon(photons, scene, random_point(scene, triangle, random), oriented(triangle, 0),
                   random);
      }
    }
    return merge_patches(scene, groups, sort_by_oriented_face(photons, 12)).patches.count();
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

}  // namespace photile::test
