// The cases of `photile validate` and their verdicts.
#include "validation/analytic_cases.hpp"

#include <catch2/catch.hpp>

#include "estimates_comparison.hpp"
#include "photile/sensors.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "test_device.hpp"
#include "validation/validate.hpp"

namespace photile::test {
namespace {

using namespace validation;

// The analytic cases of `photile validate`, with fewer photons and the bounds of a t test.

/// What the midpoint rule over sensors, and rounding to float, may add to an error.
constexpr double slack = 1e-3;

/// CHECKs that a mean of 16 seeds or more is what was expected: Student's t, two-sided 1e-6 (7.90
/// for 16). FAILs where a deviation of `delta` could be missed.
void check(const ValidationRow& row, const validation::Measured& measured, double delta) {
  const double error = measured.noise / student_t_99(measured.seeds - 1);
  INFO(row.name << ", " << row.place << ": expected " << row.expected << ", error "
                << measured.error << " +- " << error);
  if ((7.90 + 3.1) * error > delta) FAIL("too noisy to see " << delta);
  CHECK(std::abs(measured.error) <= 7.90 * error + slack);
}

ValidationParameters few_photons(std::uint64_t photons, int neighbours) {
  ValidationParameters parameters;
  parameters.photons.photons.emitted_photons = photons;
  parameters.photons.neighbours = neighbours;
  parameters.by_paths = false;
  parameters.most_seeds = fewest_seeds;
  return parameters;
}

std::vector<ValidationRow> rows_of(const std::string& name,
                                   const ValidationParameters& parameters) {
  for (const AnalyticCase& analytic : analytic_cases()) {
    if (analytic.name != name) continue;
    return validate(analytic, std::span(&device(), parameters.by_photons ? 1 : 0), parameters,
                    Progress::none());
  }
  throw std::logic_error("no case " + name);
}

TEST_CASE("paths read what closed forms say, in every analytic case", "[slow]") {
  ValidationParameters parameters;
  parameters.by_photons = false;
  parameters.paths = 300'000;
  parameters.most_seeds = fewest_seeds;
  for (const AnalyticCase& analytic : analytic_cases()) {
    for (const ValidationRow& row : validate(analytic, {}, parameters, Progress::none())) {
      REQUIRE(row.paths);
      check(row, *row.paths, 0.04);
    }
  }
}

TEST_CASE("every analytic case has one light, sensors and something to expect") {
  for (const AnalyticCase& analytic : analytic_cases()) {
    INFO(analytic.name);
    CHECK(analytic.scene.lights.size() == 1);
    CHECK(analytic.scene.lights[0].power > 0);
    CHECK_FALSE(analytic.readings.empty());
    for (const Reading& reading : analytic.readings) {
      CHECK_FALSE(reading.sensors.empty());
      CHECK(reading.expected > 0);
    }
  }
}

TEST_CASE("photon maps read what closed forms say") {
  // Means over whole rooms take a small share of the photons and of k.
  const auto [name, photons, neighbours, delta] = GENERATE(table<std::string, int, int, double>(
      {{"point light over a surface", 600'000, 100, 0.08},
       {"area light over a surface", 600'000, 100, 0.08},
       {"perpendicular rectangles", 2'000'000, 400, 0.04},
       {"luminous flux in a black box", 2'000'000, 400, 0.02},
       {"diffuse reflection", 600'000, 100, 0.15},
       {"diffuse reflection with an obstruction", 600'000, 100, 0.18},
       {"interreflection, rho = 0.5", 2'000'000, 400, 0.02},
       {"integrating sphere, rho = 0.9", 2'000'000, 400, 0.03}}));
  for (const ValidationRow& row :
       rows_of(name, few_photons(static_cast<std::uint64_t>(photons), neighbours))) {
    check(row, *row.photons, delta);
  }
}

// What validation makes of sixteen readings: within 1%, beyond it, or too noisy to tell.

/// Sixteen values of this mean whose standard deviation is `scatter`.
std::vector<double> values(double mean, double scatter) {
  std::vector<double> result;
  for (int i = 0; i < 16; ++i)
    result.push_back(mean + (i % 2 == 0 ? 1 : -1) * scatter * std::sqrt(15.0 / 16.0));
  return result;
}

TEST_CASE("the noise of a reading is the 99% interval of its mean") {
  const validation::Measured result = measured(values(200, 4), 100);
  CHECK(result.value == Approx(200));
  CHECK(result.error == Approx(1));
  CHECK(result.noise == Approx(2.94671 * 4 / std::sqrt(16.0) / 100));  // t table, 15 degrees
}

TEST_CASE("deviations that 1% of means exceed are those of the tables of Student's t") {
  // Two-sided 99%, of 8, 15, 30 and 120 degrees of freedom.
  CHECK(student_t_99(8) == Approx(3.3554).epsilon(1e-3));
  CHECK(student_t_99(15) == Approx(2.9467).epsilon(1e-4));
  CHECK(student_t_99(30) == Approx(2.7500).epsilon(1e-4));
  CHECK(student_t_99(120) == Approx(2.6174).epsilon(1e-4));
}

TEST_CASE("more seeds are taken only where the noise leaves it open, as many as it asks for") {
  const auto reading = [](double error, double noise, validation::Verdict verdict) {
    return validation::Measured{.error = error, .noise = noise, .seeds = 16, .verdict = verdict};
  };
  const validation::Measured good = reading(0.001, 0.005, validation::Verdict::within);
  const validation::Measured bad = reading(0.05, 0.01, validation::Verdict::misses);
  CHECK(seeds_to_tell(std::vector{good, bad}) == 0);
  // The noise has to fall from 1% to 0.8%: by 1.25^2, and a tenth.
  const validation::Measured open = reading(-0.002, 0.01, validation::Verdict::too_noisy);
  CHECK(seeds_to_tell(std::vector{good, open}) == std::ceil(16 * 1.1 * 1.25 * 1.25));
  CHECK(seeds_to_tell(std::vector{open, reading(0.0, 0.5, validation::Verdict::too_noisy)}) == 32);
  CHECK(seeds_to_tell(std::vector{reading(0.0, 0.01001, validation::Verdict::too_noisy)}) == 18);
}

TEST_CASE("a case whose first seeds are too noisy takes more, and ends within 1%") {
  ValidationParameters parameters;
  parameters.by_photons = false;
  parameters.paths = 3'000;
  const auto first = [&] {
    ValidationParameters few = parameters;
    few.most_seeds = fewest_seeds;
    return rows_of("perpendicular rectangles", few).at(0).paths.value();
  }();
  const auto enough = rows_of("perpendicular rectangles", parameters).at(0).paths.value();
  CHECK(first.verdict == validation::Verdict::too_noisy);
  CHECK(first.seeds == fewest_seeds);
  CHECK(enough.verdict == validation::Verdict::within);
  CHECK(enough.seeds > fewest_seeds);
  CHECK(std::abs(enough.error) + enough.noise <= tolerance);
}

TEST_CASE("a reading is within 1% only if its noise leaves no doubt") {
  CHECK(measured(values(1.004, 0.002), 1).verdict == validation::Verdict::within);
  CHECK(measured(values(0.996, 0.002), 1).verdict == validation::Verdict::within);
  CHECK(measured(values(1.004, 0.02), 1).verdict == validation::Verdict::too_noisy);
  CHECK(measured(values(1.0, 0.02), 1).verdict == validation::Verdict::too_noisy);
  CHECK(measured(values(1.011, 0.01), 1).verdict == validation::Verdict::too_noisy);
}

TEST_CASE("a reading misses if no noise explains its error") {
  CHECK(measured(values(1.02, 0.005), 1).verdict == validation::Verdict::misses);
  CHECK(measured(values(0.98, 0.005), 1).verdict == validation::Verdict::misses);
  CHECK(measured(values(1.0101, 0), 1).verdict == validation::Verdict::misses);
}

// The reflectance of the glossy material in a white furnace against an integral over directions.

/// Integral of f cos over directions at `cosine` to the normal, seen along it: the model as
/// photile/device/bsdf.h states it, by the midpoint rule over the cosine.
double integral(double albedo, double f0, double alpha) {
  constexpr int steps = 400'000;
  constexpr double pi = glm::pi<double>();
  const double a2 = alpha * alpha;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    const double half = std::sqrt((1 + cosine) / 2);  // n.h and i.h
    const double fresnel = f0 + (1 - f0) * std::pow(1 - half, 5);
    const double d = a2 / (pi * std::pow(half * half * (a2 - 1) + 1, 2));
    const double g1 = 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
    const double diffuse = photile::test::diffuse_bsdf(cosine, 1, albedo, f0, 1, alpha);
    const double f = diffuse + fresnel * d * g1 / (4 * cosine);
    sum += f * cosine * 2 * pi / steps;
  }
  return sum;
}

TEST_CASE("glossy reflectance is the integral of the BSDF") {
  using validation::glossy_reflectance;
  for (const double alpha : {0.1, 0.4, 1.0}) {
    CHECK(glossy_reflectance(0.3, 0.5, alpha) == Approx(integral(0.3, 0.5, alpha)).epsilon(1e-4));
    CHECK(glossy_reflectance(0.0, 1.0, alpha) == Approx(integral(0.0, 1.0, alpha)).epsilon(1e-4));
  }
}

TEST_CASE("white surfaces reflect all light at any roughness, but for the error of the fit") {
  using validation::glossy_reflectance;
  for (const double alpha : {0.02, 0.1, 0.25, 0.5, 1.0}) {
    CAPTURE(alpha);
    CHECK(glossy_reflectance(1.0, 0.04, alpha) == Approx(1.0).epsilon(0.015));
    CHECK(glossy_reflectance(0.0, 1.0, alpha) == Approx(1.0).epsilon(0.035));  // a white metal
  }
}

// Photon maps come closer to the truth as photons grow, at the rate that theory gives, and are
// right to 1% where the light is uniform. Noise is taken from independent seeds.

constexpr double pi = glm::pi<double>();

/// count x count sensors, `spacing` metres apart, around the origin in z = 0.
std::vector<Sensor> square_of_sensors(int count, double spacing, const glm::dvec3& normal) {
  std::vector<Sensor> sensors;
  for (int i = 0; i < count * count; ++i) {
    const double middle = 0.5 * (count - 1);
    sensors.push_back(
        {{spacing * (i % count - middle), spacing * (i / count - middle), 0}, normal});
  }
  return sensors;
}

RenderParameters with(std::uint64_t photons, int neighbours, std::uint64_t seed) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons;
  parameters.seed = seed;
  parameters.neighbours = neighbours;
  return parameters;
}

/// Illuminance at sensors, of each light at its power in turn.
std::vector<std::vector<double>> readings(const Scene& scene, const std::vector<Sensor>& sensors,
                                          const RenderParameters& parameters) {
  const RenderResult result = measure(scene, sensors, std::span(&device(), 1), parameters);
  std::vector<std::vector<double>> all;
  for (std::size_t light = 0; light < scene.lights.size(); ++light) {
    std::vector<double>& values = all.emplace_back();
    for (const float value : result.layers.layers[light].illuminance) {
      values.push_back(scene.lights[light].power * static_cast<double>(value));
    }
  }
  return all;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// A plate of 2 x 2 m in parallel light from above: 1 / (2 pi) of the flux on each square metre,
/// the disc of the bounding sphere having the radius sqrt(2) m.
Scene evenly_lit_plate() {
  Scene scene = plate(diffuse(0.0f), 2.0f, 2);
  scene.lights.push_back(sun_along({0, 0, -1}));
  return scene;
}

/// count x count discs side by side read even light without bias.
void check_even_light(int count, double spacing, std::uint64_t photons, int neighbours,
                      double delta) {
  const Scene scene = evenly_lit_plate();
  const std::vector<Sensor> sensors = square_of_sensors(count, spacing, {0, 0, 1});
  const std::vector<double> values = of_seeds([&](std::uint64_t seed) {
    return mean(readings(scene, sensors, with(photons, neighbours, seed))[0]);
  });
  const double truth = 1 / (2 * pi);
  CHECK_VERDICT(mean_is(values, truth, delta * truth));
}

TEST_CASE("even light is read without bias: a deviation of 1% would be seen", "[slow]") {
  check_even_light(20, 0.08, 500'000, 400, 0.01);
}

TEST_CASE("few neighbours are as unbiased as many: k for k - 1 would be seen") {
  check_even_light(40, 0.04, 100'000, 10, 0.03);  // k for k - 1 gives 11% more
}

TEST_CASE("the squared error falls as photons to the power -2/3 where k grows as to the power 2/3",
          "[slow]") {
  // The variance is 1 / k and the bias is of the order of k / N, whose square falls faster.
  const Scene scene = evenly_lit_plate();
  const std::vector<Sensor> sensors = square_of_sensors(16, 0.08, {0, 0, 1});
  const double truth = 1 / (2 * pi);
  const std::vector<double> photons{10'000, 40'000, 160'000, 640'000};
  const std::vector<double> slopes = of_seeds([&](std::uint64_t seed) {
    // Least squares through the points (log N, log of the squared error).
    double products = 0, squares = 0;
    for (const double count : photons) {
      const int k = static_cast<int>(std::lround(20 * std::pow(count / 10'000, 2.0 / 3)));
      const auto read =
          readings(scene, sensors, with(static_cast<std::uint64_t>(count), k, seed))[0];
      double error = 0;
      for (const double value : read) {
        error += std::pow(value / truth - 1, 2) / static_cast<double>(sensors.size());
      }
      const double x = std::log(count / std::sqrt(photons.front() * photons.back()));
      products += x * std::log(error);
      squares += x * x;
    }
    return products / squares;
  });
  CHECK_VERDICT(mean_is(slopes, -2.0 / 3, 0.1));
}

TEST_CASE("interreflected light is read without bias in the middle of a wall", "[slow]") {
  // Roulette has to give survivors what it takes from the others. All walls glow and reflect.
  SceneBuilder builder;
  const std::uint32_t wall = builder.add(diffuse(0.8f));
  const std::uint32_t lamp = builder.add(area_light("walls", pi * 6));
  builder.box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1}, wall, true, 1, lamp);
  const Scene scene = builder.build();
  const std::vector<Sensor> sensors = square_of_sensors(10, 0.06, {0, 0, 1});
  const std::vector<double> values = of_seeds([&](std::uint64_t seed) {
    return mean(readings(scene, sensors, with(300'000, 450, seed))[0]);
  });
  const double truth = pi / (1 - 0.8);
  CHECK_VERDICT(mean_is(values, truth, 0.02 * truth));
}

TEST_CASE("each light of two is read at its own power", "[slow]") {
  Scene scene = plate(diffuse(0.0f), 2.0f, 2);
  for (const double power : {100.0, 3.0}) {
    scene.lights.push_back(sun_along({0, 0, -1}, 0, "sun of " + std::to_string(power)));
    scene.lights.back().power = power;
  }
  const std::vector<Sensor> sensors = square_of_sensors(20, 0.08, {0, 0, 1});
  std::vector<double> first, second;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = with(1'000'000, 800, seed);
    parameters.photons.quota = PhotonQuota::equal;
    const auto both = readings(scene, sensors, parameters);
    first.push_back(mean(both[0]));
    second.push_back(mean(both[1]));
  }
  CHECK_VERDICT(mean_is(first, 100 / (2 * pi), 0.015 * 100 / (2 * pi)));
  CHECK_VERDICT(mean_is(second, 3 / (2 * pi), 0.015 * 3 / (2 * pi)));
}

TEST_CASE("the unlit side of a lit plate, and a dark wall beside it, read nothing") {
  // The wall stands along the light: photons of the floor lie within reach of its foot.
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, black);
  builder.grid({0.5f, -1, 0}, {0, 0, 1}, {0, 2, 0}, 2, black);
  builder.add(sun_along({0, 0, -1}));
  const Scene scene = builder.build();
  std::vector<Sensor> sensors = square_of_sensors(5, 0.1, {0, 0, -1});
  for (int i = 0; i < 10; ++i) {
    sensors.push_back({{0.5, 0.05 * i, 0.01}, {-1, 0, 0}});
    sensors.push_back({{0.5, 0.05 * i, 0.01}, {1, 0, 0}});
  }
  const std::vector<double> dark = readings(scene, sensors, with(100'000, 50, 1))[0];
  CHECK(dark == std::vector<double>(sensors.size(), 0.0));
  CHECK(readings(scene, {{{0, 0, 0}, {0, 0, 1}}}, with(100'000, 50, 1))[0][0] > 0);
}

}  // namespace
}  // namespace photile::test
