// Every tuning gives the oracle's estimates.
#include <catch2/catch.hpp>

#include "estimate/specialisation.hpp"
#include "estimates_comparison.hpp"
#include "photile/errors.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

/// Every vector width, with each of the numbers of hits where they matter.
std::vector<EstimateTuning> tunings(const std::vector<int>& numbers_of_hits) {
  std::vector<EstimateTuning> all;
  for (const int width : estimate::vector_widths) {
    for (const int hits : numbers_of_hits) {
      all.push_back({EstimateStrategy::select, width, hits, 16});
    }
  }
  return all;
}

/// One scene with its photons and hits, estimated by every tuning.
struct Case {
  Scene scene;
  Photons photons = {};
  PrimaryHits hits = {};
  double radius = 0.2;
  int k = 50;

  void check(const std::vector<EstimateTuning>& tunings) const {
    const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
    const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
    const PhotonMaps maps(device(), scene, photons, groups, {radius, 4});
    const auto irradiance = expected_irradiance(oracle, hits, k, radius);
    ExpectedEstimates radiance;
    if (needs_of(scene).glossy) {
      radiance = expected_radiance(oracle, photons, hits, scene.lights.size(), k, radius);
    }
    for (const EstimateTuning& tuning : tunings) {
      CAPTURE(name_of(tuning.strategy), tuning.vector_width, tuning.hits_per_item, k);
      const LightTable estimates =
          Estimator(maps, scene, {.neighbours = k, .tuning = tuning, .area = AreaMode::disc})
              .estimate(hits);
      const std::size_t lights = scene.lights.size();
      CHECK(worst_difference(by_light(estimates.irradiance, estimates, lights), irradiance) <=
            estimate_tolerance(k));
      CHECK(worst_difference(by_light(estimates.radiance, estimates, lights), radiance) <=
            glossy_tolerance(k));
    }
  }
};

/// A plate, or a torus whose maps hold few hits each, with hits that are neighbours in memory.
Case one_light() {
  Case data{.scene = empty_scene()};
  add_plate(data.scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3);
  data.photons = uniform_photons(data.scene, 6000, 71);
  data.hits = uniform_hits(data.scene, 700, 72);
  return data;
}

