// What a scene does not need is not there: no bytes in its records.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "estimate/device_test.hpp"
#include "estimate/photon_estimate.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "photon_sets.hpp"
#include "render/kernel_preparation.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// A closed box with point lights, whose kind follows from the needs.
Scene box_of(const SceneNeeds& needs) {
  Scene scene = test::closed_box(needs.glossy ? test::glossy(glm::vec3(0.5f), glm::vec3(0.2f), 0.4f)
                                              : test::diffuse(glm::vec3(0.5f)));
  for (std::uint32_t i = 1; i < needs.light_count; ++i) {
    scene.lights.push_back(test::point_light(fmt::format("lamp {}", i), {0.5f, 0.4f, 0.6f}));
  }
  return scene;
}

/// Bytes that a reference takes in the buffers of a page.
std::size_t bytes_per_reference(const maps::MapPage& page) {
  const auto planes = [&](const device::Buffer<float>& buffer) {
    return buffer.size() * sizeof(float) / page.record_stride;
  };
  return planes(page.record_position) + planes(page.record_flux) + planes(page.record_incoming) +
         planes(page.record_normal) + page.record_light.size() / page.record_stride +
         page.record_photon.size() * sizeof(std::uint32_t) / page.record_count;
}

constexpr SceneNeeds diffuse_of(std::uint32_t lights) { return {.light_count = lights}; }
constexpr SceneNeeds glossy_of(std::uint32_t lights) {
  return {.glossy = true, .light_count = lights};
}

TEST_CASE("a diffuse scene of one light has the smallest records, others what they need more") {
  // The bytes of docs/kernels/data.md, "Records".
  const auto [needs, bytes] = GENERATE(table<SceneNeeds, std::size_t>({
      {diffuse_of(1), 28},
      {diffuse_of(2), 29},
      {diffuse_of(300), 30},
      {glossy_of(1), 40},
      {glossy_of(2), 41},
      {glossy_of(300), 42},
  }));
  CAPTURE(needs.glossy, needs.light_count);
  const Scene scene = box_of(needs);
  const RayScene rays(scene);
  CHECK(rays.needs().glossy == needs.glossy);
  CHECK(rays.needs().light_count == needs.light_count);
  CHECK(maps::bytes_per_record(rays.needs()) == bytes);

  const Photons photons = trace_photons(rays, {.emitted_photons = 3000}).photons;
  REQUIRE(photons.size() > 1000);
  CHECK(photons.incoming.size() == (needs.glossy ? photons.size() : 0));
  CHECK(photons.light.size() == (needs.light_count > 1 ? photons.size() : 0));

  Device device;
  const PhotonMaps maps(device, scene, photons,
                        find_map_groups(scene, photons, MapMode::triangle, {0.2}), {.radius = 0.2});
  for (std::size_t i = 0; i < maps::store_of(maps).pages.size(); ++i) {
    const maps::MapPage& page = maps::store_of(maps).pages.use(i);
    const maps::ResidentMaps::Release release{maps::store_of(maps).pages};
    CHECK(bytes_per_reference(page) == bytes);
  }

  const Camera camera =
      Camera::look_at({0.2, 0.2, 0.2}, {0.9, 0.8, 0.7}, {0, 0, 1}, /*field of view*/ 1.0);
  PrimaryHitParameters film;
  film.width = film.height = 8;
  const PrimaryHits hits = trace_primary_hits(rays, camera, film, 0, 8).hits;
  REQUIRE(hits.size() > 0);
  CHECK(hits.outgoing.size() == (needs.glossy ? hits.size() : 0));
  CHECK(hits.lobe.size() == (needs.glossy ? hits.size() : 0));
}

TEST_CASE("only what triangles have is needed: unused materials ask for nothing") {
  Scene scene = test::closed_box(test::diffuse(glm::vec3(0.5f)));
  scene.materials.push_back(test::glossy(glm::vec3(0.5f), glm::vec3(0.5f), 0.3f));
  scene.materials.push_back(test::glass(1.5f, /*thin=*/true));
  scene.materials.push_back(test::mirror(glm::vec3(0.9f)));
  const auto needs_with = [&](std::uint32_t material) {
    scene.triangle_material[0] = material;
    return RayScene(scene).needs();
  };
  const SceneNeeds none = needs_with(0);
  CHECK_FALSE((none.glossy || none.textures || none.specular_paths || none.see_through));
  CHECK(none.light_count == 1);
  CHECK(needs_with(1).glossy);
  CHECK_FALSE(needs_with(1).specular_paths);
  CHECK((needs_with(2).see_through && needs_with(2).specular_paths));
  CHECK((!needs_with(3).see_through && needs_with(3).specular_paths));
}

// A start is paid per program: what is built for maps and an estimate.

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
  const bool lists = GENERATE(false, true);
  KernelPreparation(scene, std::span(&device, 1), parameters, lists, false).wait();
  const std::uint64_t prepared = device.programs_built() + device.programs_from_cache();
  CHECK(prepared == (lists ? 3 : 2));
  const PhotonMaps maps(device, scene, photons,
                        find_map_groups(scene, photons, parameters.maps, {0.2}), {.radius = 0.2});
  CHECK(maps.statistics().normal_filtered_maps > 0);
  Estimator estimator(maps, scene, {.neighbours = 20});
  const PrimaryHits hits = test::uniform_hits(scene, 93, 92);
  estimator.estimate(hits);
  if (lists) estimator.nearest(hits);
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
  CHECK_NOTHROW(KernelPreparation(scene, std::span(&device, 1), parameters, false, false).wait());
  CHECK(device.programs_built() + device.programs_from_cache() == 2);
}

}  // namespace
}  // namespace photile::test
