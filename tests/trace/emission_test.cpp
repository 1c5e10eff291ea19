// Where the light of each kind of lamp falls, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "path_irradiance.hpp"
#include "photile/errors.hpp"
#include "photile/photons.hpp"
#include "suns.hpp"
#include "trace/light_emitter.hpp"

namespace photile::test {
namespace {

using namespace trace;

constexpr std::uint64_t paths = 200'000;
constexpr float half_side = 2.0f;

/// A black plate of 4 x 4 m in z = 0 under one light.
Scene lit_plate(const Light& light) {
  Scene scene = plate(diffuse(0.0f), 2 * half_side);
  scene.lights.push_back(light);
  return scene;
}

/// Photons on the plate's top per ring of radii k / 10 m, k = 1 ... 20, and last those anywhere
/// else, of `paths` emitted.
std::vector<double> counts_in_rings(const Scene& scene, std::uint64_t seed) {
  const RayScene rays(scene);
  const Photons photons = trace_photons(rays, {.emitted_photons = paths, .seed = seed}).photons;
  std::vector<double> counts(21, 0.0);
  counts.back() = static_cast<double>(paths - photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const glm::vec3& p = photons.position[i];
    const double ring = 10 * std::hypot(p.x, p.y);
    const bool on_top = face_normal(scene, photons.oriented_face[i]).z > 0;
    ++counts[on_top && ring < 20 ? static_cast<std::size_t>(ring) : 20];
  }
  return counts;
}

/// Expected counts from the flux that falls within each radius.
template <class Within>
std::vector<double> expected_in_rings(Within&& within) {
  std::vector<double> expected;
  for (int k = 0; k < 20; ++k)
    expected.push_back(paths * (within((k + 1) / 10.0) - within(k / 10.0)));
  expected.push_back(paths * (1 - within(2.0)));
  return expected;
}

Light spot_light(float inner, float outer) {
  return test::spot_light("spot", {0, 0, 1.5f}, {0, 0, -1}, inner, outer);
}

TEST_CASE("A point light fills the rings below it by their solid angles") {
  const Scene scene = lit_plate(point_light("lamp", {0, 0, 1.5f}));
  CHECK_VERDICT(counts_agree(counts_in_rings(scene, 3), expected_in_rings([](double r) {
                               return 0.5 * (1 - 1.5 / std::hypot(1.5, r));
                             })));
}

TEST_CASE("A spot light fills the rings below it by the falloff of KHR_lights_punctual") {
  for (const auto& cone :
       {std::pair{0.0f, 0.7853982f}, std::pair{0.3f, 0.6f}, std::pair{0.5f, 0.5f}}) {
    const auto inner = cone.first, outer = cone.second;
    const Scene scene = lit_plate(spot_light(inner, outer));
    // Intensity at an angle as the extension's specification writes it, integrated numerically.
    const double cos_outer = std::cos(outer), width = std::cos(inner) - cos_outer;
    const auto flux_within = [&](double angle) {
      constexpr int steps = 200'000;
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        const double theta = angle * (i + 0.5) / steps, c = std::cos(theta) - cos_outer;
        const double a = width > 1e-9 ? std::clamp(c / width, 0.0, 1.0) : (c > 0 ? 1.0 : 0.0);
        sum += a * a * std::sin(theta) * angle / steps;
      }
      return sum;
    };
    const double all = flux_within(outer);
    std::vector<double> counts = counts_in_rings(scene, 4);
    std::vector<double> expected = expected_in_rings(
        [&](double r) { return flux_within(std::min<double>(outer, std::atan2(r, 1.5))) / all; });
    // The dark rings outside the cone join the last bin, in which nothing may fall but they must.
    while (expected.size() > 2 && expected.back() < 5) {
      expected[expected.size() - 2] += expected.back();
      counts[counts.size() - 2] += counts.back();
      expected.pop_back();
      counts.pop_back();
    }
    CAPTURE(inner, outer);
    CHECK_VERDICT(counts_agree(counts, expected));
  }
}

TEST_CASE("A directional light gives E = flux cos(theta) / (pi R^2) evenly over a plate") {
  const Light sun = sun_along(glm::normalize(glm::vec3(0.6f, 0.2f, -0.9f)));
  const Scene scene = lit_plate(sun);
  const double disc = M_PI * std::pow(bounding_sphere(scene).radius, 2);
  CHECK_VERDICT(counts_agree(counts_in_rings(scene, 5), expected_in_rings([&](double r) {
                               return M_PI * r * r * -sun.direction.z / disc;
                             })));
}

TEST_CASE("A square lamp lights the square opposite by the form factor of parallel squares") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, black);
  builder.grid({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2, black, lamp);
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const std::vector<double> fluxes = of_seeds([&](std::uint64_t seed) {
    const Photons photons = trace_photons(rays, {.emitted_photons = 50'000, .seed = seed}).photons;
    double flux = 0;
    for (const glm::vec3& f : photons.flux) flux += luminance(f);
    return flux;
  });
  // Howell, Catalog of radiation heat transfer configuration factors, C-11, unit squares 1 m apart.
  const double root = std::sqrt(2.0);
  const double form_factor =
      2 / M_PI *
      (std::log(std::sqrt(4.0 / 3.0)) + 2 * root * std::atan(1 / root) - 2 * std::atan(1.0));
  CHECK_VERDICT(mean_is(fluxes, form_factor, 0.006));
}

TEST_CASE("An area light emits evenly over its triangles by the cosine law, from its front only") {
  // Three triangles of different sizes, in z = 0 and facing up.
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  const bool two_sided = GENERATE(false, true);
  const std::uint32_t lamp = builder.add(area_light("lamp", 1, two_sided));
  builder.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, black, lamp);
  builder.triangle({2, 0, 0}, {5, 0, 0}, {2, 1, 0}, black, lamp);
  builder.triangle({6, 0, 0}, {6.5f, 0, 0}, {6, 1, 0}, black, lamp);
  const Scene scene = builder.build();
  const LightEmitter emitter(scene, lamp, bounding_sphere(scene));

  std::vector<double> indices(6, 0.0), cosines(20, 0.0);
  for (std::uint64_t i = 0; i < paths; ++i) {
    const EmittedRay ray = emitter.emit(RandomStream(6, i, 0));
    const bool up = ray.direction.z > 0;
    REQUIRE((up || two_sided));
    REQUIRE(ray.origin.z * ray.direction.z > 0);
    ++indices[(ray.origin.x < 1.5f ? 0 : ray.origin.x < 5.5f ? 2 : 4) + (up ? 0 : 1)];
    ++cosines[std::min<std::size_t>(
        static_cast<std::size_t>(20 * ray.direction.z * ray.direction.z), 19)];
  }
  CHECK_VERDICT(counts_agree(cosines, std::vector<double>(20, paths / 20.0)));
  const std::array<double, 3> shares{0.5 / 2.25, 1.5 / 2.25, 0.25 / 2.25};
  if (two_sided) {
    std::vector<double> expected;
    for (const double share : shares)
      expected.insert(expected.end(), {0.5 * share * paths, 0.5 * share * paths});
    CHECK_VERDICT(counts_agree(indices, expected));
  } else {
    CHECK(indices[1] + indices[3] + indices[5] == 0);
    CHECK_VERDICT(counts_agree({indices[0], indices[2], indices[4]},
                               {shares[0] * paths, shares[1] * paths, shares[2] * paths}));
  }
}

TEST_CASE("An area light whose winding is turned emits from its other side") {
  SceneBuilder builder;
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.quad({0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, builder.add(Material()), lamp);
  const Scene scene = builder.build();
  const LightEmitter emitter(scene, lamp, bounding_sphere(scene));
  for (std::uint64_t i = 0; i < 1000; ++i)
    REQUIRE(emitter.emit(RandomStream(6, i, 0)).direction.z < 0);
}

TEST_CASE("An area light without area is an input error that names it and the file") {
  Scene scene = plate(diffuse(0.5f), 1);
  scene.lights.push_back(area_light("Bulb"));
  CHECK_THROWS_WITH(trace_photons(RayScene(scene), {}),
                    Catch::Contains("plate") && Catch::Contains("Bulb"));
  CHECK_THROWS_AS(trace_photons(RayScene(scene), {}), InputError);
}

// Lamps with measured intensities: where their photons go, and what paths see of them.

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
  Scene scene = plate(diffuse(0.0f), 40.0f, 2);
  Light light = point_light("lamp", {0, 0, height});
  light.x_axis = x_axis;
  light.distribution = 0;
  light.power = lamp.flux();
  scene.distributions.push_back(std::move(lamp));
  scene.lights.push_back(light);
  return scene;
}

TEST_CASE("photons of a measured lamp go where its intensity says, in every cell of its grid",
          "[intensity]") {
  // Bilinear between zeros and peaks, turned about two axes, and not its own mirror image.
  const IntensityDistribution lamp = distribution(4, 180, 6, [](double p, double a) {
    return (p == 0 || p == 180 ? 5 : 10) +
           9 * std::cos((2 * a - 50) * pi / 180) * std::sin(p * pi / 180);
  });
  Scene scene = plate(diffuse(0.0f), 1.0f);
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

}  // namespace
}  // namespace photile::test
