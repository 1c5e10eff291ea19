// Lamps: where their light falls, and how they are looked at.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numbers>
#include <set>

#include "path_irradiance.hpp"
#include "photile/errors.hpp"
#include "photile/photons.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/direct_light.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/light_emitter.hpp"
#include "trace/light_sampler.hpp"
#include "uniform.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using namespace photile::trace;
using std::numbers::pi;

// Where the light of each kind of lamp falls, against closed forms.

constexpr std::uint64_t paths = 200'000;
constexpr float half_side = 2.0f;

/// A black plate of 4 x 4 m in z = 0 under one light.
Scene lit_plate(const Light& light) {
  Scene scene = plate(diffuse(glm::vec3(0.0f)), 2 * half_side);
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
    const bool on_top = sided_normal(scene, photons.sided_triangle[i]).z > 0;
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
  Light light = point_light("spot", {0, 0, 1.5f});
  light.kind = LightKind::spot;
  light.inner_cone_angle = inner;
  light.outer_cone_angle = outer;
  return light;
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
  Light sun = point_light("sun", glm::vec3(0.0f));
  sun.kind = LightKind::directional;
  sun.direction = glm::normalize(glm::vec3(0.6f, 0.2f, -0.9f));
  const Scene scene = lit_plate(sun);
  const double disc = M_PI * std::pow(bounding_sphere(scene).radius, 2);
  CHECK_VERDICT(counts_agree(counts_in_rings(scene, 5), expected_in_rings([&](double r) {
                               return M_PI * r * r * -sun.direction.z / disc;
                             })));
}

