// Neighbour groups and the automatic radius.
//
//   photile_bench_groups [benchmark options] [scene file]...
//
// Meshes: a terrain of a million triangles with an edge of 2 cm, and the scene files given. The
// radius of each run is in its name, in millimetres. "CPU" is the time of all threads together.
#include <benchmark/benchmark.h>

#include <cmath>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "photile/load_scene.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"

namespace {

using photile::Scene;

/// Height field of cells x cells quads of 2 cm.
Scene terrain(std::uint32_t cells) {
  constexpr double edge = 0.02;
  std::vector<glm::vec3> vertices;
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = edge * i, y = edge * j;
      vertices.emplace_back(x, y, 0.3 * std::sin(2 * x) * std::cos(3 * y));
    }
  }
  std::vector<glm::uvec3> triangles;
  const std::uint32_t row = cells + 1;
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t corner = j * row + i;
      triangles.emplace_back(corner, corner + 1, corner + row);
      triangles.emplace_back(corner + 1, corner + row + 1, corner + row);
    }
  }
  photile::SceneBuilder builder("terrain");
  builder.add(photile::Material());
  builder.add(photile::MeshArrays{.vertices = vertices, .triangles = triangles});
  return std::move(builder).build();
}

void find_groups(benchmark::State& state, const Scene& scene) {
  const double radius = static_cast<double>(state.range(0)) / 1000;
  photile::NeighbourGroups groups;
  for ([[maybe_unused]] auto _ : state) {
    groups = photile::find_neighbour_groups(scene, {radius});
  }
  state.counters["triangles"] = static_cast<double>(scene.triangle_count());
  state.counters["members"] = static_cast<double>(groups.members.size());
  state.counters["bytes"] = static_cast<double>(groups.bytes());
}

void register_groups(const std::string& name, Scene scene,
                     std::initializer_list<int> radii_millimetres) {
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  const auto run = [shared](benchmark::State& state) { find_groups(state, *shared); };
  benchmark::internal::Benchmark* bench =
      benchmark::RegisterBenchmark(("neighbour groups/" + name).c_str(), run);
  bench->Unit(benchmark::kSecond)->UseRealTime()->MeasureProcessCPUTime();
  for (const int radius : radii_millimetres) bench->Arg(radius);
}

/// Photons uniform on a square: how they lie hardly matters to the cost.
void find_automatic_radius(benchmark::State& state) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(0, 10);
  photile::Photons photons;
  photons.position.resize(static_cast<std::size_t>(state.range(0)));
  for (glm::vec3& position : photons.position) {
    position = {uniform(generator), uniform(generator), 0};
  }
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(photile::automatic_radius(photons, static_cast<int>(state.range(1))));
  }
}
BENCHMARK(find_automatic_radius)
    ->Name("automatic radius")
    ->ArgNames({"photons", "k"})
    ->ArgsProduct({{200'000, 5'000'000}, {50, 500}})
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

}  // namespace

int main(int argument_count, char** arguments) {
  benchmark::Initialize(&argument_count, arguments);
  try {
    register_groups("terrain", terrain(708), {20, 50, 100});
    for (int i = 1; i < argument_count; ++i) {
      const std::filesystem::path file = arguments[i];
      register_groups(file.stem().string(), photile::load_scene(file), {50, 100, 200});
    }
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
