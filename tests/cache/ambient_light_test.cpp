// Light in space from nodes on surfaces.
#include "cache/ambient_light.hpp"

#include <catch2/catch.hpp>

#include "cache/node_sources.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// The light around nodes on a furnished room whose light is a formula.
struct LitSpace {
  explicit LitSpace(FormulaSource::Formula light)
      : scene(with_one_lamp(furnished_room(2))),
        rays(scene),
        source(std::move(light)),
        maps(rays, quiet_parameters(0.25, 1), source) {
    maps.fill(points_on(scene, 40), Progress::none());
    std::vector<glm::vec4> of_nodes;
    for (const glm::vec3& irradiance : maps.values().irradiance) {
      of_nodes.emplace_back(irradiance, 0.0f);
    }
    REQUIRE(of_nodes.size() > 100);
    ambient.gather(maps, scene, of_nodes);
  }

  const Scene scene;
  const RayScene rays;
  FormulaSource source;
  cache::LightMaps maps;
  cache::AmbientLight ambient;
};

const glm::vec3 upwards(0, 0, 1), aslant = glm::normalize(glm::vec3(1, -2, 2));

}  // namespace

TEST_CASE("Without nodes there is no light in space") {
  CHECK(cache::AmbientLight().irradiance({1, 2, 3}, upwards) == glm::vec3(0.0f));
}

TEST_CASE("Light that is the same on all surfaces is the same in all space") {
  const LitSpace space([](const glm::vec3&, std::uint32_t) { return 3.0f; });
  for (const glm::vec3& at : {glm::vec3(2, 2, 1), glm::vec3(0.1f), glm::vec3(-50, 0, 90)}) {
    for (const glm::vec3& normal : {upwards, -upwards, aslant}) {
      CHECK(space.ambient.irradiance(at, normal).y == Approx(3.0f));
    }
  }
}

TEST_CASE("Surface that faces up gets the light of surface that does") {
  const Scene scene = with_one_lamp(furnished_room(2));
  const LitSpace space([&](const glm::vec3&, std::uint32_t oriented_face) {
    return face_normal(scene, oriented_face).z > 0.5 ? 5.0f : 1.0f;
  });
  CHECK(space.ambient.irradiance({2, 2, 0.5f}, upwards).y == Approx(5.0f).epsilon(0.1));
  CHECK(space.ambient.irradiance({2, 2, 0.5f}, -upwards).y == Approx(1.0f).epsilon(0.1));
  const float between = space.ambient.irradiance({2, 2, 0.5f}, aslant).y;
  CHECK(between > 1.3f);
  CHECK(between < 4.0f);
}

TEST_CASE("Light in space is that of the nodes near by, and changes smoothly") {
  const LitSpace space([](const glm::vec3& p, std::uint32_t) { return p.x < 2 ? 1.0f : 9.0f; });
  CHECK(space.ambient.irradiance({0.2f, 2, 0.1f}, upwards).y == Approx(1.0f).epsilon(0.15));
  CHECK(space.ambient.irradiance({3.8f, 2, 0.1f}, upwards).y == Approx(9.0f).epsilon(0.15));
  float before = space.ambient.irradiance({0, 2, 0.1f}, upwards).y;
  for (float x = 0; x < 4; x += 0.01f) {
    const float here = space.ambient.irradiance({x, 2, 0.1f}, upwards).y;
    CHECK(std::abs(here - before) < 1.0f);
    before = here;
  }
}

}  // namespace photile::test