TEST_CASE("A square lamp lights the square opposite by the form factor of parallel squares") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, black);
  builder.grid({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2, black, lamp);
  const Scene scene = builder.build();
  const RayScene rays(scene);
  std::vector<double> fluxes;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Photons photons = trace_photons(rays, {.emitted_photons = 50'000, .seed = seed}).photons;
    double flux = 0;
    for (const glm::vec3& f : photons.flux) flux += luminance(f);
    fluxes.push_back(flux);
  }
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
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  const bool two_sided = GENERATE(false, true);
  const std::uint32_t lamp = builder.add(area_light("lamp", 1, two_sided));
  builder.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, black, lamp);
  builder.triangle({2, 0, 0}, {5, 0, 0}, {2, 1, 0}, black, lamp);
  builder.triangle({6, 0, 0}, {6.5f, 0, 0}, {6, 1, 0}, black, lamp);
  const Scene scene = builder.build();
  const LightEmitter emitter(scene, lamp, bounding_sphere(scene));

  std::vector<double> places(6, 0.0), cosines(20, 0.0);
  for (std::uint64_t i = 0; i < paths; ++i) {
    const EmittedRay ray = emitter.emit(RandomStream(6, i, 0));
    const bool up = ray.direction.z > 0;
    REQUIRE((up || two_sided));
    REQUIRE(ray.origin.z * ray.direction.z > 0);
    ++places[(ray.origin.x < 1.5f ? 0 : ray.origin.x < 5.5f ? 2 : 4) + (up ? 0 : 1)];
    ++cosines[std::min<std::size_t>(
        static_cast<std::size_t>(20 * ray.direction.z * ray.direction.z), 19)];
  }
  CHECK_VERDICT(counts_agree(cosines, std::vector<double>(20, paths / 20.0)));
  const std::array<double, 3> shares{0.5 / 2.25, 1.5 / 2.25, 0.25 / 2.25};
  if (two_sided) {
    std::vector<double> expected;
    for (const double share : shares)
      expected.insert(expected.end(), {0.5 * share * paths, 0.5 * share * paths});
    CHECK_VERDICT(counts_agree(places, expected));
  } else {
    CHECK(places[1] + places[3] + places[5] == 0);
    CHECK_VERDICT(counts_agree({places[0], places[2], places[4]},
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
  Scene scene = plate(diffuse(glm::vec3(0.5f)), 1);
  scene.lights.push_back(area_light("Bulb"));
  CHECK_THROWS_WITH(trace_photons(RayScene(scene), {}),
                    Catch::Contains("plate") && Catch::Contains("Bulb"));
  CHECK_THROWS_AS(trace_photons(RayScene(scene), {}), InputError);
}

// Lamps with measured intensities: where their photons go, and what paths see of them.

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
    const glm::dvec3 local = axes.to_lamp(
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

// Looks at lamps that go by what is near a point: unbiased, and with less noise.

constexpr int lamps_in_row = 12;
constexpr double lamp_side = 0.1, lamp_height = 0.4;

glm::dvec3 corner_of_lamp(int lamp) {
  return {0.5 * lamp - lamp_side / 2, -lamp_side / 2, lamp_height};
}

/// A floor in z = 0 under a row of small lamps along x that are one light, half a metre apart.
SceneBuilder floor_under_row() {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  builder.grid({-1, -1, 0}, {8, 0, 0}, {0, 2, 0}, 1, black);
  const std::uint32_t row = builder.add(area_light("row", 1.0));
  for (int lamp = 0; lamp < lamps_in_row; ++lamp) {
    // Its front looks down.
    builder.grid(glm::vec3(corner_of_lamp(lamp)), {0, lamp_side, 0}, {lamp_side, 0, 0}, 1, black,
                 row);
  }
  return builder;
}

/// Irradiance on the floor by the row.
double by_row(const glm::dvec3& point) {
  double factors = 0;
  for (int lamp = 0; lamp < lamps_in_row; ++lamp) {
    factors += validation::rectangle_factor(point, {0, 0, 1}, corner_of_lamp(lamp),
                                            {lamp_side, 0, 0}, {0, lamp_side, 0});
  }
  return factors / (lamps_in_row * lamp_side * lamp_side);
}

/// Mean of what looks find, and its variance for a single look.
struct Looked {
  std::array<double, 2> mean{};  ///< per layer
  double variance = 0;           ///< of all layers together
};

Looked look(const LightSampler& lamps, const glm::vec3& point,
            const SelectionProbabilities& probabilities, int count) {
  Looked looked;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const RandomStream random(5, static_cast<std::uint64_t>(i), 0);
    const auto lamp = lamps.sample(point, random.block(Purpose::direct_light, 0),
                                   random.block(Purpose::direct_light, 1), probabilities);
    if (!lamp || !(lamp->direction.z > 0)) continue;
    const double found = double{lamp->direction.z} * luminance(glm::dvec3(lamp->received));
    looked.mean[lamp->layer] += found / count;
    sum += found / count;
    squares += found * found / count;
  }
  looked.variance = squares - sum * sum;
  return looked;
}

TEST_CASE(
    "lamp clusters: looks from a point are unbiased, and have less noise near one lamp of many") {
  SceneBuilder builder = floor_under_row();
  constexpr double power = 0.3;
  const glm::vec3 bulb(3, 0.5f, 1);
  builder.add(point_light("bulb", bulb, power));
  const Scene scene = builder.build();
  const LightSampler lamps(scene);
  constexpr int count = 100'000;
  for (const float x : {0.0f, 2.75f, 6.5f}) {
    const glm::vec3 point(x, 0.03f, 0);
    SelectionProbabilities near;
    lamps.weigh(point, {0, 0, 1}, near);
    const Looked looked = look(lamps, point, near, count);
    const double error = std::sqrt(looked.variance / count);
    const glm::dvec3 offset = glm::dvec3(bulb) - glm::dvec3(point);
    const double distance = glm::length(offset);
    const double by_bulb =
        offset.z / (4 * glm::pi<double>() * distance * distance * distance);  // at power 1
    CAPTURE(x, error);
    CHECK(std::abs(looked.mean[0] - by_row(glm::dvec3(point))) < 4 * error);
    CHECK(std::abs(looked.mean[1] - by_bulb) < 4 * error);
    CHECK(error < 0.01 * (by_row(glm::dvec3(point)) + by_bulb));
    if (x < 3) {
      CHECK(looked.variance < 0.3 * look(lamps, point, by_power_alone, count).variance);
    }
  }
}

TEST_CASE(
    "lamp clusters: a disc of many triangles gives its form factor, and each its share of looks") {
  // Slices of unequal angles, so that their areas differ.
  constexpr int slices = 64;
  constexpr double radius = 0.06, height = 0.7;
  const auto rim = [](int slice) {
    const double turn = double(slice) / slices;
    const double angle = glm::two_pi<double>() * turn * (0.5 + 0.5 * turn);
    return glm::vec3(radius * std::cos(angle), radius * std::sin(angle), height);
  };
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, black);
  const std::uint32_t disc = builder.add(area_light("disc", 1.0));
  for (int slice = 0; slice < slices; ++slice) {  // fronts look down
    builder.triangle({0, 0, height}, rim(slice + 1), rim(slice), black, disc);
  }
  const Scene scene = builder.build();
  const LightSampler lamps(scene);
  const glm::vec3 point(0.0f);
  SelectionProbabilities near;
  lamps.weigh(point, {0, 0, 1}, near);
  constexpr int count = 100'000;
  const Looked looked = look(lamps, point, near, count);
  // A lumen over the area, times the disc's form factor; the polygon lacks little of the disc.
  const double expected = 1 / (glm::pi<double>() * (radius * radius + height * height));
  const double error = std::sqrt(looked.variance / count);
  CAPTURE(looked.mean[0], expected, error);
  CHECK(std::abs(looked.mean[0] - expected) < 4 * error + 2e-4 * expected);
  // All of it is seen from there under nearly the same angle, so that each look finds nearly the
  // same.
  CHECK(looked.variance < 0.02 * expected * expected);
}

TEST_CASE("lamp clusters: densities of directions towards lamps integrate to one") {
  const Scene scene = floor_under_row().build();
  const LightSampler lamps(scene);
  const glm::vec3 point(1.1f, 0.2f, 0);
  SelectionProbabilities near;
  lamps.weigh(point, {0, 0, 1}, near);
  Uniform uniform(7);
  constexpr int points_of_triangle = 2000;
  double sum = 0;
  for (const std::uint32_t triangle : scene.lights[0].triangles) {
    for (int i = 0; i < points_of_triangle; ++i) {
      const float u = uniform();
      const glm::vec2 uv = sample_triangle(u, uniform());
      const SurfacePoint emitting =
          surface_point(scene, {triangle, uv.x, uv.y}, scene.front_side[triangle]);
      const glm::dvec3 offset = glm::dvec3(point) - glm::dvec3(emitting.position);
      const double squared = glm::dot(offset, offset);
      const double cosine = glm::dot(offset, glm::dvec3(emitting.normal)) / std::sqrt(squared);
      sum += double{lamps.density(point, emitting, near)} * cosine / squared *
             triangle_area(scene, triangle) / points_of_triangle;
    }
  }
  CHECK(sum == Approx(1).epsilon(1e-3));
}

TEST_CASE("lamp clusters: looks from one point choose other triangles of a cluster each") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 32, black, builder.add(area_light("panel")));
  const Scene scene = builder.build();
  const LightClusters clusters(scene, std::vector<double>{1.0}, bounding_sphere(scene));
  SelectionProbabilities probabilities;
  clusters.weigh({0.5f, 0.5f, 3}, {0, 0, -1}, probabilities);
  REQUIRE(probabilities.up_to.size() <= 64);
  const LightSampleNumbers looks(RandomStream(1, 2, 0), 0);
  constexpr std::uint32_t count = 256;
  std::set<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const LightNumbers numbers = looks.lamp(i);
    triangles.insert(clusters.choose(probabilities, numbers.lamp, numbers.place).triangle);
  }
  // There are 2048; were they drawn at random, 15 would be drawn again.
  CHECK(triangles.size() > count - 40);
}

