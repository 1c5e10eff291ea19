// The cone of the density estimate over whole discs against brute force in double precision, for
// every structure and strategy, few lights and many, diffuse and glossy.

#include "oracle_checks.hpp"
#include "photon_sets.hpp"
#include "test_tunings.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.3;
constexpr DensityKernel kernel = DensityKernel::cone;

struct Subject {
  Scene scene;
  Photons photons;
  PrimaryHits hits;

  explicit Subject(std::size_t lights, std::size_t photon_count = 20'000)
      : scene(empty_scene(lights)) {
    add_torus(scene, 1.0f, 0.4f, 24, 12);
    photons = uniform_photons(scene, photon_count, 53);
    hits = uniform_hits(scene, 200, 54);
  }

  LightTable estimate(int k, std::string_view structure = "uniform-grid",
                      const std::optional<EstimateTuning>& tuning = std::nullopt) const {
    const PhotonMaps maps =
        structures::build(structures::named(structure), device(), scene, photons,
                          find_neighbour_groups(scene, {radius, 60}), {radius, 4});
    EstimateParameters parameters{.neighbours = k, .area = AreaMode::disc, .kernel = kernel};
    parameters.tuning = tuning;
    return Estimator(maps, scene, parameters).estimate(hits);
  }
};

/// Largest difference from the truth over what the photons would read at a weight of 1: a weight is
/// right to a few units of 2^-24, however small it is.
double worst_difference(const Subject& subject, const LightTable& estimates, int k) {
  const reference::DensityOracle oracle(subject.scene, subject.photons,
                                        reference::PhotonFilter::grouped, 60);
  const auto truth = expected_irradiance(oracle, subject.hits, k, radius, kernel);
  const auto scale = expected_irradiance(oracle, subject.hits, k, radius);
  const std::size_t lights = subject.scene.lights.size();
  const auto irradiance = by_light(estimates.irradiance, estimates, lights);
  REQUIRE(irradiance.size() == subject.hits.size() * lights);
  double worst = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    const glm::dvec3 of_truth = truth[i / lights][i % lights];
    const double difference = std::abs(irradiance[i].g - of_truth.g);
    if (difference > 0) worst = std::max(worst, difference / scale[i / lights][i % lights].g);
  }
  return worst;
}

/// Over the mean weight of a third.
double tolerance(int k) { return 3 * estimate_tolerance(k); }

void check_strategies(const Subject& subject, int k) {
  for (const EstimateTuning& tuning : tunings_of(device().info())) {
    CAPTURE(name_of(tuning.strategy));
    const LightTable estimates = subject.estimate(k, "uniform-grid", tuning);
    CHECK(worst_difference(subject, estimates, k) <= tolerance(k));
  }
}

}  // namespace

TEST_CASE("weighted irradiance equals the oracle's for every kind of structure and strategy") {
  const Subject subject(3);
  constexpr int k = 50;
  for (const char* const structure : checked_structures) {
    CAPTURE(structure);
    const LightTable estimates = subject.estimate(k, structure);
    CHECK(worst_difference(subject, estimates, k) <= tolerance(k));
  }
  check_strategies(subject, k);
}

TEST_CASE("weighted irradiance equals the oracle's for one light and for many, for any k") {
  const std::size_t lights = GENERATE(1u, 40u);
  const Subject subject(lights);
  for (const int k : {1, 400}) {
    CAPTURE(lights, k);
    CHECK(worst_difference(subject, subject.estimate(k), k) <= tolerance(k));
  }
}

TEST_CASE("with fewer than k photons within the radius weights go by the full radius") {
  const Subject subject(1, 400);
  constexpr int k = 50;
  check_strategies(subject, k);
}

}  // namespace photile::test
