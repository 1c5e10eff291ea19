// Irradiance and reflected radiance of every hit against brute force in double precision.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "neighbour_comparison.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

using namespace photile;

namespace {

/// Largest relative difference over hits and lights. Sums of k positive floats are right to k units
/// of 2^-24, the area to a few.
double tolerance(int k) { return (static_cast<double>(k) + 16.0) / (1 << 24); }

void check_irradiance(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                      double radius, int k) {
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const std::size_t lights = scene.lights.size();
  std::vector<std::vector<glm::dvec3>> expected;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    expected.push_back(oracle.irradiance(hits.position[hit], hits.sided_triangle[hit], k,
                                         static_cast<float>(radius)));
  }
  for (const MapStructure structure : all_map_structures) {
    const PhotonMaps maps(test::device(), scene, photons, groups, {radius, 4, structure});
    const Estimates estimates = Estimator(maps, scene, {k, 0}).estimate(hits);
    REQUIRE(estimates.irradiance.size() == hits.size() * lights);
    CHECK(estimates.radiance.empty());
    double worst = 0;
    for (std::size_t hit = 0; hit < hits.size(); ++hit) {
      for (std::size_t light = 0; light < lights; ++light) {
        for (int c = 0; c < 3; ++c) {
          const double truth = expected[hit][light][c];
          const double difference = std::abs(estimates.irradiance[hit * lights + light][c] - truth);
          worst = std::max(worst, difference / std::max(truth, 1e-30));
        }
      }
    }
    CAPTURE(name_of(structure), k, radius, lights);
    CHECK(worst <= tolerance(k));
  }
}

}  // namespace

TEST_CASE("irradiance equals the oracle's for one light") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3);
  const Photons photons = test::uniform_photons(scene, 6000, 51);
  const PrimaryHits hits = test::uniform_hits(scene, 300, 52);
  for (const int k : {1, 2, 16, 50, 400}) check_irradiance(scene, photons, hits, 0.2, k);
}

TEST_CASE("irradiance equals the oracle's per light, for 2 and 40 lights") {
  for (const std::size_t lights : {2u, 40u}) {
    Scene scene = test::empty_scene(lights);
    test::add_torus(scene, 1.0f, 0.4f, 24, 12);
    const Photons photons = test::uniform_photons(scene, 20'000, 53);
    check_irradiance(scene, photons, test::uniform_hits(scene, 200, 54), 0.3, 50);
  }
}

TEST_CASE("with fewer than k photons within the radius the full disc counts") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  const Photons photons = test::uniform_photons(scene, 60, 55);
  check_irradiance(scene, photons, test::uniform_hits(scene, 100, 56), 0.1, 50);
}

TEST_CASE("photons in one point: ties share the estimate as the oracle says") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  std::mt19937_64 random(57);
  Photons photons;
  for (int i = 0; i < 2000; ++i) {
    test::add_photon(photons, scene, {0.5f, 0.25f, 0}, 0, random);
  }
  photons = sort_by_sided_triangle(std::move(photons), 4);
  PrimaryHits hits = test::uniform_hits(scene, 50, 58, false);
  hits.position[0] = {0.5f, 0.25f, 0};
  check_irradiance(scene, photons, hits, 0.5, 50);
}

TEST_CASE("glossy radiance equals the BSDF summed over the oracle's neighbours in double") {
  Scene scene = test::empty_scene(2);
  scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
  scene.materials[0].roughness = 0.3f;
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  const Photons photons = test::uniform_photons(scene, 5000, 59);
  REQUIRE(photons.incoming.size() == photons.size());
  PrimaryHits hits = test::uniform_hits(scene, 100, 60);
  std::mt19937_64 random(61);
  std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const glm::vec3 normal = glm::vec3(sided_normal(scene, hits.sided_triangle[i]));
    hits.outgoing.push_back(
        glm::normalize(normal + glm::vec3(uniform(random), uniform(random), uniform(random))));
    hits.lobe.push_back({scene.materials[0].specular, scene.materials[0].roughness, normal});
  }
  const double radius = 0.2;
  const int k = 50;
  const PhotonMaps maps(test::device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  const Estimates estimates = Estimator(maps, scene, {k, 0}).estimate(hits);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);

  // The model of glTF 2.0, appendix B, written down afresh in double precision.
  const auto bsdf = [](glm::dvec3 i, glm::dvec3 o, glm::dvec3 n, double albedo, double f0,
                       double alpha) {
    const glm::dvec3 h = glm::normalize(i + o);
    const double fresnel = f0 + (1 - f0) * std::pow(1 - glm::dot(i, h), 5.0);
    const double ni = glm::dot(n, i), no = glm::dot(n, o), nh = glm::dot(n, h);
    double lobe = 0;
    if (ni > 0 && no > 0) {
      const double a2 = alpha * alpha;
      const double d = a2 / (glm::pi<double>() * std::pow(nh * nh * (a2 - 1) + 1, 2.0));
      const double visibility =
          0.5 / (no * std::sqrt(ni * ni * (1 - a2) + a2) + ni * std::sqrt(no * no * (1 - a2) + a2));
      lobe = d * visibility;
    }
    return (1 - fresnel) * albedo / glm::pi<double>() + fresnel * lobe;
  };

  double worst = 0;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const auto near =
        oracle.nearest(hits.position[hit], hits.sided_triangle[hit], k, static_cast<float>(radius));
    const std::size_t used = near.photons.size() == k ? k - 1u : near.photons.size();
    std::vector<glm::dvec3> expected(2, glm::dvec3(0.0));
    for (std::size_t n = 0; n < used; ++n) {
      const std::uint32_t photon = near.photons[n];
      for (int c = 0; c < 3; ++c) {
        expected[photons.light[photon]][c] +=
            double{photons.flux[photon][c]} *
            bsdf(photons.incoming[photon], hits.outgoing[hit], hits.lobe[hit].normal,
                 hits.diffuse_albedo[hit][c], hits.lobe[hit].specular[c],
                 hits.lobe[hit].roughness) /
            (glm::pi<double>() * near.squared_radius);
      }
    }
    for (std::size_t light = 0; light < 2; ++light) {
      for (int c = 0; c < 3; ++c) {
        const double difference =
            std::abs(estimates.radiance[hit * 2 + light][c] - expected[light][c]);
        worst = std::max(worst, difference / std::max(expected[light][c], 1e-30));
      }
    }
  }
  // The lobe's peak amplifies the rounding of the half vector by 1 / alpha^2.
  CHECK(worst <= tolerance(k) * 12.0);
}
