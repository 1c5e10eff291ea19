// Light in space from nodes on surfaces.
#include "cache/ambient_light.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "cache/node_mix.hpp"
#include "cache/node_sources.hpp"

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
    for (const glm::vec3& irradiance : maps.values().irradiance)
      of_nodes.emplace_back(irradiance, 0.0f);
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

// The light of all lamps together at nodes: its value, and that no bit of it remembers old powers.

using cache::NodeMix;

constexpr std::size_t mixed_nodes = 10'000;

/// Light of any brightness. With gaps nodes hold about half of the lights, as where there are many.
LightTable random_values(std::size_t lights, bool gaps) {
  LightTable values(lights, gaps);
  std::mt19937 random(7);
  const auto brightness = [&] {
    return std::exp2(static_cast<float>(random() % 4096) / 256.0f - 8.0f);
  };
  for (std::size_t node = 0; node < mixed_nodes; ++node) {
    for (std::size_t light = 0; light < lights; ++light) {
      if (gaps && random() % 2 == 0) continue;
      values.irradiance.emplace_back(brightness(), brightness(), brightness());
      if (gaps) values.light.push_back(static_cast<std::uint16_t>(light));
    }
    if (gaps) values.first.push_back(values.light.size());
  }
  return values;
}

bool same_light(const NodeMix& a, const NodeMix& b) {
  return a.light().size() == b.light().size() &&
         std::memcmp(a.light().data(), b.light().data(), a.light().size_bytes()) == 0;
}

TEST_CASE("Light at nodes is the sum over lamps of power times light") {
  for (const std::size_t lights : {1, 3, 40}) {
    const bool gaps = lights > 8;
    const LightTable values = random_values(lights, gaps);
    std::vector<glm::vec3> powers;
    for (std::size_t i = 0; i < lights; ++i) powers.emplace_back(0.5f + i, 2.0f, 1.0f / (1 + i));
    NodeMix mix;
    mix.mix(values, mixed_nodes, powers);
    for (std::size_t node = 0; node < mixed_nodes; ++node) {
      glm::dvec3 sum(0.0);
      const std::size_t first = gaps ? values.first[node] : node * lights;
      const std::size_t last = gaps ? values.first[node + 1] : first + lights;
      for (std::size_t i = first; i < last; ++i) {
        const std::size_t light = gaps ? values.light[i] : i - first;
        sum += glm::dvec3(powers[light]) * glm::dvec3(values.irradiance[i]);
      }
      for (int c = 0; c < 3; ++c) REQUIRE(mix.light()[node][c] == Approx(sum[c]).epsilon(1e-5));
    }
  }
}

TEST_CASE("Light by the normal is mixed as luminance is") {
  const glm::vec4 part(0.1f, -0.2f, 0.3f, 0.4f);
  for (const std::size_t lights : {1, 3, 40}) {
    LightTable values = random_values(lights, lights > 8);
    for (const glm::vec3& light : values.irradiance) {
      values.by_normal.push_back(static_cast<float>(luminance(glm::dvec3(light))) * part);
    }
    std::vector<glm::vec3> powers;
    for (std::size_t i = 0; i < lights; ++i) powers.emplace_back(0.5f + i, 2.0f, 1.0f / (1 + i));
    NodeMix mix;
    mix.mix(values, mixed_nodes, powers);
    REQUIRE(mix.by_normal().size() == mixed_nodes);
    for (std::size_t node = 0; node < mixed_nodes; ++node) {
      const double light = luminance(glm::dvec3(mix.light()[node]));
      for (int c = 0; c < 4; ++c) {
        REQUIRE(mix.by_normal()[node][c] == Approx(light * part[c]).epsilon(1e-4).margin(1e-6));
      }
    }
  }
}

TEST_CASE("No bit of mixed light depends on powers of before") {
  for (const std::size_t lights : {1, 7, 40}) {
    const LightTable values = random_values(lights, lights > 8);
    std::vector<glm::vec3> powers(lights, glm::vec3(1.0f));
    std::mt19937 random(3);
    NodeMix with_history;
    for (int step = 0; step < 30; ++step) {
      // A slider at a time, at times several; nodes come in between.
      powers[random() % lights] = glm::vec3(static_cast<float>(random() % 1000) / 300.0f);
      if (step % 7 == 6) powers[0] = powers[lights - 1] = glm::vec3(0.0f);
      const std::size_t nodes = mixed_nodes / 2 + mixed_nodes / 2 * std::min(step, 20) / 20;
      with_history.mix(values, nodes, powers);
      NodeMix fresh;
      fresh.mix(values, nodes, powers);
      REQUIRE(same_light(with_history, fresh));
    }
  }
}

}  // namespace
}  // namespace photile::test
