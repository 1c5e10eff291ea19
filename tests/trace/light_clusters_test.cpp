// Looks at lamps that go by what is near a point: unbiased, and with less noise.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <set>

#include "suns.hpp"
#include "trace/direct_light.hpp"
#include "trace/light_sampler.hpp"
#include "uniform.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using namespace trace;
using std::numbers::pi;

constexpr int lamps_in_row = 12;
constexpr double lamp_side = 0.1, lamp_height = 0.4;

glm::dvec3 corner_of_lamp(int lamp) {
  return {0.5 * lamp - lamp_side / 2, -lamp_side / 2, lamp_height};
}

/// A floor in z = 0 under a row of small lamps along x that are one light, half a metre apart.
SceneBuilder floor_under_row() {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
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

}  // namespace

TEST_CASE(
    "light clusters: light samples of a point are unbiased, and have less noise near one lamp of "
    "many") {
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
    // The bulb has no size: one sample of it is exact, and the others leave it out.
    const Looked looked = look(lamps, point, near, count);
    const auto to_bulb = lamps.towards(1, point);
    REQUIRE(to_bulb);
    const double error = std::sqrt(looked.variance / count);
    const glm::dvec3 offset = glm::dvec3(bulb) - glm::dvec3(point);
    const double distance = glm::length(offset);
    const double by_bulb =
        offset.z / (4 * glm::pi<double>() * distance * distance * distance);  // at power 1
    CAPTURE(x, error);
    CHECK(std::abs(looked.mean[0] - by_row(glm::dvec3(point))) < 4 * error);
    CHECK(looked.mean[1] == 0.0);
    CHECK(double{to_bulb->direction.z} * luminance(glm::dvec3(to_bulb->received)) ==
          Approx(by_bulb).epsilon(1e-5));
    CHECK(std::abs(look(lamps, point, by_power_alone, count).mean[1] - by_bulb) < 0.02 * by_bulb);
    CHECK(error < 0.01 * (by_row(glm::dvec3(point)) + by_bulb));
    if (x < 3) {
      CHECK(looked.variance < 0.3 * look(lamps, point, by_power_alone, count).variance);
    }
  }
}

TEST_CASE(
    "light clusters: of few lights a batch of 32 light samples chooses each just as often as "
    "its probability says") {
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(diffuse(0.0f)));
  for (int disc = 0; disc < 3; ++disc) {  // too wide to be sampled apart
    Light light = sun_along({0, 0, -1}, 0.1f, "disc " + std::to_string(disc));
    light.power = 1.0 + 0.7 * disc;
    builder.add(light);
  }
  const Scene scene = builder.build();
  const LightSampler lamps(scene);
  SelectionProbabilities probabilities;
  lamps.weigh(glm::vec3(0.0f), {0, 0, 1}, probabilities);
  for (std::uint64_t number = 0; number < 20; ++number) {
    const LightSampleNumbers samples(RandomStream(3, number, 0), 0);
    std::array<int, 3> chosen{};
    for (std::uint32_t i = 0; i < 32; ++i) {
      const LightNumbers numbers = samples.light(i);
      const auto light =
          lamps.sample(glm::vec3(0.0f), numbers.choice, numbers.position, probabilities);
      REQUIRE(light);
      ++chosen[light->layer];
    }
    for (std::size_t disc = 0; disc < chosen.size(); ++disc) {
      CHECK(chosen[disc] == Approx(32 * probabilities.of(disc)).margin(1e-9));
    }
  }
}

TEST_CASE(
    "light clusters: a disc of many triangles gives its form factor, and each its share of looks") {
  // Slices of unequal angles, so that their areas differ.
  constexpr int slices = 64;
  constexpr double radius = 0.06, height = 0.7;
  const auto rim = [](int slice) {
    const double turn = double(slice) / slices;
    const double angle = glm::two_pi<double>() * turn * (0.5 + 0.5 * turn);
    return glm::vec3(radius * std::cos(angle), radius * std::sin(angle), height);
  };
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
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

TEST_CASE("light clusters: densities of directions towards lamps integrate to one") {
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

TEST_CASE("light clusters: light samples of one point choose other triangles of a cluster each") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 32, black, builder.add(area_light("panel")));
  const Scene scene = builder.build();
  const LightClusters clusters(scene, std::vector<double>{1.0}, bounding_sphere(scene));
  SelectionProbabilities probabilities;
  clusters.weigh({0.5f, 0.5f, 3}, {0, 0, -1}, probabilities);
  REQUIRE(probabilities.up_to.size() <= 64);
  const LightSampleNumbers light_samples(RandomStream(1, 2, 0), 0);
  constexpr std::uint32_t count = 256;
  std::set<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const LightNumbers numbers = light_samples.light(i);
    triangles.insert(clusters.choose(probabilities, numbers.choice, numbers.position).triangle);
  }
  // There are 2048; were they drawn at random, 15 would be drawn again.
  CHECK(triangles.size() > count - 40);
}

TEST_CASE("light clusters: the largest number below one chooses the last of all lights") {
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(diffuse(0.0f)));
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

TEST_CASE("light clusters: triangles with the same middle are not split") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
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

}  // namespace photile::test
