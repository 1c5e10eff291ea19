// The photon map of a picked triangle.
#include "view/photon_map.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "test_scenes.hpp"

namespace photile::test {

using namespace photile::view;

namespace {

/// A floor of 4 x 4 quads and a wall at its far side, under a lamp.
Scene corner() {
  test::SceneBuilder builder;
  const auto grey = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({0, 0, 4}, {4, 0, 0}, {0, 0, -4}, 4, grey);
  builder.grid({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 4, grey);
  builder.add(test::point_light("lamp", {2, 3, 2}, 100));
  return builder.build();
}

TracedPhotons prepared(const Scene& scene, MapMode mode) {
  TracedPhotons result;
  PhotonTracerParameters paths;
  paths.emitted_photons = 20'000;
  result.photons = trace_photons(RayScene(scene), paths).photons;
  result.radius = 0.3;
  result.groups = find_map_groups(scene, result.photons, mode, {result.radius});
  return result;
}

/// Upper sides of the floor that are picked in turn.
std::uint32_t some_triangle(const Scene& scene, std::uint32_t triangle) {
  const bool up = face_normal(scene, oriented(triangle, 0)).y > 0.5;
  return oriented(triangle, up ? 0 : 1);
}

}  // namespace

TEST_CASE("the group of a picked triangle is that of the photon maps") {
  const Scene scene = corner();
  const TracedPhotons photons = prepared(scene, MapMode::triangle);
  const InspectablePhotons inspected = InspectablePhotons::of(photons);
  for (std::uint32_t triangle = 0; triangle < 32; ++triangle) {
    const std::uint32_t picked = some_triangle(scene, triangle);
    const PhotonMapView view = view_of_map(scene, inspected, picked);
    const auto members = photons.groups.of(picked);
    std::set<std::uint32_t> expected(members.begin(), members.end());
    expected.erase(picked);
    CHECK(std::set<std::uint32_t>(view.group.begin(), view.group.end()) == expected);
    CHECK(view.patch.empty());
  }
}

TEST_CASE("the photons of a picked triangle lie on it, those of its group in reach of it") {
  const Scene scene = corner();
  const TracedPhotons photons = prepared(scene, MapMode::triangle);
  const std::uint32_t picked = some_triangle(scene, 12);
  const PhotonMapView view = view_of_map(scene, InspectablePhotons::of(photons), picked);
  REQUIRE(view.own_photons.size() > 10);
  REQUIRE(view.group_photons.size() > 10);
  // By brute force over all photons of the floor's upper sides: on the picked one or near it.
  std::size_t own = 0, near = 0;
  const auto corners = scene.corners(triangle_of(picked));
  const std::array<glm::dvec3, 3> target{glm::dvec3(corners[0]), glm::dvec3(corners[1]),
                                         glm::dvec3(corners[2])};
  for (std::size_t i = 0; i < photons.photons.size(); ++i) {
    const std::uint32_t on = photons.photons.oriented_face[i];
    own += on == picked ? 1 : 0;
    if (on == picked || face_normal(scene, on).y < 0.5) continue;
    const glm::dvec3 at(photons.photons.position[i]);
    near += triangle_triangle_distance(target, {at, at, at}) <= 0.3 ? 1 : 0;
  }
  CHECK(view.own_photons.size() == own);
  CHECK(view.group_photons.size() == near);
}

TEST_CASE("triangles that share the map of a picked one are of its patch or its group") {
  const Scene scene = corner();
  const TracedPhotons photons = prepared(scene, MapMode::patch);
  const std::uint32_t picked = some_triangle(scene, 5);
  const PhotonMapView view = view_of_map(scene, InspectablePhotons::of(photons), picked);
  std::set<std::uint32_t> shown(view.patch.begin(), view.patch.end());
  shown.insert(view.group.begin(), view.group.end());
  shown.insert(picked);
  const Patches& patches = photons.groups.patches;
  for (std::uint32_t each = 0; each < patches.map_of.size(); ++each) {
    if (patches.map(each) == patches.map(picked)) CHECK(shown.contains(each));
  }
  CHECK_FALSE(view.patch.empty());
}

TEST_CASE("a naive map has its own photons alone") {
  const Scene scene = corner();
  const TracedPhotons photons = prepared(scene, MapMode::naive);
  const PhotonMapView view =
      view_of_map(scene, InspectablePhotons::of(photons), some_triangle(scene, 12));
  CHECK(view.group.empty());
  CHECK(view.group_photons.empty());
  CHECK_FALSE(view.own_photons.empty());
}

}  // namespace photile::test
