// A start is paid per program: what is built for maps and an estimate.
#include <catch2/catch.hpp>

#include "estimate/device_test.hpp"
#include "estimate/photon_estimate.hpp"
#include "photile/estimator.hpp"
#include "photon_sets.hpp"
#include "render/kernel_preparation.hpp"

namespace photile::test {

TEST_CASE("building maps and estimating from them take one program each") {
  Scene scene = test::empty_scene(GENERATE(1u, 3u));
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
  const Photons photons = test::uniform_photons(scene, 4096, 91);
  const MapMode mode = GENERATE(MapMode::triangle, MapMode::automatic);
  Device device;
  const PhotonMaps maps(device, scene, photons, find_map_groups(scene, photons, mode, {0.2}),
                        {.radius = 0.2});
  CHECK(device.programs_built() + device.programs_from_cache() == 1);
  Estimator(maps, scene, {}).estimate(test::uniform_hits(scene, 93, 92));
  CHECK(device.programs_built() + device.programs_from_cache() == 2);
}

TEST_CASE("no kernel is left to compile once those of a scene are prepared") {
  Scene scene = test::empty_scene(GENERATE(1u, 3u));
  test::add_torus(scene, 0.3f, 0.1f, 16, 8);  // normals of all directions
  const Photons photons = test::uniform_photons(scene, 4096, 91);
  Device device;
  RenderParameters parameters;
  parameters.neighbours = 20;
  parameters.light_maps = GENERATE(LightMapMode::off, LightMapMode::on);
  KernelPreparation(scene, std::span(&device, 1), parameters).wait();
  const std::uint64_t prepared = device.programs_built() + device.programs_from_cache();
  CHECK(prepared == 2);
  const PhotonMaps maps(device, scene, photons,
                        find_map_groups(scene, photons, parameters.maps, {0.2}), {.radius = 0.2});
  CHECK(maps.statistics().mixed_maps > 0);
  Estimator(maps, scene, {.neighbours = 20}).estimate(test::uniform_hits(scene, 93, 92));
  CHECK(device.programs_built() + device.programs_from_cache() == prepared);
}

TEST_CASE("kernels are prepared for whatever materials and lights a scene has") {
  const SceneNeeds needs =
      GENERATE(SceneNeeds{.light_count = 1}, SceneNeeds{.glossy = true, .light_count = 3},
               SceneNeeds{.glossy = true, .normal_maps = true, .light_count = 1});
  const Scene scene = estimate::make_plane_sample(needs, 20, {1000, 4}).scene;
  CHECK(needs_of(scene).glossy == needs.glossy);
  CHECK(needs_of(scene).normal_maps == needs.normal_maps);
  CHECK(needs_of(scene).light_count == needs.light_count);
  Device device;
  RenderParameters parameters;
  parameters.neighbours = 20;
  CHECK_NOTHROW(KernelPreparation(scene, std::span(&device, 1), parameters).wait());
  CHECK(device.programs_built() + device.programs_from_cache() == 2);
}

}  // namespace photile::test
