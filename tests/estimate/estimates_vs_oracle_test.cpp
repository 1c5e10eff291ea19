// Estimates against the oracle, of triangles and of patches.

#include "oracle_checks.hpp"
#include "photon_sets.hpp"
#include "shared_scenes.hpp"
#include "skipped.hpp"
#include "test_tunings.hpp"

namespace photile::test {
namespace {

// Irradiance and reflected radiance of every hit, over whole discs, against brute force in double
// precision.

void check_irradiance(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                      double radius, int k) {
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const std::size_t lights = scene.lights.size();
  const auto expected = expected_irradiance(oracle, hits, k, radius);
  for (const char* const name : checked_structures) {
    const structures::Structure& structure = structures::named(name);
    const PhotonMaps maps =
        structures::build(structure, device(), scene, photons, groups, {radius, 4});
    const LightTable estimates =
        Estimator(maps, scene, {.neighbours = k, .area = AreaMode::disc}).estimate(hits);
    const auto irradiance = by_light(estimates.irradiance, estimates, lights);
    REQUIRE(irradiance.size() == hits.size() * lights);
    CHECK(estimates.radiance.empty());
    CAPTURE(structure.name, k, radius, lights);
    CHECK(worst_difference(irradiance, expected) <= estimate_tolerance(k));
  }
}

void check_one_light(std::initializer_list<int> neighbours) {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3}});
  const Photons photons = uniform_photons(scene, 6000, 51);
  const PrimaryHits hits = uniform_hits(scene, 300, 52);
  for (const int k : neighbours) check_irradiance(scene, photons, hits, 0.2, k);
}

TEST_CASE("irradiance equals the oracle's for one light") { check_one_light({50}); }
TEST_CASE("irradiance equals the oracle's for one light and any k", "[slow]") {
  check_one_light({1, 2, 16, 400});
}

void check_lights(std::initializer_list<std::size_t> counts) {
  for (const std::size_t lights : counts) {
    Scene scene = empty_scene(lights);
    add_torus(scene, 1.0f, 0.4f, 24, 12);
    const Photons photons = uniform_photons(scene, 20'000, 53);
    check_irradiance(scene, photons, uniform_hits(scene, 200, 54), 0.3, 50);
  }
}

// A hash table with places to spare.
TEST_CASE("irradiance equals the oracle's per light") { check_lights({40}); }
// As many as fit registers and one more, a table without places to spare, two-byte lights.
TEST_CASE("irradiance equals the oracle's per light, for any number of lights", "[long][slow]") {
  check_lights({2, 8, 9, 200, 300});
}

TEST_CASE("with fewer than k photons within the radius the full disc counts") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  const Photons photons = uniform_photons(scene, 60, 55);
  check_irradiance(scene, photons, uniform_hits(scene, 100, 56), 0.1, 50);
}

TEST_CASE("photons in one point: ties share the estimate as the oracle says") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  std::mt19937_64 random(57);
  Photons photons;
  for (int i = 0; i < 2000; ++i) {
    add_photon(photons, scene, {0.5f, 0.25f, 0}, 0, random);
  }
  photons = sort_by_oriented_face(std::move(photons), 4);
  PrimaryHits hits = uniform_hits(scene, 50, 58, false);
  hits.position[0] = {0.5f, 0.25f, 0};
  check_irradiance(scene, photons, hits, 0.5, 50);
}

TEST_CASE("glossy radiance equals the BSDF summed over the oracle's neighbours in double") {
  const DensityKernel kernel = GENERATE(from_range(all_density_kernels));
  Scene scene = empty_scene(2);
  scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
  scene.materials[0].roughness = 0.3f;
  add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  const Photons photons = uniform_photons(scene, 5000, 59);
  REQUIRE(photons.incoming.size() == photons.size());
  PrimaryHits hits = uniform_hits(scene, 100, 60);
  add_lobes(hits, scene, 61);
  const double radius = 0.2;
  const int k = 50;
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  const LightTable estimates =
      Estimator(maps, scene, {.neighbours = k, .area = AreaMode::disc, .kernel = kernel})
          .estimate(hits);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);

  const auto expected = expected_radiance(oracle, photons, hits, 2, k, radius, kernel);
  CHECK(worst_difference(estimates.radiance, expected) <=
        glossy_tolerance(k) / reference::mean_weight(kernel));
}

