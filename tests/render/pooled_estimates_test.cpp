// Pooled estimates against sums by hand.
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "photile/scene.hpp"
#include "render/film.hpp"

namespace photile::test {
namespace {

constexpr std::size_t hits = 3000;  // several tasks

LightPooling random_pooling(std::size_t lights, std::size_t layers, std::mt19937& random) {
  LightPooling pooling;
  for (std::size_t i = 0; i < layers; ++i) pooling.layers.push_back("layer" + std::to_string(i));
  for (std::size_t i = 0; i < lights; ++i) {
    pooling.layer_of.push_back(static_cast<std::uint32_t>(random() % layers));
    pooling.scale.push_back(static_cast<float>(random() % 100) / 10);
  }
  return pooling;
}

/// Estimates of all lights where they are few; else of some at each hit, of none at every seventh.
Estimates random_estimates(std::size_t lights, bool glossy, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  Estimates estimates;
  const bool sparse = lights > max_dense_lights;
  if (sparse) estimates.first.push_back(0);
  for (std::size_t hit = 0; hit < hits; ++hit) {
    const std::size_t count = !sparse ? lights : hit % 7 == 0 ? 0 : random() % lights;
    for (std::size_t i = 0; i < count; ++i) {
      estimates.irradiance.emplace_back(uniform(random), uniform(random), uniform(random));
      if (glossy) estimates.radiance.emplace_back(uniform(random));
      if (sparse) estimates.light.push_back(static_cast<std::uint16_t>((i * 7 + hit) % lights));
    }
    if (sparse) estimates.first.push_back(estimates.irradiance.size());
  }
  return estimates;
}

using Values = std::map<std::size_t, glm::dvec3>;  ///< by light or layer

Values of_hit(const Estimates& estimates, const std::vector<glm::vec3>& values, std::size_t hit,
              std::size_t lights) {
  Values result;
  if (estimates.first.empty()) {
    for (std::size_t i = 0; i < lights; ++i) result[i] = glm::dvec3(values[hit * lights + i]);
  } else {
    for (std::uint64_t i = estimates.first[hit]; i < estimates.first[hit + 1]; ++i) {
      REQUIRE(result.count(estimates.light[i]) == 0);
      result[estimates.light[i]] = glm::dvec3(values[i]);
    }
  }
  return result;
}

void check_pooled(std::size_t lights, std::size_t layers, bool glossy) {
  std::mt19937 random(5);
  const LightPooling pooling = random_pooling(lights, layers, random);
  const Estimates estimates = random_estimates(lights, glossy, random);
  const Estimates result = pooled(pooling, estimates, hits);
  REQUIRE(result.first.empty() == (layers <= max_dense_lights));
  REQUIRE(result.radiance.empty() != glossy);
  double worst = 0;
  const auto compare = [&](std::vector<glm::vec3> Estimates::*values) {
    for (std::size_t hit = 0; hit < hits; ++hit) {
      Values expected;
      for (const auto& [light, value] : of_hit(estimates, estimates.*values, hit, lights)) {
        expected[pooling.layer_of[light]] += static_cast<double>(pooling.scale[light]) * value;
      }
      const Values found = of_hit(result, result.*values, hit, layers);
      if (!result.first.empty()) REQUIRE(found.size() == expected.size());
      for (const auto& [layer, value] : found) {
        worst = std::max(worst, glm::length(value - expected[layer]));
      }
    }
  };
  compare(&Estimates::irradiance);
  if (glossy) compare(&Estimates::radiance);
  CHECK(worst < 1e-3);  // of sums of hundreds
}

}  // namespace

TEST_CASE("pooled layers hold the scaled sums of their lights") {
  check_pooled(146, 3, false);
  check_pooled(146, 3, true);
  check_pooled(40, 12, true);
  check_pooled(5, 2, false);
}

TEST_CASE("lamps that are seen are pooled, too") {
  PrimaryHitBatch batch;
  batch.emission.push_back({7, 2, glm::vec3(2, 4, 6), 8});
  pool_emission({{"a", "b"}, {0, 0, 1}, {1, 1, 0.5f}}, batch);
  CHECK(batch.emission[0].light == 1);
  CHECK(batch.emission[0].pixel == 7);
  CHECK(batch.emission[0].radiance == glm::vec3(1, 2, 3));
  CHECK(batch.emission[0].illuminance == 4);
}

}  // namespace photile::test