TEST_CASE("lamp clusters: the largest number below one chooses the last of all lamps") {
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(diffuse(glm::vec3(0.0f))));
  constexpr std::size_t count = 29;  // so many equal shares sum to less than one
  for (std::size_t lamp = 0; lamp < count; ++lamp) builder.add(point_light("bulb", {0, 0, 1}));
  const Scene scene = builder.build();
  const RandomBlock largest = RandomBlock::of(1 - 0x1p-53);
  const auto by_shares = LightSampler(scene).sample(glm::vec3(0.0f), largest, largest);
  REQUIRE(by_shares);
  CHECK(by_shares->layer == count - 1);
  const LightClusters clusters(scene, std::vector<double>(count, 1.0 / count),
                               bounding_sphere(scene));
  SelectionProbabilities probabilities;
  clusters.weigh(glm::vec3(0.0f), {0, 0, -1},
                 probabilities);  // away from the lamps: by their shares
  REQUIRE(probabilities.up_to.back() < 1);
  CHECK(clusters.choose(probabilities, largest, largest).cluster == count - 1);
}

TEST_CASE("lamp clusters: triangles with the same middle are not parted") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.triangle({3, 0, 0}, {0, 3, 0}, {0, 0, 0}, black, lamp);
  builder.triangle({2, 1, 0}, {1, 2, 0}, {0, 0, 0}, black, lamp);
  const Scene scene = builder.build();
  const LightClusters clusters(scene, std::vector<double>{1.0}, bounding_sphere(scene));
  SelectionProbabilities probabilities;
  clusters.weigh({1, 1, 2}, {0, 0, -1}, probabilities);
  CHECK(probabilities.up_to.size() == 1);
  CHECK(clusters.area(0) == Approx(4.5 + 1.5));
  // Each as often as its area says.
  const auto chosen = [&](double place) {
    const RandomBlock first = RandomBlock::of(0);
    return clusters.choose(probabilities, first, RandomBlock::of(place)).triangle;
  };
  CHECK(chosen(0.74) == chosen(0));
  CHECK(chosen(0.76) != chosen(0));
}

}  // namespace
}  // namespace photile::test
