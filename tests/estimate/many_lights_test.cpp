// Lights are independent of each other: what a scene's other lights are does not change a layer.
#include <catch2/catch.hpp>
#include <set>

#include "estimates_comparison.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.2;
constexpr int k = 50;

Scene plate(std::size_t lights, bool glossy) {
  Scene scene = empty_scene(lights);
  if (glossy) {
    scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
    scene.materials[0].roughness = 0.3f;
  }
  add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  return scene;
}

LightTable estimate(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                    int neighbours = k) {
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  return Estimator(maps, scene, {neighbours, 0}).estimate(hits);
}

/// Photons of which only those of one light carry flux: the neighbours stay.
Photons alone(Photons photons, std::uint16_t light) {
  for (std::size_t i = 0; i < photons.size(); ++i) {
    if (photons.light[i] != light) photons.flux[i] = glm::vec3(0.0f);
  }
  photons.light.clear();
  return photons;
}

/// Sums of at most k positive floats in another order: each is right to k units of 2^-24, and two
/// of them are compared. The factor of the glossy lobe is the same in both, bit for bit.
double tolerance_of(int neighbours) { return 2.0 * neighbours / (1 << 24); }

double difference(const std::vector<glm::vec3>& values, const std::vector<glm::vec3>& others) {
  REQUIRE(values.size() == others.size());
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double scale = std::max({values[i][c], others[i][c], 1e-30f});
      worst = std::max(worst, std::abs(double{values[i][c]} - others[i][c]) / scale);
    }
  }
  return worst;
}

std::vector<glm::vec3> layer(const std::vector<glm::vec3>& dense, std::size_t light,
                             std::size_t lights) {
  std::vector<glm::vec3> values;
  for (std::size_t i = light; i < dense.size(); i += lights) values.push_back(dense[i]);
  return values;
}

}  // namespace

TEST_CASE("each light's estimates are those of its photons alone", "[long]") {
  const std::size_t lights = GENERATE(5u, 64u);
  const bool glossy = GENERATE(false, true);
  // More than kernels list before they add, too.
  const int neighbours = GENERATE(as<int>(), k, 200);
  const double tolerance = tolerance_of(neighbours);
  CAPTURE(lights, glossy, neighbours);
  const Scene scene = plate(lights, glossy);
  const Photons photons = uniform_photons(scene, 4000, 91);
  PrimaryHits hits = uniform_hits(scene, 150, 92);
  if (glossy) add_lobes(hits, scene, 93);
  const LightTable together = estimate(scene, photons, hits, neighbours);
  const auto irradiance = by_light(together.irradiance, together, lights);
  const auto radiance = by_light(together.radiance, together, lights);
  for (const std::size_t light : {std::size_t{0}, std::size_t{3}, lights - 1}) {
    const LightTable one = estimate(
        plate(1, glossy), alone(photons, static_cast<std::uint16_t>(light)), hits, neighbours);
    CAPTURE(light);
    CHECK(difference(layer(irradiance, light, lights), one.irradiance) <= tolerance);
    if (glossy) CHECK(difference(layer(radiance, light, lights), one.radiance) <= tolerance);
  }
}

TEST_CASE(
    "a light without photons changes nothing: eight lights dense, and sparse beside a ninth") {
  const Scene dense_scene = plate(8, false);
  const Photons photons = uniform_photons(dense_scene, 4000, 94);
  const PrimaryHits hits = uniform_hits(dense_scene, 150, 95);
  const LightTable dense = estimate(dense_scene, photons, hits);
  const LightTable sparse = estimate(plate(9, false), photons, hits);
  REQUIRE(dense.first.empty());
  REQUIRE(sparse.first.size() == hits.size() + 1);
  const auto nine = by_light(sparse.irradiance, sparse, 9);
  for (std::size_t light = 0; light < 8; ++light) {
    CHECK(difference(layer(nine, light, 9), layer(dense.irradiance, light, 8)) <= tolerance_of(k));
  }
}