TEST_CASE("radiance under normal maps equals the BSDF summed over the oracle's neighbours") {
  Scene scene = empty_scene(2);
  scene.materials[0].specular = glm::vec3(0.04f);
  scene.materials[0].roughness = 0.4f;
  scene.materials[0].normal_texture = 0;
  scene.textures.emplace_back("flat", 1, 1,
                              std::vector<std::array<std::uint8_t, 4>>{{128, 128, 255, 255}});
  add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  scene.corner_uv.resize(scene.triangle_count());
  REQUIRE(needs_of(scene).normal_maps);
  const Photons photons = uniform_photons(scene, 5000, 59);
  PrimaryHits hits = uniform_hits(scene, 100, 60);
  add_lobes(hits, scene, 61);
  std::mt19937_64 random(62);
  std::uniform_real_distribution<float> tilt(-0.4f, 0.4f);
  for (HitLobe& lobe : hits.lobe) {
    lobe.f90 = 0.8f;
    lobe.smooth_normal = lobe.normal;
    lobe.normal = glm::normalize(lobe.normal + glm::vec3(tilt(random), tilt(random), tilt(random)));
  }
  const double radius = 0.2;
  const int k = 50;
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const auto expected = expected_radiance(oracle, photons, hits, 2, k, radius);
  for (const EstimateTuning& tuning : tunings_of(device().info())) {
    CAPTURE(name_of(tuning.strategy));
    const LightTable estimates =
        Estimator(maps, scene, {.neighbours = k, .tuning = tuning, .area = AreaMode::disc})
            .estimate(hits);
    CHECK(worst_difference(estimates.radiance, expected) <= glossy_tolerance(k));
  }
}

// Maps of patches find the neighbours that maps of triangles and the oracle find, on real meshes.

void check_modes(const Scene& scene, std::size_t photon_count, std::size_t hit_count, double radius,
                 std::span<const std::string_view> names,
                 std::initializer_list<int> neighbour_counts) {
  const Photons photons = uniform_photons(scene, photon_count, 51);
  const PrimaryHits hits = uniform_hits(scene, hit_count, 52);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  for (const MapMode mode : {MapMode::triangle, MapMode::patch, MapMode::automatic}) {
    const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
    for (const std::string_view name : names) {
      const structures::Structure& structure = structures::named(name);
      const PhotonMaps maps =
          structures::build(structure, device(), scene, photons, groups, {radius, 4});
      for (const int k : neighbour_counts) {
        CAPTURE(structure.name, static_cast<int>(mode), k, radius);
        Estimator estimator(maps, scene, {k, 0});
        CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons,
                                static_cast<float>(radius)) == 0);
      }
    }
  }
}

constexpr std::array<std::string_view, 4> every_structure = {"uniform-grid", "kdtree-2d",
                                                             "kdtree-3d", "brute-force"};

