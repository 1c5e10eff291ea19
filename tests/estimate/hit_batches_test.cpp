// Hits in batches of any size.
#include <cstring>

#include "device/context.hpp"
#include "estimate/hit_buffers.hpp"
#include "neighbour_comparison.hpp"
#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

using estimate::HitBatches;
using estimate::HitBatchNeeds;
using estimate::plan_hit_batch;

// How many hits are estimated at a time, at the limits of devices that no machine here has.

constexpr std::uint64_t gib = 1ull << 30;

/// One light: 12 bytes out, 16 in.
constexpr HitBatchNeeds one_light_needs{.largest_bytes_per_hit = 12, .bytes_per_hit = 28};
/// 10,000 lights.
constexpr HitBatchNeeds many_lights_needs{.largest_bytes_per_hit = 120'000,
                                          .bytes_per_hit = 120'016};

TEST_CASE("with memory to spare a batch is a million hits") {
  CHECK(plan_hit_batch(one_light_needs, 16 * gib, 64 * gib) == 1u << 20);
}

TEST_CASE("no index into a batch's outputs passes 32 bits, however large the device's buffers") {
  for (const std::uint64_t bytes : {12ull, 84ull, 120'000ull, 4'000'000ull}) {
    const std::uint64_t hits =
        plan_hit_batch({.largest_bytes_per_hit = bytes, .bytes_per_hit = bytes + 16}, ~0ull, ~0ull);
    CAPTURE(bytes, hits);
    CHECK(hits * bytes <= 0xFFFF'FFFFull);
    CHECK((hits == 1u << 20 || (hits + 1) * bytes > 0xFFFF'FFFFull));
  }
}

TEST_CASE("a batch takes a quarter of the memory and no buffer beyond the largest") {
  const std::uint64_t hits = plan_hit_batch(many_lights_needs, gib / 4, gib);
  CHECK(hits * many_lights_needs.bytes_per_hit <= gib / 4);
  CHECK((hits + 1) * many_lights_needs.bytes_per_hit > gib / 4);
  CHECK(plan_hit_batch(many_lights_needs, 240'000, gib) == 2);
  CHECK(plan_hit_batch(many_lights_needs, 1, 1) == 1);
}

TEST_CASE("work that fails for want of memory is repeated with half the hits, then stays so") {
  HitBatches batches(device::context_of(device()));
  std::vector<std::pair<std::size_t, std::size_t>> done;
  int failures = 0;
  const auto work = [&](std::size_t first, std::size_t count) {
    if (count > 30) {
      ++failures;
      throw DeviceMemoryError("too many");
    }
    done.emplace_back(first, count);
  };
  batches.run(100, one_light_needs, work);
  const std::vector<std::pair<std::size_t, std::size_t>> quarters{
      {0, 25}, {25, 25}, {50, 25}, {75, 25}};
  CHECK(done == quarters);
  CHECK(failures == 2);
  batches.run(100, one_light_needs, work);
  CHECK(failures == 2);
}

TEST_CASE("a single hit that does not fit is an error") {
  HitBatches batches(device::context_of(device()));
  CHECK_THROWS_AS(batches.run(7, one_light_needs,
                              [](std::size_t, std::size_t) { throw DeviceMemoryError("none"); }),
                  DeviceMemoryError);
}

// Numbers of photons and hits that fit no work-group, vector or batch.

Scene plate() { return scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2}}); }

/// `count` hits that repeat those of `base`, in their order.
PrimaryHits repeat(const PrimaryHits& base, std::size_t count) {
  PrimaryHits hits;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * base.size() / count;
    hits.position.push_back(base.position[from]);
    hits.oriented_face.push_back(base.oriented_face[from]);
  }
  return hits;
}

TEST_CASE("a hit's estimate is the same bits, however many hits are estimated with it") {
  const Scene scene = plate();
  const Photons photons = uniform_photons(scene, 4096, 81);
  const PrimaryHits base = uniform_hits(scene, 93, 82);
  // The last one is more than a batch.
  const std::size_t count =
      GENERATE(0u, 1u, 7u, 63u, 64u, 65u, 93u, 4096u, (std::size_t{1} << 20) + 1);
  const PrimaryHits hits = repeat(base, count);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {0.2, 60}),
                        {0.2, 4});
  Estimator estimator(maps, scene, {16, 0});
  const LightTable expected = estimator.estimate(base);
  const LightTable estimates = estimator.estimate(hits);
  REQUIRE(estimates.irradiance.size() == count);
  std::size_t differences = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3& alone = expected.irradiance[i * base.size() / count];
    differences += std::memcmp(&alone, &estimates.irradiance[i], sizeof alone) != 0;
  }
  CHECK(differences == 0);
}

TEST_CASE("neighbours equal the oracle's among 2^20 + 1 photons") {
  const Scene scene = plate();
  const Photons photons = uniform_photons(scene, (std::size_t{1} << 20) + 1, 83);
  const PrimaryHits hits = uniform_hits(scene, 17, 84);
  const double radius = 0.05;
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  for (const structures::Structure& structure : structures::all()) {
    if (!structure.global && structure.name != "uniform-grid") continue;
    const PhotonMaps maps =
        structures::build(structure, device(), scene, photons, groups, {radius, 4});
    for (const int k : {1, 50, 100'000}) {
      Estimator estimator(maps, scene, {k, 0});
      CAPTURE(structure.name, k);
      CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons,
                              static_cast<float>(radius)) == 0);
    }
  }
}

// Memory of batches that is kept from call to call.

constexpr double radius = 0.2;

/// Two plates 10 m apart.
Scene two_plates() {
  return scene_of_plates(
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4}, {{10, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4}});
}

/// The photons of the first plate alone.
Photons photons_on_one(const Scene& scene) {
  Scene first = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4}});
  Photons photons = uniform_photons(first, 5'000, 7);
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

TEST_CASE("hits without photons are dark, whatever the hits before them were") {
  const Scene scene = two_plates();
  const Photons photons = photons_on_one(scene);
  const PhotonMaps maps = maps_on(device(), scene, photons);
  const PrimaryHits hits = uniform_hits(scene, 2'000, 8);
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
  const PhotonMaps maps = maps_on(device(), scene, photons);
  // More than two batches where one is sent while another is computed.
  const PrimaryHits hits = uniform_hits(scene, 300'001, 9);
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
  const PrimaryHits hits = on_plate(uniform_hits(scene, 2'000, 8), false);
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

}  // namespace
}  // namespace photile::test
