// What a scene does not need is not there: no bytes in its records.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "estimate/device_test.hpp"
#include "estimate/specialisation.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "photile/estimator.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"
#include "render/kernel_preparation.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// A closed box with point lights, whose kind follows from the needs.
Scene box_of(const SceneNeeds& needs) {
  Scene scene = closed_box(needs.glossy ? glossy(0.5f, 0.2f, 0.4f) : diffuse(0.5f));
  for (std::uint32_t i = 1; i < needs.light_count; ++i) {
    scene.lights.push_back(point_light(fmt::format("lamp {}", i), {0.5f, 0.4f, 0.6f}));
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
  Scene scene = closed_box(diffuse(0.5f));
  scene.materials.push_back(glossy(0.5f, 0.5f, 0.3f));
  scene.materials.push_back(glass(1.5f, /*thin=*/true));
  scene.materials.push_back(mirror(0.9f));
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
  Scene scene = empty_scene(GENERATE(1u, 3u));
  add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
  const Photons photons = uniform_photons(scene, 4096, 91);
  const MapMode mode = GENERATE(MapMode::triangle, MapMode::automatic);
  Device device;
  const PhotonMaps maps(device, scene, photons, find_map_groups(scene, photons, mode, {0.2}),
                        {.radius = 0.2});
  CHECK(device.programs_built() + device.programs_from_cache() == 1);
  Estimator(maps, scene, {}).estimate(uniform_hits(scene, 93, 92));
  CHECK(device.programs_built() + device.programs_from_cache() == 2);
}

TEST_CASE("no kernel is left to compile once those of a scene are prepared") {
  Scene scene = empty_scene(GENERATE(1u, 3u));
  add_torus(scene, 0.3f, 0.1f, 16, 8);  // normals of all directions
  const Photons photons = uniform_photons(scene, 4096, 91);
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
  const PrimaryHits hits = uniform_hits(scene, 93, 92);
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

// Which kernels a tuning and a scene get: memory is bounded, and each kind of device has its own.

using namespace estimate;

constexpr SceneNeeds one_light{.light_count = 1};
constexpr SceneNeeds several_lights{.light_count = 5};
constexpr SceneNeeds glossy_scene{.glossy = true, .light_count = 5};

DeviceInfo device_of_type(DeviceType type) {
  DeviceInfo info;
  info.type = type;
  info.max_work_group_size = 1024;
  return info;
}

TEST_CASE("no work-group uses more private memory than allowed, whatever the tuning and k") {
  for (const int width : vector_widths) {
    for (const int group : {1, 16, 64, 256}) {
      for (const int k : {1, 50, 256, 257, 1008, limits::max_neighbours}) {
        for (const SceneNeeds& needs : {one_light, several_lights, glossy_scene}) {
          const Specialisation choice =
              specialise({EstimateStrategy::select, width, 16, group}, needs, k);
          CHECK(choice.private_bytes() >= 4u * static_cast<unsigned>(std::min(k, 256)));
          CHECK(choice.work_group_size >= 1);
          CHECK(choice.work_group_size * choice.private_bytes() <= 512u * 1024);
        }
      }
    }
  }
}

TEST_CASE("groups of lanes keep to the local memory that every device has, or are none") {
  const SceneNeeds many_lights{.glossy = true, .light_count = 300};
  for (const int width : lane_widths) {
    for (const int k : {1, 50, 1000, 3000, 10'000, limits::max_neighbours}) {
      for (const SceneNeeds& needs : {one_light, several_lights, glossy_scene, many_lights}) {
        const Specialisation choice =
            specialise({EstimateStrategy::lanes, width, 4, width}, needs, k);
        CAPTURE(width, k, needs.light_count);
        CHECK(choice.local_bytes() <= 32u * 1024);
        const bool lanes = choice.strategy == EstimateStrategy::lanes;
        if (lanes) CHECK(choice.work_group_size == static_cast<std::size_t>(width));
        if (k <= 1000) CHECK(lanes);
        if (lanes) CHECK(choice.capacity % width == 0);
      }
    }
  }
}

TEST_CASE("what any device runs takes the same memory for every k, and no local memory") {
  const DeviceInfo gpu = device_of_type(DeviceType::gpu);
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    const EstimateTuning tuning = shipped_tuning(gpu, strategy);
    const auto bytes = [&](int k) {
      return independent_of_k(specialise(tuning, glossy_scene, k)).private_bytes();
    };
    CHECK(bytes(1) == bytes(limits::max_neighbours));
    CHECK(bytes(1) <= max_private_bytes);
    CHECK(independent_of_k(specialise(tuning, glossy_scene, 50)).local_bytes() == 0);
  }
}

TEST_CASE("devices that are no CPUs work in lanes, as many as they run in step") {
  DeviceInfo gpu = device_of_type(DeviceType::gpu);
  for (const auto& [in_step, width] : std::vector<std::pair<std::uint32_t, int>>{
           {0, 32}, {8, 32}, {16, 16}, {32, 32}, {64, 64}, {128, 32}}) {
    gpu.lanes = in_step;
    CHECK(shipped_tuning(gpu).strategy == EstimateStrategy::lanes);
    CHECK(shipped_tuning(gpu).vector_width == width);
    CHECK(tuning_problem(shipped_tuning(gpu)).empty());
  }
  gpu.lanes = 64;
  gpu.max_work_group_size = 32;
  CHECK(shipped_tuning(gpu).vector_width == 32);
  gpu.max_work_group_size = 8;
  CHECK(shipped_tuning(gpu).strategy == EstimateStrategy::select);
  CHECK(shipped_tuning(device_of_type(DeviceType::cpu)).strategy == EstimateStrategy::select);
}

TEST_CASE("a plane of random photons holds what it says and is the same every time") {
  const auto sample = make_plane_sample(glossy_scene, 50, {1000, 10});
  CHECK(sample.photons.size() == 1000);
  REQUIRE(sample.hits.size() == 100);
  CHECK(needs_of(sample.scene).glossy);
  CHECK(needs_of(sample.scene).light_count == 5);
  CHECK(std::is_sorted(sample.hits.oriented_face.begin(), sample.hits.oriented_face.end()));
  CHECK(make_plane_sample(glossy_scene, 50, {1000, 10}).photons.position ==
        sample.photons.position);
  // The k-th of n uniform photons on the unit square lies at sqrt(k / (pi n)) on average.
  CHECK(sample.radius == Approx(2 * std::sqrt(50 / (3.14159265358979 * 1000))));
}

}  // namespace
}  // namespace photile::test
