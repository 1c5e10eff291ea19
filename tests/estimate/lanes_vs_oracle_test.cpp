// Every kind of kernel, for every k: the neighbours and estimates of the double-precision oracle.
// The kernels whose lanes are the work-items of a group, as on GPUs, on any device, and those of a
// work-item's own vectors beside them, which differ in the order of sums alone.
#include <string>
#include <utility>

#include "estimates_comparison.hpp"
#include "neighbour_comparison.hpp"
#include "oracle/clipped_area.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"
#include "test_tunings.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.3;
constexpr int k = 50;

EstimateTuning lanes(int width) { return {EstimateStrategy::lanes, width, 4, width}; }

/// What kernels are specialised for, but for k.
struct Kind {
  std::string name;
  std::size_t lights = 1;
  bool glossy = false;
  AreaMode area = AreaMode::disc;
  MapMode maps = MapMode::triangle;
};

const std::array kinds{Kind{"disc"}, Kind{"clipped", 1, false, AreaMode::clipped},
                       Kind{"glossy", 2, true}, Kind{"many lights", 20},
                       Kind{"patches", 1, false, AreaMode::disc, MapMode::patch}};

Scene scene_of(const Kind& kind) {
  Scene scene = empty_scene(kind.lights);
  if (kind.glossy) {
    scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
    scene.materials[0].roughness = 0.3f;
  }
  add_torus(scene, 1.0f, 0.4f, 16, 8);
  if (kind.area == AreaMode::clipped) {
    // Edges and a step within reach of most hits.
    add_plate(scene, {-1.5f, -1.5f, -0.5f}, {3, 0, 0}, {0, 3, 0.1f}, 4);
    add_plate(scene, {-0.5f, -0.5f, -0.4f}, {1, 0, 0}, {0, 1, 0}, 1);
  }
  return scene;
}

/// A kind with photons, of which about a thousand are within the radius.
struct Subject {
  Kind kind;
  Scene scene;
  Photons photons;
  PrimaryHits hits;
  PhotonMaps maps;

  Subject(Kind of_kind, std::size_t hit_count)
      : kind(std::move(of_kind)),
        scene(scene_of(kind)),
        photons(uniform_photons(scene, 90'000, 91)),
        hits(uniform_hits(scene, hit_count, 92)),
        maps(device(), scene, photons, find_map_groups(scene, photons, kind.maps, {radius, 60}),
             {radius, 4}) {
    if (kind.glossy) add_lobes(hits, scene, 93);
  }

  reference::DensityOracle oracle() const {
    return {scene, photons, reference::PhotonFilter::grouped, 60};
  }

  LightTable estimate(const EstimateTuning& tuning, int neighbours, AreaMode area) const {
    return Estimator(maps, scene, {.neighbours = neighbours, .tuning = tuning, .area = area})
        .estimate(hits);
  }

  ExpectedEstimates expected_irradiance(int neighbours) const {
    if (kind.area == AreaMode::disc) {
      return test::expected_irradiance(oracle(), hits, neighbours, radius);
    }
    const reference::DensityOracle truth = oracle();
    const SurfaceIndex surface = index_surface(scene, landed_on(scene, photons), radius, 60);
    const reference::ClippedArea clipped(scene, photons, surface, 60);
    ExpectedEstimates expected;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      expected.push_back(truth.irradiance(clipped, hits.position[i], hits.oriented_face[i],
                                          neighbours, static_cast<float>(radius),
                                          DensityKernel::constant));
    }
    return expected;
  }
};

/// Largest relative difference of two lists of positive numbers.
double relative_difference(const std::vector<glm::vec3>& values,
                           const std::vector<glm::vec3>& expected) {
  REQUIRE(values.size() == expected.size());
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double a = values[i][c], b = expected[i][c];
      if (a != b) worst = std::max(worst, std::abs(a - b) / b);
    }
  }
  return worst;
}

/// The neighbours and estimates of a kind against the oracle's.
void check(const Kind& kind, const EstimateTuning& tuning, int neighbours, std::size_t hit_count) {
  const Subject subject(kind, hit_count);
  const reference::DensityOracle oracle = subject.oracle();
  if (kind.lights == 1 && kind.area == AreaMode::disc) {  // no other kind has lists of its own
    Estimator estimator(subject.maps, subject.scene, {.neighbours = neighbours, .tuning = tuning});
    CHECK(count_differences(subject.hits, estimator.nearest(subject.hits), oracle, subject.photons,
                            radius) == 0);
  }
  const LightTable estimates = subject.estimate(tuning, neighbours, kind.area);
  // The oracle's clipped discs are polygons: clipped_vs_oracle_test.cpp.
  const double tolerance = kind.area == AreaMode::clipped ? 1e-3 : estimate_tolerance(neighbours);
  CHECK(worst_difference(by_light(estimates.irradiance, estimates, kind.lights),
                         subject.expected_irradiance(neighbours)) <= tolerance);
  if (!kind.glossy) return;
  CHECK(worst_difference(by_light(estimates.radiance, estimates, kind.lights),
                         expected_radiance(oracle, subject.photons, subject.hits, kind.lights,
                                           neighbours, radius)) <= glossy_tolerance(neighbours));
}

}  // namespace

