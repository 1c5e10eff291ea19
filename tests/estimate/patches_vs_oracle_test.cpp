// Maps of patches find the neighbours that maps of triangles and the oracle find, on real meshes.
#include <catch2/catch.hpp>
#include <filesystem>

#include "neighbour_comparison.hpp"
#include "photon_sets.hpp"
#include "shared_scenes.hpp"
#include "skipped.hpp"
#include "source_folder.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

void check_modes(const Scene& scene, std::size_t photon_count, std::size_t hit_count, double radius,
                 std::span<const std::string_view> names,
                 std::initializer_list<int> neighbour_counts) {
  const Photons photons = test::uniform_photons(scene, photon_count, 51);
  const PrimaryHits hits = test::uniform_hits(scene, hit_count, 52);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  for (const MapMode mode : {MapMode::triangle, MapMode::patch, MapMode::automatic}) {
    const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
    for (const std::string_view name : names) {
      const structures::Structure& structure = structures::named(name);
      const PhotonMaps maps =
          structures::build(structure, test::device(), scene, photons, groups, {radius, 4});
      for (const int k : neighbour_counts) {
        CAPTURE(structure.name, static_cast<int>(mode), k, radius);
        Estimator estimator(maps, scene, {k, 0});
        CHECK(test::count_differences(hits, estimator.nearest(hits), oracle, photons,
                                      static_cast<float>(radius)) == 0);
      }
    }
  }
}

constexpr std::array<std::string_view, 4> every_structure = {"uniform-grid", "kdtree-2d",
                                                             "kdtree-3d", "brute-force"};

/// A finely tessellated sphere: triangles of a hundredth of the radius and poles of needles.
Scene sphere() {
  Scene scene = test::empty_scene();
  constexpr int rings = 96, segments = 192;
  const auto at = [](int i, int j) {
    const float polar = glm::pi<float>() * static_cast<float>(i) / rings;
    const float angle = glm::two_pi<float>() * static_cast<float>(j) / segments;
    return glm::vec3(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                     std::cos(polar));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      if (i > 0) test::add_triangle(scene, at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) test::add_triangle(scene, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return scene;
}

}  // namespace

TEST_CASE("maps of patches find the oracle's neighbours on a fine torus", "[long]") {
  Scene scene = test::empty_scene();
  test::add_torus(scene, 1.0f, 0.2f, 96, 48);
  check_modes(scene, 20'000, 300, 0.3, every_structure, {1, 50, 400});
}

TEST_CASE("maps of patches find the oracle's neighbours on a fine sphere", "[slow]") {
  check_modes(sphere(), 20'000, 300, 0.25, every_structure, {16, 50});
}

TEST_CASE("a patch has the photons that are nearly the radius away") {
  // From another patch straight above: no hit but those right below them are as near.
  constexpr double radius = 0.2;
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  test::add_plate(scene, {0, 0, static_cast<float>(0.995 * radius)}, {1, 0, 0}, {0, 1, 0}, 4);
  const Patches patches = find_patches(scene, radius, MapMode::patch);
  REQUIRE(patches.count() == 2);
  const NeighbourGroups groups = find_patch_groups(scene, patches, {radius, 60});
  const Photons photons = test::uniform_photons(scene, 20'000, 55, false);
  const PrimaryHits hits = test::uniform_hits(scene, 300, 56, false);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const PhotonMaps maps(test::device(), scene, photons, groups, {radius, 4});
  CHECK(test::count_differences(hits, Estimator(maps, scene, {5000, 0}).nearest(hits), oracle,
                                photons, radius) == 0);
}

TEST_CASE("maps of patches find the oracle's neighbours in the Cornell box") {
  const Scene scene = load_scene(test::source_folder() / "scenes/cornell-box/cornell-box.obj");
  check_modes(scene, 20'000, 300, 0.08, every_structure, {1, 50, 300});
}

TEST_CASE("maps of patches find the oracle's neighbours in the living room", "[long][slow]") {
  const Scene scene = load_scene(test::source_folder() / "scenes/living-room/living-room.gltf");
  check_modes(scene, 60'000, 400, 0.4, every_structure, {50});
}

TEST_CASE(
    "maps of patches find the oracle's neighbours in scenes of tens of thousands of triangles",
    "[slow]") {
  const std::filesystem::path folder = test::shared_scenes_folder();
  for (const char* file : {"kitchen/kitchen-diffuse.gltf", "classroom/classroom-diffuse.gltf"}) {
    if (!std::filesystem::exists(folder / file)) {
      test::skip(std::string("no ") + file + " in the shared scenes");
      continue;
    }
    check_modes(load_scene(folder / file), 200'000, 500, 0.2, std::span(every_structure).first(1),
                {50});
  }
}

TEST_CASE("estimates of maps of patches equal those of triangles up to the order of the sums") {
  const Scene scene = load_scene(test::source_folder() / "scenes/living-room/living-room.gltf");
  const Photons photons = test::uniform_photons(scene, 60'000, 53);
  PrimaryHits hits = test::uniform_hits(scene, 2000, 54);
  if (needs_of(scene).glossy) {
    hits.outgoing.assign(hits.size(), {0, 0, 1});
    hits.lobe.assign(hits.size(), {glm::vec3(0.04f), 0.3f, {0, 0, 1}});
  }
  constexpr double radius = 0.4;
  const auto estimate = [&](MapMode mode) {
    const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
    const PhotonMaps maps(test::device(), scene, photons, groups, {radius, 4});
    return Estimator(maps, scene, {50, 0}).estimate(hits);
  };
  const Estimates triangles = estimate(MapMode::triangle), patches = estimate(MapMode::patch);
  REQUIRE(triangles.irradiance.size() == patches.irradiance.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < triangles.irradiance.size(); ++i) {
    const glm::vec3 a = triangles.irradiance[i], b = patches.irradiance[i];
    // Fifty positive terms: each order of adding them is right to 50 roundings.
    if (!(glm::length(a - b) <= 2 * 50 * 6e-8f * glm::length(a))) ++different;
  }
  CHECK(different == 0);
}

}  // namespace photile::test
