// Paths along lobes, surface by surface.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "test_scenes.hpp"
#include "trace/eye_path.hpp"
#include "trace/light_sampler.hpp"

namespace photile::test {

using namespace photile::trace;

TEST_CASE("lobe paths: what one surface scatters says nothing of what another does") {
  SceneBuilder builder;
  const std::uint32_t metal = builder.add(glossy(glm::vec3(0.0f), glm::vec3(0.95f), 0.02f));
  builder.grid({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 1, metal);
  builder.grid({-50, -50, 1}, {0, 100, 0}, {100, 0, 0}, 1, metal);
  builder.add(point_light("bulb", {3, 2, 0.5f}));
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const LightSampler lamps(scene);
  const LobeRays lobes{rays, lamps};
  constexpr int surfaces = 5, paths = 2000;
  const PrimaryHitParameters film{.max_specular_depth = surfaces};
  const EyeSetup setup{.rays = &impl_of(rays), .parameters = &film, .lobes = &lobes};
  // Which way each surface turns a path that met the first one at a right angle: the signs of the
  // changes of its slopes along x and y.
  std::vector<std::array<int, 2 * surfaces>> turns;
  for (std::uint64_t pixel = 0; pixel < paths; ++pixel) {
    const RandomStream numbers(1, pixel, 0);
    EyeRecord seen, reflected;
    const auto end = follow_eye_ray(setup, {glm::vec3(0, 0, 0.5f), {0, 0, -1}, glm::vec3(1.0f), 0},
                                    numbers, seen);
    REQUIRE(end);
    follow_lobes(setup, *end, {numbers, 0, pixel, 0}, reflected);
    if (reflected.hits.size() < surfaces) continue;
    glm::dvec3 from(end->point.position);
    glm::dvec2 slope(0.0);
    auto& turn = turns.emplace_back();
    for (int i = 0; i < surfaces; ++i) {
      const glm::dvec3 to(reflected.hits[static_cast<std::size_t>(i)].position);
      const glm::dvec2 next = glm::dvec2(to - from) / std::abs(to.z - from.z);
      turn[2 * i] = next.x > slope.x ? 1 : -1;
      turn[2 * i + 1] = next.y > slope.y ? 1 : -1;
      slope = next;
      from = to;
    }
  }
  REQUIRE(turns.size() > 0.9 * paths);
  for (int i = 0; i < 2 * surfaces; ++i) {
    for (int j = 0; j < i - i % 2; ++j) {
      int sum = 0;
      for (const auto& turn : turns) sum += turn[i] * turn[j];
      CAPTURE(i, j);
      // Scatters by the root of the number of paths.
      CHECK(std::abs(sum) < 5 * std::sqrt(turns.size()));
    }
  }
}

}  // namespace photile::test