/// A finely tessellated sphere: triangles of a hundredth of the radius and poles of needles.
Scene sphere() {
  Scene scene = empty_scene();
  constexpr int rings = 96, segments = 192;
  const auto at = [](int i, int j) {
    const float polar = glm::pi<float>() * static_cast<float>(i) / rings;
    const float angle = glm::two_pi<float>() * static_cast<float>(j) / segments;
    return glm::vec3(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                     std::cos(polar));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      if (i > 0) add_triangle(scene, at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) add_triangle(scene, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return scene;
}

TEST_CASE("maps of patches find the oracle's neighbours on a fine torus", "[long][slow]") {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.2f, 96, 48);
  check_modes(scene, 20'000, 300, 0.3, every_structure, {1, 50, 400});
}

TEST_CASE("maps of patches find the oracle's neighbours on a fine sphere", "[slow]") {
  check_modes(sphere(), 20'000, 300, 0.25, every_structure, {16, 50});
}

TEST_CASE("a patch has the photons that are nearly the radius away") {
  // From another patch straight above: no hit but those right below them are as near.
  constexpr double radius = 0.2;
  Scene scene =
      scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4},
                       {{0, 0, static_cast<float>(0.995 * radius)}, {1, 0, 0}, {0, 1, 0}, 4}});
  const Patches patches = find_patches(scene, radius, MapMode::patch);
  REQUIRE(patches.count() == 2);
  const NeighbourGroups groups = find_patch_groups(scene, patches, {radius, 60});
  const Photons photons = uniform_photons(scene, 20'000, 55, false);
  const PrimaryHits hits = uniform_hits(scene, 300, 56, false);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const PhotonMaps maps(device(), scene, photons, groups, {radius, 4});
  CHECK(count_differences(hits, Estimator(maps, scene, {5000, 0}).nearest(hits), oracle, photons,
                          radius) == 0);
}

TEST_CASE("maps of patches find the oracle's neighbours in the Cornell box") {
  const Scene scene = load_scene(source_folder() / "scenes/cornell-box/cornell-box.obj");
  check_modes(scene, 20'000, 300, 0.08, every_structure, {1, 50, 300});
}

TEST_CASE("maps of patches find the oracle's neighbours in the living room", "[long][slow]") {
  const Scene scene = load_scene(source_folder() / "scenes/living-room/living-room.gltf");
  check_modes(scene, 60'000, 400, 0.4, every_structure, {50});
}

TEST_CASE(
    "maps of patches find the oracle's neighbours in scenes of tens of thousands of triangles",
    "[slow]") {
  const std::filesystem::path folder = shared_scenes_folder();
  for (const char* file : {"kitchen/kitchen-diffuse.gltf", "classroom/classroom-diffuse.gltf"}) {
    if (!std::filesystem::exists(folder / file)) {
      skip(std::string("no ") + file + " in the shared scenes");
      continue;
    }
    check_modes(load_scene(folder / file), 200'000, 500, 0.2, std::span(every_structure).first(1),
                {50});
  }
}

TEST_CASE("estimates of maps of patches equal those of triangles up to the order of the sums",
          "[slow]") {
  const Scene scene = load_scene(source_folder() / "scenes/living-room/living-room.gltf");
  const Photons photons = uniform_photons(scene, 60'000, 53);
  PrimaryHits hits = uniform_hits(scene, 2000, 54);
  if (needs_of(scene).glossy) {
    hits.outgoing.assign(hits.size(), {0, 0, 1});
    hits.lobe.assign(hits.size(), {glm::vec3(0.04f), 0.3f, {0, 0, 1}});
  }
  constexpr double radius = 0.4;
  const auto estimate = [&](MapMode mode) {
    const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
    const PhotonMaps maps(device(), scene, photons, groups, {radius, 4});
    return Estimator(maps, scene, {50, 0}).estimate(hits);
  };
  const LightTable triangles = estimate(MapMode::triangle), patches = estimate(MapMode::patch);
  REQUIRE(triangles.irradiance.size() == patches.irradiance.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < triangles.irradiance.size(); ++i) {
    const glm::vec3 a = triangles.irradiance[i], b = patches.irradiance[i];
    // Fifty positive terms: each order of adding them is right to 50 roundings.
    if (!(glm::length(a - b) <= 2 * 50 * 6e-8f * glm::length(a))) ++different;
  }
  CHECK(different == 0);
}

// Small scenes of any shape through groups, maps and estimates, against the oracle: what nobody
// thought of as a case. PHOTILE_RANDOM_SCENES is how many, PHOTILE_RANDOM_SCENES_SEED the first.

constexpr std::uint64_t quick_scenes = 1;
/// Beyond the first, one of so many scenes is tried in every mode, with every structure.
constexpr std::uint64_t whole_trials = 200;
constexpr std::array neighbour_counts{1, 8, 50};

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed) {
    scene_ = empty_scene(static_cast<std::size_t>(whole(1, 3)));
    for (int part = whole(1, 4); part > 0; --part) add_part();
  }

  const Scene& scene() const { return scene_; }
  int whole(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  float between(float least, float most) {
    return std::uniform_real_distribution<float>(least, most)(random_);
  }

 private:
  glm::vec3 vector(float size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }

  void add_part() {
    const glm::vec3 corner = vector(1);
    switch (whole(0, 4)) {
      case 0:  // level: many distances are equal but for rounding
        add_plate(scene_, {corner.x, corner.y, 0}, {1, 0, 0}, {0, 1, 0}, whole(1, 3));
        break;
      case 1:
        add_plate(scene_, corner, vector(1), vector(1), whole(1, 2));
        break;
      case 2:
        add_torus(scene_, between(0.3f, 1), between(0.05f, 0.3f), whole(3, 6), whole(3, 5));
        break;
      case 3:  // a needle
        add_triangle(scene_, corner, corner + vector(1), corner + vector(between(1e-4f, 1e-2f)));
        break;
      default:  // two that share an edge, at any angle
        const glm::vec3 edge = corner + vector(1);
        add_triangle(scene_, corner, edge, corner + vector(1));
        add_triangle(scene_, edge, corner, corner + vector(1));
    }
  }

  std::mt19937_64 random_;
  Scene scene_;
};

TEST_CASE("neighbours and irradiance in scenes at random are the oracle's") {
  const std::uint64_t count = number_from("PHOTILE_RANDOM_SCENES", quick_scenes),
                      first = number_from("PHOTILE_RANDOM_SCENES_SEED", 1);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    CAPTURE(seed);
    RandomScene made(seed);
    const auto photon_count = static_cast<std::size_t>(std::pow(10.0f, made.between(0, 3)));
    const double radius = static_cast<double>(std::pow(10.0f, made.between(-2, 0.5f)));
    const Photons photons = uniform_photons(made.scene(), photon_count, 2 * seed);
    const PrimaryHits hits = uniform_hits(made.scene(), 20, 2 * seed + 1);
    if (seed < first + quick_scenes || seed % whole_trials == 0) {
      check_against_oracle(made.scene(), photons, hits, radius,
                           {neighbour_counts[0], neighbour_counts[1], neighbour_counts[2]}, true);
      continue;
    }
    const auto mode = std::array{MapMode::naive, MapMode::triangle,
                                 MapMode::patch}[static_cast<std::size_t>(made.whole(0, 2))];
    const MapsUnderTest maps(made.scene(), photons, hits, radius, mode);
    const auto k = static_cast<std::size_t>(made.whole(0, 2));
    const auto check = [&](const structures::Structure& structure) {
      maps.check(structure, std::span(neighbour_counts).subspan(k, 1), true);
    };
    check(structures::named("uniform-grid"));
    const auto all = structures::all();
    const auto other =
        static_cast<std::size_t>(made.whole(0, 4 * static_cast<int>(all.size()) - 1));
    if (other < all.size() && maps.has(all[other])) check(all[other]);
  }
}

}  // namespace
}  // namespace photile::test
