// Light that few photons find: weight windows, where they are used, and that they change no mean.
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "same_bits.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr std::uint64_t enough = 100'000;  // paths from which on windows are looked for
constexpr std::uint64_t few = 99'999;

/// Two rooms of 4 x 4 x 3 m, a lamp in one, a slit of 10 cm between them. All reflect half.
Scene two_rooms() {
  SceneBuilder builder("two rooms");
  const std::uint32_t wall = builder.add(diffuse(glm::vec3(0.5f)));
  builder.box(glm::vec3(0.0f), {8, 4, 3}, wall, true);
  builder.quad({4, 0.1f, 0}, {4, 4, 0}, {4, 4, 3}, {4, 0.1f, 3}, wall);
  builder.add(point_light("lamp", {2, 2, 2}));
  return builder.build();
}

/// Flux in four strips of the second room, side by side from the slit on.
std::array<double, 4> behind(const Photons& photons) {
  std::array<double, 4> flux{};
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const glm::vec3& position = photons.position[i];
    if (position.x > 4.01f)
      flux[static_cast<std::size_t>(std::clamp(position.y, 0.0f, 3.99f))] +=
          luminance(glm::dvec3(photons.flux[i]));
  }
  return flux;
}

double stored(const Photons& photons) {
  double flux = 0;
  for (const glm::vec3& of_photon : photons.flux) flux += luminance(glm::dvec3(of_photon));
  return flux;
}

bool has_windows(const PhotonTracerResult& traced, std::uint64_t asked) {
  return traced.photons.emitted_per_light[0] > asked;
}

TEST_CASE("A room behind a slit has many light photons in place of few, and none is heavier") {
  const Scene scene = two_rooms();
  const RayScene rays(scene);
  const PhotonTracerResult plain = trace_photons(rays, {.emitted_photons = few});
  const PhotonTracerResult windows = trace_photons(rays, {.emitted_photons = enough});
  REQUIRE_FALSE(has_windows(plain, few));
  REQUIRE(has_windows(windows, enough));
  const auto count_behind = [](const Photons& photons) {
    return std::count_if(photons.position.begin(), photons.position.end(),
                         [](const glm::vec3& position) { return position.x > 4.01f; });
  };
  CHECK(count_behind(windows.photons) > 20 * count_behind(plain.photons));
  CHECK(windows.photons.size() < 3 * plain.photons.size());
  float heaviest = 0;
  for (const glm::vec3& flux : windows.photons.flux) heaviest = std::max(heaviest, flux.x);
  CHECK(heaviest <= 1.001f / enough);
  CHECK(windows.absorbed_flux_per_light[0] + windows.escaped_flux_per_light[0] ==
        Approx(1).epsilon(1e-5));
}

TEST_CASE("Weight windows change neither the flux of all surfaces nor that of any strip") {
  const Scene scene = two_rooms();
  const RayScene rays(scene);
  std::vector<double> all;
  std::array<std::vector<double>, 4> difference;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Photons windows = trace_photons(rays, {.emitted_photons = enough, .seed = seed}).photons;
    all.push_back(stored(windows));
    const std::array<double, 4> with = behind(windows);
    std::array<double, 4> without{};
    constexpr int runs = 4;
    for (std::uint64_t run = 0; run < runs; ++run) {
      const std::array<double, 4> found = behind(
          trace_photons(rays, {.emitted_photons = few, .seed = 100 + runs * seed + run}).photons);
      for (std::size_t i = 0; i < without.size(); ++i) without[i] += found[i] / runs;
    }
    for (std::size_t i = 0; i < without.size(); ++i) difference[i].push_back(with[i] - without[i]);
  }
  CHECK_VERDICT(mean_is(all, 2, 0.02));  // 1 + 1/2 + 1/4 + ... wherever they are
  const std::array<double, 4> mean = behind(trace_photons(rays, {.emitted_photons = few}).photons);
  for (std::size_t i = 0; i < difference.size(); ++i)
    CHECK_VERDICT(mean_is(difference[i], 0, 0.2 * mean[i]));
}

TEST_CASE("Photons of weight windows have the same bits on any threads, shards and in any pass") {
  const Scene scene = two_rooms();
  const RayScene rays(scene);
  PhotonTracerParameters parameters{.emitted_photons = enough, .seed = 3};
  const auto traced_by = [&](std::size_t threads) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(static_cast<int>(threads));
    return arena.execute([&] { return trace_photons(rays, parameters).photons; });
  };
  const Photons one = traced_by(1);
  CHECK(same_bits(one, traced_by(2)));
  CHECK(same_bits(one, traced_by(8)));
  std::vector<Photons> shards;
  for (std::uint32_t i = 0; i < 3; ++i) {
    parameters.shard = {i, 3};
    shards.push_back(trace_photons(rays, parameters).photons);
  }
  CHECK(same_bits(one, merge_runs(std::move(shards))));
  parameters.shard = {};
  parameters.paths_before = one.emitted_per_light;
  const Photons second = trace_photons(rays, parameters).photons;
  CHECK(second.emitted_per_light == one.emitted_per_light);
  CHECK_FALSE(same_bits(one, second));
}

TEST_CASE("Rooms that light reaches, and dim ground in the open, have no windows") {
  const auto plain = [](const Scene& scene) {
    return !has_windows(trace_photons(RayScene(scene), {.emitted_photons = enough}), enough);
  };
  CHECK(plain(closed_box(diffuse(glm::vec3(0.5f)))));
  CHECK(plain(furnished_room()));
  SceneBuilder house("a room with a slit on dim ground");
  const std::uint32_t wall = house.add(diffuse(glm::vec3(0.5f)));
  house.quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, wall);
  house.quad({0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}, wall);
  house.quad({0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}, wall);
  house.quad({0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}, wall);
  house.quad({0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}, wall);
  house.quad({4, 0, 0.2f}, {4, 4, 0.2f}, {4, 4, 3}, {4, 0, 3}, wall);
  house.grid({4, -10, 0}, {40, 0, 0}, {0, 24, 0}, 4, wall);
  house.add(point_light("lamp", {2, 2, 2}));
  CHECK(plain(house.build()));
}

}  // namespace
}  // namespace photile::test
