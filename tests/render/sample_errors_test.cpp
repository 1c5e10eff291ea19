// The noise of a pixel's samples, told from the scatter of runs of them.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "render/film.hpp"

namespace photile::test {
namespace {

constexpr int run_count = 4;

std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back("light" + std::to_string(i));
  return all;
}

}  // namespace

TEST_CASE("errors of samples are those of the mean of runs, and add up in squares with others") {
  LightLayers errors(2, 1, names(1)), runs(2 * run_count, 1, names(1));
  errors.layers[0].radiance[1] = glm::vec3(0.3f);
  errors.layers[0].illuminance[1] = 2.0f;
  for (int run = 0; run < run_count; ++run) {
    runs.layers[0].radiance[run_count + run] = glm::vec3(1.0f, 0.5f * run, 10.0f * run);
    runs.layers[0].illuminance[run_count + run] = run == 0 ? 8.0f : 0.0f;
  }
  add_sample_errors(errors, runs);
  // The sum of four independent values that scatter by s varies by 4 s^2; that of strata at an edge
  // by half of it. Of 0, 1, 2, 3 s^2 is 5 / 3.
  const double of_steps = 2.0 * 5 / 3;
  const LightLayers::Layer& found = errors.layers[0];
  CHECK(found.radiance[0] == glm::vec3(0.0f));
  CHECK(found.radiance[1].r == Approx(0.3));
  CHECK(found.radiance[1].g == Approx(std::sqrt(0.09 + 0.25 * of_steps)));
  CHECK(found.radiance[1].b == Approx(std::sqrt(0.09 + 100 * of_steps)));
  CHECK(found.illuminance[1] == Approx(std::sqrt(4.0 + 2.0 * 16)));  // of 8, 0, 0, 0 s^2 is 16
}

TEST_CASE("errors of samples are the same in sparse layers") {
  const auto many = names(max_dense_lights + 1);
  LightLayers errors(2, 1, many), runs(2 * run_count, 1, many);
  REQUIRE(errors.sparse());
  errors.rows[0] = {{0, 1, 1}, {3}, {glm::vec3(0.3f)}, {0.0f}};
  // Light 3 in two runs of the first pixel, light 5 in one of the second.
  runs.rows[0] = {{0, 1, 2, 2, 2, 2, 2, 3, 3},
                  {3, 3, 5},
                  {glm::vec3(1.0f), glm::vec3(1.0f), glm::vec3(2.0f)},
                  {0.0f, 0.0f, 4.0f}};
  add_sample_errors(errors, runs);
  const LightLayers dense = errors.dense();
  CHECK(dense.layers[3].radiance[0].r == Approx(std::sqrt(0.09 + 2.0 / 3)));  // 1, 1, 0, 0
  CHECK(dense.layers[5].radiance[1].r == Approx(std::sqrt(2.0)));             // 2, 0, 0, 0
  CHECK(dense.layers[5].illuminance[1] == Approx(std::sqrt(8.0)));
  CHECK(dense.layers[3].radiance[1].r == 0.0f);
}

}  // namespace photile::test
