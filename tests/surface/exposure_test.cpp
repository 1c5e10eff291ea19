// How much of lit surface lies open under what lies on it.
#include "surface/exposure.hpp"

#include <catch2/catch.hpp>

#include "photile/surface_index.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.1;

/// A floor of 1 x 1 m under tiles of 0.1 m, `side` wide and `thickness` above it.
Scene tiled_floor(float side, float thickness) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const glm::vec3 corner(0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j), 1e-4f);
      builder.box(corner, corner + glm::vec3(side, side, thickness), white, false);
    }
  }
  return builder.build();
}

/// The floor's upper side, where photons landed on all that looks up, or on nothing else.
float floor_exposure(const Scene& scene, bool tiles_lit) {
  std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
  std::uint32_t floor = none;
  for (std::uint32_t s = 0; s < landed.size(); ++s) {
    const bool is_floor = triangle_of(s) < 2;
    landed[s] = sided_normal(scene, s).z > 0.9 && (is_floor || tiles_lit);
    if (is_floor && landed[s] != 0 && floor == none) floor = s;
  }
  return index_surface(scene, landed, radius, 60).exposure[floor];
}

}  // namespace

TEST_CASE("a floor under tiles lies open in the joints") {
  // Joints take 1 - 0.95^2 = 9.75% of the floor, of which 64 points tell within a few hundredths.
  CHECK(floor_exposure(tiled_floor(0.095f, 0.005f), true) == Approx(0.0975).margin(0.08));
}

TEST_CASE("a floor that is covered by less than half counts as open") {
  CHECK(floor_exposure(tiled_floor(0.06f, 0.005f), true) == 1.0f);
}

TEST_CASE("what is higher than a fifth of the radius, or lit from below, covers nothing") {
  const auto exposure = [](float height, bool lit_below) {
    test::SceneBuilder room;
    const std::uint32_t white = room.add(test::diffuse(glm::vec3(0.5f)));
    room.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
    room.grid({0, 0, height}, {1, 0, 0}, {0, 1, 0}, 1, white);
    const Scene scene = room.build();
    std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
    for (std::uint32_t s = 0; s < landed.size(); ++s) {
      landed[s] = lit_below || sided_normal(scene, s).z > 0;
    }
    const SurfaceIndex index = index_surface(scene, landed, radius, 60);
    float least = 1;
    for (const float one : index.exposure) least = std::min(least, one);
    return least;
  };
  CHECK(exposure(0.015f, false) == 0.0f);
  CHECK(exposure(0.025f, false) == 1.0f);
  CHECK(exposure(0.015f, true) == 1.0f);
}

}  // namespace photile::test