TEST_CASE("a hit keeps the lights that reach it, each once, however many there are") {
  // Each quarter of the plate is lit by three lights of its own among 1,000. Their numbers differ
  // by a power of two, so that they meet in any smaller hash table.
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2}}, 1000);
  Photons photons = uniform_photons(scene, 8000, 96);
  const auto quarter_of = [](const glm::vec3& p) {
    return (p.x < 0.5f ? 0 : 1) + (p.y < 0.5f ? 0 : 2);
  };
  for (std::size_t i = 0; i < photons.size(); ++i) {
    photons.light[i] = static_cast<std::uint16_t>(quarter_of(photons.position[i]) + 256 * (i % 3));
  }
  const PrimaryHits hits = uniform_hits(scene, 200, 97);
  const LightTable estimates = estimate(scene, photons, hits);
  REQUIRE(estimates.first.size() == hits.size() + 1);
  CHECK(estimates.first.front() == 0);
  CHECK(estimates.first.back() == estimates.light.size());
  CHECK(estimates.irradiance.size() == estimates.light.size());
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const auto begin = estimates.light.begin() + static_cast<std::ptrdiff_t>(estimates.first[hit]);
    const auto end =
        estimates.light.begin() + static_cast<std::ptrdiff_t>(estimates.first[hit + 1]);
    const std::set<std::uint16_t> found(begin, end);
    CHECK(found.size() == static_cast<std::size_t>(end - begin));
    const glm::vec3& p = hits.position[hit];
    // The disc of 50 among 1,000 photons per square metre and side has a radius of 0.13.
    const bool inside = std::abs(p.x - 0.5f) > 0.2f && std::abs(p.y - 0.5f) > 0.2f;
    if (!inside) continue;
    const int first = quarter_of(p);
    CHECK(found == std::set<std::uint16_t>{static_cast<std::uint16_t>(first),
                                           static_cast<std::uint16_t>(first + 256),
                                           static_cast<std::uint16_t>(first + 512)});
  }
}

TEST_CASE("estimates for fewer neighbours than kernels are compiled for keep to their buffers",
          "[buffers]") {
  // Levels of k and later passes share kernels with a larger k. Lights around the limits of dense
  // layers, of k and of the hash table; behind the fence an index too far ends the process.
  constexpr int compiled = 20;
  const auto lights = static_cast<std::size_t>(GENERATE(8, 13, 70));
  const bool glossy = lights == 13;
  Scene scene = plate(lights, glossy);
  const Photons photons = uniform_photons(scene, 2000, 98);
  PrimaryHits hits = uniform_hits(scene, 64, 99);
  if (glossy) add_lobes(hits, scene, 93);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  for (const std::string_view structure : {"uniform-grid", "kdtree-3d"}) {
    const PhotonMaps maps = structures::build(structures::named(structure), device(), scene,
                                              photons, groups, {radius, 4});
    for (const int neighbours : {1, 5, 12, compiled}) {
      CAPTURE(lights, neighbours, structure);
      EstimateParameters parameters;
      parameters.neighbours = neighbours;
      parameters.compiled_neighbours = compiled;
      parameters.area = AreaMode::disc;
      const LightTable estimates = Estimator(maps, scene, parameters).estimate(hits);
      ExpectedEstimates expected;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        expected.push_back(
            oracle.irradiance(hits.position[i], hits.oriented_face[i], neighbours, radius));
      }
      CHECK(worst_difference(by_light(estimates.irradiance, estimates, lights), expected) <= 1e-5);
    }
  }
}

TEST_CASE("any number of lights up to 70 and any level of k keep to their buffers",
          "[buffers][slow]") {
  constexpr int compiled = 50;
  const auto lights = static_cast<std::size_t>(GENERATE(range(1, 71)));
  const Scene scene = plate(lights, false);
  const Photons photons = uniform_photons(scene, 2000, 98);
  const PrimaryHits hits = uniform_hits(scene, 64, 99);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  for (const int neighbours : {1, 3, 6, 12, 13, 25, 50}) {
    CAPTURE(lights, neighbours);
    EstimateParameters parameters;
    parameters.neighbours = neighbours;
    parameters.compiled_neighbours = compiled;
    const LightTable shared = Estimator(maps, scene, parameters).estimate(hits);
    // The sum of one light is known: it is that of all lights. Slots that overlap would change it.
    const Scene single = plate(1, false);
    Photons together = photons;
    together.light.clear();
    const PhotonMaps single_maps(device(), single, together,
                                 find_neighbour_groups(single, {radius, 60}), {radius, 4});
    const LightTable sums = Estimator(single_maps, single, parameters).estimate(hits);
    const auto by_light = test::by_light(shared.irradiance, shared, lights);
    std::vector<glm::vec3> all(hits.size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i < by_light.size(); ++i) all[i / lights] += by_light[i];
    CHECK(difference(all, sums.irradiance) <= tolerance_of(neighbours));
  }
}

}  // namespace photile::test
