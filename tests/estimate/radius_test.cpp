// Any radius of search: the illuminance of a closed box where the radius reaches photons, a refusal
// where arithmetic cannot hold it, never a signal.
#include <catch2/catch.hpp>

#include "estimates_comparison.hpp"
#include "oracle/clipped_area.hpp"
#include "photile/errors.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/sensors.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// A room of 1 m, all of its walls alike, with a lamp of 1 lm in the middle.
constexpr float albedo = 0.5f;

Scene closed_box() {
  Scene scene = test::closed_box(diffuse(albedo));
  scene.lights[0].position = glm::vec3(0.5f);
  return scene;
}

std::vector<Sensor> sensors_on_walls() {
  constexpr int side = 6;
  std::vector<Sensor> sensors;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double wall : {0.0, 1.0}) {
      for (int i = 0; i < side * side; ++i) {
        glm::dvec3 position, normal(0.0);
        position[axis] = wall;
        position[(axis + 1) % 3] = (i % side + 0.5) / side;
        position[(axis + 2) % 3] = (i / side + 0.5) / side;
        normal[axis] = 1 - 2 * wall;
        sensors.push_back({position, normal});
      }
    }
  }
  return sensors;
}

double mean_illuminance(const Scene& scene, double radius) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 200'000;
  parameters.radius = radius;
  const std::vector<Sensor> sensors = sensors_on_walls();
  const RenderResult result = measure(scene, sensors, std::span(&device(), 1), parameters);
  double sum = 0;
  const auto dense = result.layers.dense();
  for (const float value : dense.layers.at(0).illuminance) {
    REQUIRE(std::isfinite(value));
    REQUIRE(value >= 0);
    sum += double{value};
  }
  return sum / static_cast<double>(sensors.size());
}

}  // namespace

TEST_CASE("any radius that reaches photons gives a closed box its illuminance") {
  const double radius = GENERATE(0.02, 0.1, 1.0, 10.0, 1e3, 1e6, 1e12, 1e25, 1e38);
  CAPTURE(radius);
  // All light ends in the walls, 6 m2 that keep half of what falls on them. 216 sensors with a
  // noise of 14% each leave 1%.
  CHECK(mean_illuminance(closed_box(), radius) ==
        Approx(1 / (6 * (1 - double{albedo}))).epsilon(0.04));
}

TEST_CASE(
    "a radius too small to reach photons reads finite values, those that no float holds are "
    "refused") {
  const Scene scene = closed_box();
  for (const double radius : {1e-3, 1e-5, 1e-8}) {
    CAPTURE(radius);
    CHECK(mean_illuminance(scene, radius) >= 0);
  }
  for (const double radius : {1e-10, 1e-15, 1e-23, 1e-25, 1e-40, 1e-320, 1e39, 1e300}) {
    CAPTURE(radius);
    CHECK_THROWS_WITH(mean_illuminance(scene, radius), Catch::Contains("radius"));
    CHECK_THROWS_AS(mean_illuminance(scene, radius), UsageError);
  }
}

TEST_CASE("estimates over radii from 1e-5 m to beyond all scenes are the oracle's") {
  // Hits lie on photons, so that the smallest disc holds one; a fold, a border and regions of one
  // triangle and of many are among what clips it.
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0}, 1},
                                 {{1, 0, 0}, {0.6f, 0, 0.3f}, {0.3f, 1, 0}, 12},
                                 {{0, 0, -0.01f}, {0.5f, 0, 0}, {0, 0.5f, 0}, 2}});
  const Photons photons = uniform_photons(scene, 3000, 171);
  PrimaryHits hits;
  for (std::size_t i = 0; i < photons.size(); i += 20) {
    add_grey_hit(hits, photons.position[i], photons.oriented_face[i]);
  }
  hits.pixel.resize(hits.size());
  // Coordinates of 1 m are right to 6e-8 m: of smaller discs rounding tells what lies in them.
  const double radius = GENERATE(1e-5, 1e-4, 1e-3, 0.1, 1.0, 1e2, 1e5, 1e9, 1e13);
  CAPTURE(radius);
  const SurfaceIndex surface = index_surface(scene, landed_on(scene, photons), radius, 60);
  const reference::ClippedArea area(scene, photons, surface, 60);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  for (const AreaMode mode : all_area_modes) {
    EstimateParameters parameters;
    parameters.area = mode;
    const LightTable estimates = Estimator(maps, scene, parameters).estimate(hits);
    ExpectedEstimates expected;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const glm::vec3 hit = hits.position[i];
      const std::uint32_t own = hits.oriented_face[i];
      const double searched = static_cast<float>(radius);
      expected.push_back(mode == AreaMode::disc ? oracle.irradiance(hit, own, 50, searched)
                                                : oracle.irradiance(area, hit, own, 50, searched));
    }
    CAPTURE(name_of(mode));
    CHECK(worst_difference(by_light(estimates.irradiance, estimates, 1), expected) <= 1e-3);
  }
}

TEST_CASE("maps, groups and surfaces refuse radii that arithmetic cannot hold") {
  const Scene scene = closed_box();
  const Photons photons = uniform_photons(scene, 100, 172);
  for (const double radius : {-1.0, 0.0, 1e-20, 1e25, std::nan("")}) {
    CAPTURE(radius);
    CHECK_THROWS_AS(index_surface(scene, landed_on(scene, photons), radius, 60), UsageError);
    const NeighbourGroups groups = find_neighbour_groups(scene, {1.0, 60});
    CHECK_THROWS_AS(PhotonMaps(device(), scene, photons, groups, {radius}), UsageError);
  }
  CHECK_THROWS_AS(find_neighbour_groups(scene, {1e25, 60}), UsageError);
}

}  // namespace photile::test
