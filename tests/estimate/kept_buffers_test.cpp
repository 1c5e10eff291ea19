// Memory of batches that is kept from call to call.
#include <algorithm>
#include <catch2/catch.hpp>

#include "device/context.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.2;

/// Two plates 10 m apart.
Scene two_plates() {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  test::add_plate(scene, {10, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  return scene;
}

/// The photons of the first plate alone.
Photons photons_on_one(const Scene& scene) {
  Scene first = test::empty_scene();
  test::add_plate(first, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  Photons photons = test::uniform_photons(first, 5'000, 7);
  photons.first_of.resize(2 * scene.triangle_count() + 1, photons.first_of.back());
  return photons;
}

/// The hits that lie on the first plate, or on the second.
PrimaryHits on_plate(const PrimaryHits& hits, bool second) {
  PrimaryHits result;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if ((hits.position[i].x > 5) != second) continue;
    result.position.push_back(hits.position[i]);
    result.oriented_face.push_back(hits.oriented_face[i]);
    result.diffuse_albedo.push_back(hits.diffuse_albedo[i]);
  }
  return result;
}

PhotonMaps maps_on(Device& device, const Scene& scene, const Photons& photons) {
  return {device,
          scene,
          photons,
          find_map_groups(scene, photons, MapMode::automatic, {radius}),
          {.radius = radius}};
}

}  // namespace

TEST_CASE("hits without photons are dark, whatever the hits before them were") {
  const Scene scene = two_plates();
  const Photons photons = photons_on_one(scene);
  const PhotonMaps maps = maps_on(test::device(), scene, photons);
  const PrimaryHits hits = test::uniform_hits(scene, 2'000, 8);
  Estimator estimator(maps, scene, {});
  const LightTable lit = estimator.estimate(on_plate(hits, false));
  REQUIRE(lit.irradiance.size() > 900);
  for (const glm::vec3& irradiance : lit.irradiance) REQUIRE(irradiance.x > 0);
  const PrimaryHits far_hits = on_plate(hits, true);
  const LightTable dark = estimator.estimate(far_hits);  // about as many
  REQUIRE(dark.irradiance.size() == far_hits.size());
  for (const glm::vec3& irradiance : dark.irradiance) REQUIRE(irradiance == glm::vec3(0));
}

TEST_CASE("hits of several batches are those of calls of their own") {
  const Scene scene = two_plates();
  const Photons photons = photons_on_one(scene);
  const PhotonMaps maps = maps_on(test::device(), scene, photons);
  // More than two batches where one is sent while another is computed.
  const PrimaryHits hits = test::uniform_hits(scene, 300'001, 9);
  Estimator estimator(maps, scene, {.neighbours = 5});
  const LightTable together = estimator.estimate(hits);
  REQUIRE(together.irradiance.size() == hits.size());
  constexpr std::size_t part = 70'001;
  for (std::size_t begin = 0; begin < hits.size(); begin += part) {
    const LightTable alone = estimator.estimate(hits, begin, std::min(part, hits.size() - begin));
    CHECK(std::equal(alone.irradiance.begin(), alone.irradiance.end(),
                     together.irradiance.begin() + static_cast<std::ptrdiff_t>(begin)));
  }
}

TEST_CASE("what batches leave behind makes room where memory runs out") {
  const Scene scene = two_plates();
  const Photons photons = photons_on_one(scene);
  constexpr std::uint64_t memory = 32u << 20;
  DeviceOptions options;
  options.memory_bytes = memory;
  Device device(options);
  const PhotonMaps maps = maps_on(device, scene, photons);
  const PrimaryHits hits = on_plate(test::uniform_hits(scene, 2'000, 8), false);
  Estimator estimator(maps, scene, {});
  const LightTable expected = estimator.estimate(hits);
  device::Context& context = device::context_of(device);
  {
    // The maps stay.
    const std::uint64_t maps_bytes = context.allocated_bytes();
    const auto rest = context.allocate<std::uint8_t>(memory - maps_bytes, "the rest");
    CHECK(context.allocated_bytes() == memory);
  }
  CHECK(estimator.estimate(hits).irradiance == expected.irradiance);
}

}  // namespace photile::test