/// Maps of few photons and hits.
Case small_maps(bool both_sides = true) {
  Case data{.scene = empty_scene()};
  add_plate(data.scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  data.photons = uniform_photons(data.scene, both_sides ? 2000 : 1000, 84, both_sides);
  data.hits = uniform_hits(data.scene, 700, 85);
  data.k = 20;
  return data;
}

Case several_lights() {
  Case data{.scene = empty_scene(3)};
  add_torus(data.scene, 1.0f, 0.4f, 12, 6);
  data.photons = uniform_photons(data.scene, 8000, 73);
  data.hits = uniform_hits(data.scene, 400, 74);
  data.radius = 0.3;
  return data;
}

Case many_lights() {
  Case data{.scene = empty_scene(70)};
  add_plate(data.scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  data.photons = uniform_photons(data.scene, 6000, 78);
  data.hits = uniform_hits(data.scene, 300, 79);
  return data;
}

Case glossy(std::size_t lights = 2) {
  Case data{.scene = empty_scene(lights)};
  data.scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
  data.scene.materials[0].roughness = 0.3f;
  add_plate(data.scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  data.photons = uniform_photons(data.scene, 5000, 75);
  data.hits = uniform_hits(data.scene, 200, 76);
  add_lobes(data.hits, data.scene, 77);
  return data;
}

/// Work-items that take hits in turn look for one's neighbours where those of the one before were.
void check_bits_of_hits_in_turn(const Case& data, AreaMode area) {
  const PhotonMaps maps(device(), data.scene, data.photons,
                        find_neighbour_groups(data.scene, {data.radius, 60}), {data.radius, 4});
  const auto estimate = [&](int hits_per_item) {
    return Estimator(maps, data.scene,
                     {.neighbours = data.k,
                      .tuning = EstimateTuning{EstimateStrategy::select, 16, hits_per_item, 16},
                      .area = area})
        .estimate(data.hits);
  };
  const LightTable alone = estimate(1);
  for (const int hits_per_item : {16, 64}) {
    CAPTURE(hits_per_item, name_of(area), data.scene.lights.size());
    const LightTable in_turn = estimate(hits_per_item);
    CHECK(in_turn.irradiance == alone.irradiance);
    CHECK(in_turn.radiance == alone.radiance);
    CHECK(in_turn.light == alone.light);
  }
}

}  // namespace

TEST_CASE("every vector width gives the oracle's irradiance for one light") {
  one_light().check(tunings({8}));
}

TEST_CASE("every vector width gives the oracle's irradiance for several lights", "[slow]") {
  several_lights().check(tunings({8}));
}

TEST_CASE("every vector width gives the oracle's irradiance and glossy radiance") {
  glossy().check(tunings({8}));
}

TEST_CASE("every vector width gives the oracle's estimates for many lights", "[slow]") {
  many_lights().check(tunings({8}));
  glossy(12).check(tunings({8}));
}

TEST_CASE("every number of hits per work-item gives the oracle's estimates", "[slow]") {
  for (const Case& data : {one_light(), several_lights(), glossy()}) {
    data.check(tunings({1, 8, 16, 64}));
  }
}

TEST_CASE("k of 1 to 900 gives the oracle's irradiance") {
  Case data = one_light();
  for (const int k : {1, 256, 257, 900}) {
    data.k = k;
    data.radius = 0.5;
    data.check({{EstimateStrategy::select, 8, 8, 64}});
  }
}

TEST_CASE("of two photons in one place at the border of the neighbourhood one counts") {
  Case data = small_maps();
  Photons twice;
  std::mt19937_64 random(80);
  for (std::size_t i = 0; i < data.photons.size() / 2; ++i) {
    for (int n = 0; n < 2; ++n) {
      add_photon(twice, data.scene, data.photons.position[i], data.photons.oriented_face[i],
                 random);
    }
  }
  data.photons = sort_by_oriented_face(std::move(twice), 2 * data.scene.triangle_count());
  // The flux of the 19 nearest counts: of 9 pairs and one of the tenth.
  data.check({{EstimateStrategy::select, 8, 8, 16}});
}

TEST_CASE("hits that no photon comes near read nothing, next to hits that photons do") {
  const Case data = small_maps(false);
  REQUIRE(std::any_of(data.hits.oriented_face.begin(), data.hits.oriented_face.end(),
                      [](std::uint32_t s) { return side_of(s) == 1; }));
  data.check({{EstimateStrategy::select, 8, 8, 16}});
}

TEST_CASE("selection tells photons apart at distances of ten orders of magnitude") {
  Case data{.scene = empty_scene()};
  add_triangle(data.scene, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  std::mt19937_64 random(82);
  for (int i = 0; i < 200; ++i) {
    const double distance = std::pow(10, -1 - i / 20.0), turn = i;
    const glm::vec3 place(distance * std::cos(turn), distance * std::sin(turn), 0);
    add_photon(data.photons, data.scene, place, 0, random);
  }
  data.photons = sort_by_oriented_face(std::move(data.photons), 2);
  data.hits = uniform_hits(data.scene, 8, 83, false);
  std::fill(data.hits.position.begin(), data.hits.position.end(), glm::vec3(0.0f));
  data.check({{EstimateStrategy::select, 8, 8, 16}});
}

TEST_CASE("an estimate has the same bits whatever hits are estimated before it") {
  check_bits_of_hits_in_turn(one_light(), AreaMode::clipped);
}

TEST_CASE("an estimate of many lights, or of gloss, has the same bits whatever is estimated before",
          "[slow]") {
  for (const Case& data : {several_lights(), many_lights(), glossy(), glossy(12), small_maps()}) {
    for (const AreaMode area : all_area_modes) check_bits_of_hits_in_turn(data, area);
  }
}

TEST_CASE("a tuning that no kernel exists for is refused") {
  const Case data = one_light();
  const PhotonMaps maps(device(), data.scene, data.photons,
                        find_neighbour_groups(data.scene, {0.2, 60}), {0.2, 4});
  for (const EstimateTuning& tuning :
       std::vector<EstimateTuning>{{EstimateStrategy::select, 3, 1, 64},
                                   {EstimateStrategy::select, 16, 0, 64},
                                   {EstimateStrategy::select, 16, 65, 64},
                                   {EstimateStrategy::select, 16, 1, 0},
                                   {EstimateStrategy::select, 16, 1, 257}}) {
    CHECK_THROWS_AS(Estimator(maps, data.scene, {50, 0, tuning}), UsageError);
  }
}

}  // namespace photile::test