// bench/device_report.sh tells of each section.
TEST_CASE("every kind of estimate is the oracle's for k of 1 to 1,000", "[slow][device]") {
  for (const EstimateTuning& tuning : tunings_of(device().info())) {
    for (const Kind& kind : kinds) {
      for (const int neighbours : {1, 2, 31, 50, 65, 200, 1000}) {
        DYNAMIC_SECTION(name_of(tuning.strategy) << (tuning.shuffles ? " with shuffles, " : ", ")
                                                 << kind.name << ", k = " << neighbours) {
          check(kind, tuning, neighbours, 61);
        }
        if (!tuning.shuffles) continue;
        DYNAMIC_SECTION("bits of shuffles and of local memory, " << kind.name
                                                                 << ", k = " << neighbours) {
          const Subject subject(kind, 61);
          const LightTable shuffled = subject.estimate(tuning, neighbours, kind.area);
          EstimateTuning without = tuning;
          without.shuffles = false;
          const LightTable plain = subject.estimate(without, neighbours, kind.area);
          CHECK(shuffled.irradiance == plain.irradiance);
          CHECK(shuffled.radiance == plain.radiance);
        }
      }
    }
  }
}

TEST_CASE("lanes estimate what the oracle does for any k and number of hits", "[slow]") {
  const int width = GENERATE(32, 64);
  const std::size_t hits = GENERATE(1u, 61u);
  for (const int neighbours : {1, 2, 31, 50, 65, 200, 1000}) {
    CAPTURE(width, hits, neighbours);
    check(kinds[0], lanes(width), neighbours, hits);
  }
}

TEST_CASE("lanes estimate every kind as the oracle does", "[slow]") {
  const int width = GENERATE(32, 64);
  for (const Kind& kind : kinds) check(kind, lanes(width), k, 61);
  check({"several lights", 3}, lanes(width), k, 61);
  check({"glossy, many lights", 20, true}, lanes(width), k, 61);
}

TEST_CASE("lanes differ from vectors in the order of sums alone") {
  const Subject subject({"several lights", 3}, 60);
  const LightTable of_lanes = subject.estimate(lanes(32), k, AreaMode::disc);
  const LightTable of_vectors =
      subject.estimate({EstimateStrategy::select, 16, 4, 16}, k, AreaMode::disc);
  // A sum of k positive numbers is right to k - 1 roundings, in any order.
  constexpr double bound = 2.0 * k * 0x1p-24;
  CHECK(relative_difference(of_lanes.irradiance, of_vectors.irradiance) <= bound);
  // Another order it is: equal bits would say that one backend was compared with itself.
  CHECK(relative_difference(of_lanes.irradiance, of_vectors.irradiance) > 0);
}

// On runtimes that have them: tests/runtimes fails where this one says that there are none.
TEST_CASE("shuffles give lanes the bits of local memory", "[slow][shuffles]") {
  if (!device().info().shuffles) {
    WARN("this device has no shuffles");
    return;
  }
  for (const Kind& kind : {kinds[0], Kind{"glossy, several lights", 3, true},
                           Kind{"clipped", 3, false, AreaMode::clipped}}) {
    for (const int width : {16, 32}) {
      const Subject subject(kind, 61);
      EstimateTuning tuning = lanes(width);
      const LightTable plain = subject.estimate(tuning, k, kind.area);
      tuning.shuffles = true;
      CAPTURE(kind.name, width);
      check(kind, tuning, k, 61);
      const LightTable shuffled = subject.estimate(tuning, k, kind.area);
      CHECK(shuffled.irradiance == plain.irradiance);
      CHECK(shuffled.radiance == plain.radiance);
    }
  }
}

TEST_CASE("lanes that take hits in turn estimate the bits of each alone", "[slow]") {
  const Subject subject({"several lights", 3}, 62);
  EstimateTuning tuning = lanes(32);
  REQUIRE(tuning.hits_per_item > 1);
  const LightTable in_turn = subject.estimate(tuning, k, AreaMode::clipped);
  tuning.hits_per_item = 1;
  CHECK(subject.estimate(tuning, k, AreaMode::clipped).irradiance == in_turn.irradiance);
}

}  // namespace photile::test
