// The light of all lamps together at nodes: its value, and that no bit of it remembers old powers.
#include "cache/node_mix.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>

namespace photile::test {

using cache::NodeMix;

namespace {

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

}  // namespace

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

}  // namespace photile::test
