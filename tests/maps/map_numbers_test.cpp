// Only maps that photons come near are numbered, and take memory.
#include <catch2/catch.hpp>

#include "maps/candidate_maps.hpp"
#include "photile/device.hpp"
#include "photile/photon_maps.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

/// Plates of 4 x 4 squares, 1 m wide, side by side 3 m apart.
Scene plates(int count) {
  Scene scene = test::empty_scene();
  for (int i = 0; i < count; ++i) {
    test::add_plate(scene, {3.0f * static_cast<float>(i), 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  }
  return scene;
}

/// Photons on the first `lit` plates of `count`.
Photons photons_on(int lit, int count, const Scene& scene) {
  std::mt19937_64 random(9);
  Photons photons;
  const auto per_plate =
      static_cast<std::uint32_t>(scene.triangle_count()) / static_cast<std::uint32_t>(count);
  for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(lit) * per_plate; ++t) {
    for (int i = 0; i < 4; ++i) {
      test::add_photon(photons, scene, test::random_point(scene, t, random), sided(t, 0), random);
    }
  }
  return sort_by_sided_triangle(std::move(photons), 2 * scene.triangle_count());
}

struct Built {
  std::uint64_t map_bytes, peak_bytes;
};

Built build(int lit, int count, MapMode mode) {
  const Scene scene = plates(count);
  const Photons photons = photons_on(lit, count, scene);
  Device device;
  const NeighbourGroups groups =
      find_patch_groups(scene, find_patches(scene, 0.2, mode), {0.2, 60});
  const PhotonMaps maps(device, scene, photons, groups, {0.2, 4});
  return {maps.statistics().device_bytes, device.peak_allocated_bytes()};
}

}  // namespace

TEST_CASE("numbers ascend without gaps; what no photon comes near has none") {
  maps::CandidateMaps candidates;
  candidates.members = {3, 8, 9, 3, 12};
  const maps::MapNumbers numbers = maps::number_maps(candidates, {}, 16);
  CHECK(numbers.pairs == std::vector<std::uint32_t>{1, 4, 6});
  CHECK(candidates.members == std::vector<std::uint32_t>{1, 2, 3, 1, 4});
  CHECK(numbers.map_of == std::vector<std::uint32_t>{none, none, 0, 1, none, none, none, none,  //
                                                     2, 3, none, none, 4, 5, none, none});
  const std::vector<float> values = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  CHECK(maps::of_numbered(numbers, values) == std::vector<float>{2, 3, 8, 9, 12, 13});
}

TEST_CASE("device memory is that of the places with light, not of the 1,000 places there are") {
  for (const MapMode mode : {MapMode::triangle, MapMode::patch}) {
    CAPTURE(mode == MapMode::patch);
    const Built alone = build(10, 10, mode), among = build(10, 1000, mode);
    // Maps reach 3 mm farther in a scene 3 km long, since its positions are rounded more.
    CHECK(static_cast<double>(among.map_bytes) ==
          Approx(static_cast<double>(alone.map_bytes)).epsilon(0.03));
    // Other devices than CPUs hold copies of the host's arrays of triangles while they build.
    if (test::device().info().type == DeviceType::cpu) {
      CHECK(static_cast<double>(among.peak_bytes) ==
            Approx(static_cast<double>(alone.peak_bytes)).epsilon(0.03));
    }
    CHECK(static_cast<double>(build(20, 1000, mode).map_bytes) ==
          Approx(2.0 * static_cast<double>(among.map_bytes)).epsilon(0.05));
  }
}

}  // namespace photile::test
