// Lamps with measured intensities: where their photons go, and what paths see of them.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "path_irradiance.hpp"
#include "photile/photons.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using namespace photile::trace;
using std::numbers::pi;

/// Intensities of a lamp by polar angle and azimuth, in degrees.
template <class Intensity>
IntensityDistribution distribution(int polar_steps, double last_polar, int azimuth_steps,
                                   Intensity&& intensity) {
  std::vector<double> polar, azimuth;
  std::vector<float> values;
  for (int i = 0; i <= polar_steps; ++i) polar.push_back(last_polar * i / polar_steps);
  for (int i = 0; i <= azimuth_steps; ++i) azimuth.push_back(360.0 * i / azimuth_steps);
  for (const double a : azimuth)
    for (const double p : polar) values.push_back(static_cast<float>(intensity(p, a)));
  return {"lamp", PhotometricAxes{}, polar, azimuth, values};
}

IntensityDistribution lambertian() {
  return distribution(90, 90, 1, [](double p, double) { return std::cos(p * pi / 180); });
}

/// A black plate of 40 x 40 m, and above its middle a lamp that shines down.
Scene plate_under(IntensityDistribution lamp, float height, const glm::vec3& x_axis) {
  Scene scene = plate(diffuse(glm::vec3(0.0f)), 40.0f, 2);
  Light light = point_light("lamp", {0, 0, height});
  light.x_axis = x_axis;
  light.distribution = 0;
  light.power = lamp.flux();
  scene.distributions.push_back(std::move(lamp));
  scene.lights.push_back(light);
  return scene;
}

}  // namespace

TEST_CASE("photons of a measured lamp go where its intensity says, in every cell of its grid",
          "[intensity]") {
  // Bilinear between zeros and peaks, turned about two axes, and not its own mirror image.
  const IntensityDistribution lamp = distribution(4, 180, 6, [](double p, double a) {
    return (p == 0 || p == 180 ? 5 : 10) +
           9 * std::cos((2 * a - 50) * pi / 180) * std::sin(p * pi / 180);
  });
  Scene scene = plate(diffuse(glm::vec3(0.0f)), 1.0f);
  Light light = point_light("lamp", glm::vec3(0.0f));
  light.direction = glm::normalize(glm::vec3(1, 2, -2));
  light.x_axis = glm::normalize(glm::cross(light.direction, glm::vec3(0.3f, 1, 0)));
  light.distribution = 0;
  scene.distributions.push_back(lamp);
  const LightAxes axes(light);
  const IntensitySampler sampler(scene, light);

  // Bins four times as fine as the grid, their flux by the midpoint rule.
  constexpr int rows = 16, columns = 24, steps = 24;
  constexpr double trials = 400'000;
  std::vector<double> counts(rows * columns, 0.0), expected(rows * columns, 0.0);
  double all = 0;
  for (int row = 0; row < rows * steps; ++row) {
    for (int column = 0; column < columns * steps; ++column) {
      const double p = pi * (row + 0.5) / (rows * steps);
      const double a = 2 * pi * (column + 0.5) / (columns * steps);
      const glm::dvec3 local(std::sin(p) * std::cos(a), std::sin(p) * std::sin(a), -std::cos(p));
      const double flux = lamp.intensity(local) * std::sin(p);
      expected[static_cast<std::size_t>(row / steps * columns + column / steps)] += flux;
      all += flux;
    }
  }
  for (double& count : expected) count *= trials / all;
  for (int i = 0; i < static_cast<int>(trials); ++i) {
    const glm::dvec3 local = axes.to_light(
        glm::dvec3(sampler.sample(RandomStream(11, static_cast<std::uint64_t>(i), 0))));
    REQUIRE(glm::length(local) == Approx(1).epsilon(1e-6));
    const double p = std::acos(std::clamp(-local.z, -1.0, 1.0));
    const double a = std::atan2(local.y, local.x);
    const int row = std::min(static_cast<int>(p / pi * rows), rows - 1);
    const int column = static_cast<int>((a < 0 ? a + 2 * pi : a) / (2 * pi) * columns) % columns;
    ++counts[static_cast<std::size_t>(row * columns + column)];
  }
  CHECK_VERDICT(counts_agree(counts, expected));
}

TEST_CASE("photons of a Lambertian lamp fill the rings below it by sine squared", "[intensity]") {
  const Scene scene = plate_under(lambertian(), 2.0f, {1, 0, 0});
  constexpr std::uint64_t paths = 200'000;
  const Photons photons =
      trace_photons(RayScene(scene), {.emitted_photons = paths, .seed = 3}).photons;
  std::vector<double> counts(21, 0.0), expected;
  for (const glm::vec3& p : photons.position) {
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(5 * std::hypot(p.x, p.y)), 20)];
  }
  counts[20] += static_cast<double>(paths - photons.size());
  const auto within = [](double radius) { return radius * radius / (radius * radius + 4); };
  for (int k = 0; k < 20; ++k)
    expected.push_back(paths * (within((k + 1) / 5.0) - within(k / 5.0)));
  expected.push_back(paths * (1 - within(4)));
  CHECK_VERDICT(counts_agree(counts, expected));
}

TEST_CASE("paths see I cos / d^2 of a measured lamp, turned as it is", "[intensity]") {
  const auto intensity = [](double p, double a) {
    return 100 * std::cos(p * pi / 180) * (a > 90 && a < 270 ? 1 : 2);
  };
  // The lamp's x axis is the scene's y axis; seen along -z its y axis is then -x.
  const Scene scene = plate_under(distribution(90, 90, 360, intensity), 2.0f, {0, 1, 0});
  const double flux = scene.distributions[0].flux();
  CHECK(flux == Approx(150 * pi).epsilon(3e-3));  // the steps at 90 and 270 degrees are ramps
  for (const auto& [point, bright] :
       {std::pair{glm::dvec3(0.5, 1.5, 0), 2.0}, std::pair{glm::dvec3(-0.5, -1.5, 0), 1.0},
        std::pair{glm::dvec3(3, 0.7, 0), 2.0}}) {
    const double squared = glm::dot(point, point) + 4, cosine = 2 / std::sqrt(squared);
    const double irradiance = path_means(scene, {{point, {0, 0, 1}}}, 1, 1).irradiance.at(0);
    CAPTURE(point.x, point.y);
    CHECK(irradiance * flux == Approx(100 * bright * cosine * cosine / squared).epsilon(1e-4));
  }
}

}  // namespace photile::test
