// Pictures of several photon passes.

#include <map>
#include <random>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "pictures.hpp"
#include "render/film.hpp"
#include "render/pass_count.hpp"

namespace photile::test {
namespace {

// Pictures from several photon passes: consistent, reproducible, bounded in memory.

/// What is left of bias and of the deviation by noise after n passes: the mean of the factors by
/// which the squared radius has shrunk, which falls as n^(-1/3).
double predicted_of_passes(int passes) {
  double factor = 1, sum = 0;
  for (int pass = 1; pass <= passes; ++pass) {
    sum += factor;
    factor *= (pass + 2.0 / 3.0) / (pass + 1.0);
  }
  return sum / passes;
}

RenderParameters small_parameters(int passes) {
  RenderParameters parameters = small_picture(30'000, 48, 36);
  parameters.passes = passes;
  return parameters;
}

RenderResult render_room(const RenderParameters& parameters) {
  static const Scene scene = furnished_room(4);
  return render(scene, room_camera(), device(), parameters);
}

std::uint64_t host_bytes(const RenderResult& result, const std::string& stage) {
  for (const StageStatistics& statistics : result.statistics) {
    if (statistics.stage == stage) return statistics.host_bytes;
  }
  throw std::out_of_range(stage);
}

/// Root of the mean squared relative error of the illuminance of a floor one metre below a lamp of
/// 1 cd, (1 + d^2)^(-3/2) at the distance d from the point below it, over the pixels of a view of
/// 1.6 x 1.6 m. `photons` for each pass.
double error_after(int passes, std::uint64_t photons, int neighbours, double radius) {
  Scene scene = plate(diffuse(0.5f), 6.0f, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}));
  const Camera camera =
      Camera::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(0.8 / 4.0));
  constexpr int side = 20;
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons * static_cast<std::uint64_t>(passes);
  parameters.photons.max_path_length = 1;
  parameters.neighbours = neighbours;
  parameters.radius = radius;
  parameters.passes = passes;
  parameters.film.width = parameters.film.height = side;
  parameters.film.samples_per_pixel = 1;
  const LightLayers layers = render(scene, camera, device(), parameters).layers;
  double squares = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double u = 1.6 * ((x + 0.5) / side - 0.5), v = 1.6 * ((y + 0.5) / side - 0.5);
      const double expected = std::pow(1.0 + u * u + v * v, -1.5);
      const double lm = 4.0 * 3.14159265358979;  // that make 1 cd
      const auto pixel = static_cast<std::size_t>(y * side + x);
      const double error = lm * double{layers.layers[0].illuminance[pixel]} / expected - 1;
      squares += error * error / (side * side);
    }
  }
  return std::sqrt(squares);
}

/// The errors after 4, 16 and 64 passes against what theory leaves of that of one. Slack: a
/// quarter. The error of one pass is known to a few percent, since a view holds dozens of discs,
/// and terms of the bias beyond the second order make it a little less than in proportion to the
/// area.
void check_convergence(std::uint64_t photons, int neighbours, double radius) {
  const double one = error_after(1, photons, neighbours, radius);
  CHECK(one > 0.03);  // there is something to lose
  for (const int passes : {4, 16, 64}) {
    const double error = error_after(passes, photons, neighbours, radius);
    CAPTURE(passes, one, error, error / one, predicted_of_passes(passes));
    CHECK(error < 1.25 * predicted_of_passes(passes) * one);
  }
}

