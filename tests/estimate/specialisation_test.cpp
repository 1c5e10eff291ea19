// Which kernels a tuning and a scene get: memory is bounded, and each kind of device has its own.
#include "estimate/specialisation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "estimate/device_test.hpp"
#include "photile/limits.hpp"

namespace photile::test {

using namespace photile::estimate;

namespace {

constexpr SceneNeeds one_light{.light_count = 1};
constexpr SceneNeeds several_lights{.light_count = 5};
constexpr SceneNeeds glossy{.glossy = true, .light_count = 5};

DeviceInfo device_of_type(DeviceType type) {
  DeviceInfo info;
  info.type = type;
  info.max_work_group_size = 1024;
  return info;
}

}  // namespace

TEST_CASE("no work-group uses more private memory than allowed, whatever the tuning and k") {
  for (const int width : vector_widths) {
    for (const int group : {1, 16, 64, 256}) {
      for (const int k : {1, 50, 256, 257, 1008, limits::max_neighbours}) {
        for (const SceneNeeds& needs : {one_light, several_lights, glossy}) {
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
      for (const SceneNeeds& needs : {one_light, several_lights, glossy, many_lights}) {
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
      return independent_of_k(specialise(tuning, glossy, k)).private_bytes();
    };
    CHECK(bytes(1) == bytes(limits::max_neighbours));
    CHECK(bytes(1) <= max_private_bytes);
    CHECK(independent_of_k(specialise(tuning, glossy, 50)).local_bytes() == 0);
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
  const auto sample = make_plane_sample(glossy, 50, {1000, 10});
  CHECK(sample.photons.size() == 1000);
  REQUIRE(sample.hits.size() == 100);
  CHECK(needs_of(sample.scene).glossy);
  CHECK(needs_of(sample.scene).light_count == 5);
  CHECK(std::is_sorted(sample.hits.oriented_face.begin(), sample.hits.oriented_face.end()));
  CHECK(make_plane_sample(glossy, 50, {1000, 10}).photons.position == sample.photons.position);
  // The k-th of n uniform photons on the unit square lies at sqrt(k / (pi n)) on average.
  CHECK(sample.radius == Approx(2 * std::sqrt(50 / (3.14159265358979 * 1000))));
}

}  // namespace photile::test