TEST_CASE("with more passes the error falls as theory says, where k bounds the estimate") {
  // Where E photons fall on a square metre the disc of k has a radius of sqrt(k / pi E): here
  // 0.32 m below the lamp, and the radius lets it grow to 1 m.
  check_convergence(50'000, 1300, 1.0);
}

TEST_CASE("with more passes the error falls as theory says, where the radius bounds the estimate") {
  check_convergence(50'000, 100'000, 0.32);
}

TEST_CASE("one pass is the picture without passes") {
  CHECK(
      same_bits(render_room(small_parameters(1)).layers, render_room(small_parameters(0)).layers));
}

TEST_CASE("passes share the photons and the samples of a pixel") {
  const RenderResult one = render_room(small_parameters(1));
  const RenderResult seven = render_room(small_parameters(7));
  CHECK(seven.used.passes == 7);
  CHECK(one.used.film.samples_per_pixel == 2);
  CHECK(seven.used.film.samples_per_pixel == 7);
  // The paths are the same, but that rounding may give a light one more or less.
  CHECK(static_cast<double>(seven.stored_photons) ==
        Approx(static_cast<double>(one.stored_photons)).epsilon(0.001));
}

TEST_CASE("photons in memory do not grow with the passes") {
  const auto render_passes = [](int passes) {
    RenderParameters parameters = small_parameters(passes);
    parameters.photons.emitted_photons *= static_cast<std::uint64_t>(passes);
    return render_room(parameters);
  };
  const RenderResult two = render_passes(2);
  const std::uint64_t device_peak = device().peak_allocated_bytes();
  const RenderResult ten = render_passes(10);
  CHECK(ten.stored_photons > 4.5 * static_cast<double>(two.stored_photons));
  // The lengths of 30,000 paths leave a deviation of 0.6% in what a pass stores.
  CHECK(static_cast<double>(host_bytes(ten, "trace photons")) <
        1.05 * static_cast<double>(host_bytes(two, "trace photons")));
  CHECK(static_cast<double>(device().peak_allocated_bytes()) <
        1.05 * static_cast<double>(device_peak));
}

TEST_CASE("more passes than paths still give every light a path in each") {
  RenderParameters parameters = small_parameters(20);
  parameters.photons.emitted_photons = 10;
  parameters.radius = 0.3;
  CHECK_NOTHROW(render_room(parameters));
}

TEST_CASE("a number of passes beyond the limit is refused") {
  CHECK_THROWS_AS(render_room(small_parameters(-1)), UsageError);
  CHECK_THROWS_AS(render_room(small_parameters(65'537)), UsageError);
}

// How the estimate narrows from pass to pass, and into how many passes photons are split.

constexpr std::uint64_t gib = 1ull << 30;

/// The product of (i + alpha) / (i + 1) for i = 1 ... pass.
double gamma_ratio(int pass, double alpha) {
  return std::exp(std::lgamma(pass + 1 + alpha) - std::lgamma(1 + alpha) - std::lgamma(pass + 2.0));
}

TEST_CASE("the squared radius shrinks as Knaus and Zwicker's, in closed form") {
  for (const int pass : {0, 1, 2, 9, 99, 9'999}) {
    const double radius = estimate_of_pass(pass, {0.5, 50}).radius;
    CHECK(radius * radius == Approx(0.25 * gamma_ratio(pass, 2.0 / 3.0)).epsilon(1e-9));
  }
  CHECK(estimate_of_pass(0, {0.5, 50}).radius == 0.5);
  CHECK(estimate_of_pass(0, {0.5, 50}).neighbours == 50);
}

TEST_CASE("k shrinks with the squared radius, down to its least") {
  for (const int pass : {1, 10, 100}) {
    const PassEstimate estimate = estimate_of_pass(pass, {2.0, 1000});
    CHECK(estimate.neighbours == Approx(250 * estimate.radius * estimate.radius).margin(0.5));
  }
  CHECK(estimate_of_pass(10'000, {1.0, 50}).neighbours == 5);
  CHECK(estimate_of_pass(10'000, {1.0, 3}).neighbours == 3);
}

TEST_CASE("photons of a pass take at most half of the memory") {
  // 10 photons of 100 bytes a path: 1 GiB / 2 holds 536,870 paths.
  CHECK(passes_within(500'000, 10, 100, gib) == 1);
  CHECK(passes_within(536'870, 10, 100, gib) == 1);
  CHECK(passes_within(536'871, 10, 100, gib) == 2);
  CHECK(passes_within(5'368'000, 10, 100, gib) == 10);
  CHECK(passes_within(1, 10, 100, 0) == 10);
  CHECK(passes_within(1000, 0, 100, gib) == 1);
}

TEST_CASE("photons of a pass can be indexed, whatever the memory") {
  const std::uint64_t paths = limits::max_emitted_photons;
  const int passes = passes_within(paths, 6.0, 100, ~0ull);
  CHECK(passes > 1);
  CHECK(static_cast<double>(paths) / passes * 6.0 <
        static_cast<double>(limits::max_stored_photons));
}

TEST_CASE("more passes than the limit allows are seen as such") {
  CHECK(passes_within(limits::max_emitted_photons, 100, 100, 1000) > limits::max_passes);
}

TEST_CASE("the host's memory is known, and the same however much of it is in use") {
  const std::uint64_t before = installed_host_bytes();
  const std::vector<char> taken(64u << 20, 1);
  CHECK(before > (1u << 20));
  CHECK(before < (std::uint64_t{1} << 50));
  CHECK(installed_host_bytes() == before);
  CHECK(taken.back() == 1);
}

// Pooled estimates against sums by hand.

constexpr std::size_t hits = 3000;  // several tasks

LayerMixdown random_pooling(std::size_t lights, std::size_t layers, std::mt19937& random) {
  LayerMixdown mixdown;
  for (std::size_t i = 0; i < layers; ++i) mixdown.layers.push_back("layer" + std::to_string(i));
  for (std::size_t i = 0; i < lights; ++i) {
    mixdown.layer_of.push_back(static_cast<std::uint32_t>(random() % layers));
    mixdown.scale.push_back(static_cast<float>(random() % 100) / 10);
  }
  return mixdown;
}

/// Estimates of all lights where they are few; else of some at each hit, of none at every seventh.
LightTable random_estimates(std::size_t lights, bool glossy, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  const bool sparse = lights > max_dense_lights;
  LightTable estimates(lights, sparse);
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

Values of_hit(const LightTable& estimates, const std::vector<glm::vec3>& values, std::size_t hit,
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
  const LayerMixdown mixdown = random_pooling(lights, layers, random);
  const LightTable estimates = random_estimates(lights, glossy, random);
  const LightTable result = pooled(mixdown, estimates);
  REQUIRE(result.first.empty() == (layers <= max_dense_lights));
  REQUIRE(result.radiance.empty() != glossy);
  double worst = 0;
  const auto compare = [&](std::vector<glm::vec3> LightTable::*values) {
    for (std::size_t hit = 0; hit < hits; ++hit) {
      Values expected;
      for (const auto& [light, value] : of_hit(estimates, estimates.*values, hit, lights)) {
        expected[mixdown.layer_of[light]] += static_cast<double>(mixdown.scale[light]) * value;
      }
      const Values found = of_hit(result, result.*values, hit, layers);
      if (!result.first.empty()) REQUIRE(found.size() == expected.size());
      for (const auto& [layer, value] : found) {
        worst = std::max(worst, glm::length(value - expected[layer]));
      }
    }
  };
  compare(&LightTable::irradiance);
  if (glossy) compare(&LightTable::radiance);
  CHECK(worst < 1e-3);  // of sums of hundreds
}

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

}  // namespace
}  // namespace photile::test
