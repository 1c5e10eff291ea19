// Irradiance gathered by rays, against closed forms and the path tracer.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include "cache/irradiance_gather.hpp"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <numbers>

#include "gathering.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "render/path_estimate.hpp"
#include "render/pictures.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "trace/emission_sampling.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

const glm::dvec3 up(0, 0, 1);

double lux(const LightTable& light, std::size_t estimate) {
  return luminance(glm::dvec3(light.irradiance[estimate]));
}

/// A floor, and a lamp that shines up, away from it, at a mirror 0.2 m above. Material 0 is black.
SceneBuilder lamp_below_mirror() {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 2, black);
  builder.grid({-9, -9, 1.2f}, {0, 18, 0}, {18, 0, 0}, 1, builder.add(mirror({1, 1, 1})));
  builder.grid({1.1f, -0.2f, 1}, {0.2f, 0, 0}, {0, 0.4f, 0}, 1, black,
               builder.add(area_light("lamp")));
  return builder;
}

/// What that floor gets at unit power, W/m2: the lamp's image is 1.4 m above it.
double lux_of_image(const glm::dvec3& position) {
  return validation::rectangle_factor(position, up, {1.1, -0.2, 1.4}, {0.2, 0, 0}, {0, 0.4, 0}) /
         (0.2 * 0.4);
}

/// Mean and squared error of the mean over paths, per light and sensor, row-major [sensor][light].
struct PathReference {
  std::vector<double> lux, variance;
};

PathReference by_paths(const RayScene& rays, const std::vector<Sensor>& sensors, int paths) {
  const std::size_t lights = rays.needs().light_count;
  PathReference result{std::vector<double>(sensors.size() * lights),
                       std::vector<double>(sensors.size() * lights)};
  const PrimaryHits hits = trace::sensor_hits(rays, sensors);
  std::vector<double> squares(result.lux.size(), 0.0);
  const PathEstimator estimator(rays, 7);
  for (int path = 0; path < paths; ++path) {
    std::vector<std::uint64_t> number = numbers(sensors.size());
    for (std::uint64_t& one : number) one = one * static_cast<std::uint64_t>(paths) + path;
    const LightTable estimates = estimator.estimate(hits, number);
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const double value = luminance(glm::dvec3(estimates.irradiance[i]));
      result.lux[i] += value / paths;
      squares[i] += value * value / paths;
    }
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    result.variance[i] = (squares[i] - result.lux[i] * result.lux[i]) / (paths - 1);
  }
  return result;
}

double sum_of(const LightTable& light) {
  double sum = 0;
  for (std::size_t i = 0; i < light.rows(); ++i) sum += lux(light, i);
  return sum;
}

/// The light of all sensors together over that by paths.
double ratio_to_paths(GatheringScene& room, const std::vector<Sensor>& sensors,
                      const cache::IrradianceGatherParameters& parameters) {
  const PathReference truth = by_paths(room.rays, sensors, 4096);
  return sum_of(room.at(sensors, parameters)) /
         std::accumulate(truth.lux.begin(), truth.lux.end(), 0.0);
}

/// Floor, wall and table top of the furnished room, corners among them.
std::vector<Sensor> room_sensors(int count) {
  std::vector<Sensor> sensors = sensors_on({0, 0, 0}, {2.2, 0, 0}, {0, 1.5, 0}, up, count);
  for (const auto& more : {sensors_on({0, 0, 0}, {4, 0, 0}, {0, 0, 2.4}, {0, 1, 0}, count),
                           sensors_on({2.3, 0.5, 0.6}, {0.8, 0, 0}, {0, 0.8, 0}, up, count)}) {
    sensors.insert(sensors.end(), more.begin(), more.end());
  }
  return sensors;
}

/// Whether light gathered in a room is that of the path tracer, layer by layer.
///   bias   root mean square of what photons are wrong by, relative
void check_against_paths(const Scene& scene, double bias,
                         const cache::IrradianceGatherParameters& parameters = {}) {
  GatheringScene room(scene, looked_up(400'000));
  const std::vector<Sensor> sensors = room_sensors(5);
  const LightTable light = room.at(sensors, parameters);
  const PathReference truth = by_paths(room.rays, sensors, 4096);
  REQUIRE(light.irradiance.size() == truth.lux.size());
  double squares = 0, relative = 0, error = 0;
  const auto count = static_cast<double>(truth.lux.size());
  for (std::size_t i = 0; i < truth.lux.size(); ++i) {
    const double difference = lux(light, i) - truth.lux[i];
    const double allowed =
        std::pow(light.error(i), 2) + truth.variance[i] + std::pow(bias * truth.lux[i], 2);
    CAPTURE(i, lux(light, i), light.error(i), truth.lux[i], std::sqrt(truth.variance[i]));
    CHECK(difference * difference < 25 * allowed);
    squares += difference * difference / allowed / count;
    relative += difference / truth.lux[i] / count;
    error += light.error(i) / truth.lux[i] / count;
  }
  CAPTURE(error);
  CHECK(squares < 1.5);
  CHECK(std::abs(relative) < 0.01);
}

}  // namespace

TEST_CASE("gathering: a furnace reads its closed form, in corners, too") {
  constexpr double albedo = 0.5;
  const Scene scene = furnace(diffuse(albedo));
  std::vector<Sensor> sensors{{{0.4, 0.6, 0}, up}};
  for (const double x : {0.02, 0.98})
    for (const double y : {0.03, 0.97}) sensors.push_back({{x, y, 0}, up});
  std::vector<double> middle, corners;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    GatheringScene box(scene, looked_up(100'000, seed));
    cache::IrradianceGatherParameters parameters;
    parameters.seed = seed;
    const LightTable light = box.at(sensors, parameters);
    middle.push_back(lux(light, 0));
    corners.push_back((lux(light, 1) + lux(light, 2) + lux(light, 3) + lux(light, 4)) / 4);
  }
  const double truth = 1.0 / 6 / (1 - albedo);  // 1 lm over 6 m2, and each bounce returns half
  CHECK_VERDICT(mean_is(middle, truth, 0.04 * truth));
  CHECK_VERDICT(mean_is(corners, truth, 0.04 * truth));
}

TEST_CASE("gathering: lamps and suns without size are sampled once, which is exact") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 2, black);
  builder.grid({0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}, 1, black, builder.add(area_light("lamp")));
  const glm::dvec3 bulb(-0.4, 0.3, 1.2);
  builder.add(point_light("bulb", glm::vec3(bulb), 0.2));
  builder.grid({-2, 0.9f, 0.5f}, {4, 0, 0}, {0, 0.2f, 0}, 1, black);  // it hides the bulb beyond
  GatheringScene place(builder.build(), looked_up(20'000));
  const std::vector<Sensor> sensors = sensors_on({-1.5, -1.5, 0}, {3, 0, 0}, {0, 3, 0}, up, 20);
  const LightTable light = place.at(sensors);
  int dark = 0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::size_t of_bulb = 2 * i + 1;
    const glm::dvec3 offset = bulb - sensors[i].position;
    // Where the line to the bulb passes through the height of the screen.
    const double y = sensors[i].position.y + offset.y * 0.5 / offset.z;
    const bool hidden = y > 0.9 && y < 1.1;
    dark += hidden ? 1 : 0;
    CHECK(lux(light, of_bulb) ==
          Approx(hidden ? 0.0 : offset.z / (4 * pi * std::pow(glm::length(offset), 3)))
              .epsilon(1e-5)
              .margin(1e-12));
    CHECK(light.error(of_bulb) <= 1e-7 * lux(light, of_bulb));
  }
  CHECK(dark > 10);
}

TEST_CASE("gathering: layers of a furnished room are those of paths") {
  check_against_paths(furnished_room(), 0.03);
}

TEST_CASE("gathering: light gathered from near surface is that of paths, with less bias") {
  Scene scene = furnished_room();
  check_against_paths(scene, 0.015, {.near = 0.6});
}

TEST_CASE("gathering: light gathered from near coats is that of paths, with less bias", "[slow]") {
  Scene scene = furnished_room();
  for (Material& material : scene.materials) {
    material = glossy(0.5f, 0.04f, 0.3f);
  }
  check_against_paths(scene, 0.02, {.near = 0.6});
}

TEST_CASE("gathering: a board within a rim of metal is lit as paths find it") {
  // Its edge is held by a closed profile, where next to no light is; photons of the faces of that
  // which look up count among the neighbours of those that look aside.
  SceneBuilder builder;
  builder.box(glm::vec3(-2, -2, 0), glm::vec3(4, 2, 3), builder.add(diffuse(0.5f)), true);
  builder.grid({-0.004f, -1, 0.008f}, {1.5f, 0, 0}, {0, 2, 0}, 2, builder.add(diffuse(0.7f)));
  const std::uint32_t metal = builder.add(glossy(0.0f, 0.58f, 0.4f));
  const std::vector<glm::vec3> profile{{0, -1, 0.001f},         {0, -1, 0.0108f},
                                       {-0.0018f, -1, 0.0115f}, {-0.0048f, -1, 0.0177f},
                                       {-0.0108f, -1, 0.02f},   {-0.0156f, -1, 0.0177f},
                                       {-0.018f, -1, 0.0115f},  {-0.018f, -1, 0.001f}};
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    builder.grid(profile[i], {0, 2, 0}, profile[i + 1] - profile[i], 1, metal);
  }
  builder.grid({3.99f, -1, 1}, {0, 0, 1}, {0, 2, 0}, 1, builder.add(diffuse(0.0f)),
               builder.add(area_light("lamp")));
  GatheringScene room(builder.build(), looked_up(200'000));
  const auto sensors_from = [&](double x, double width) {
    return sensors_on({x, -0.5, 0.0081}, {width, 0, 0}, {0, 1, 0}, up, 5);
  };
  const std::vector<Sensor> rim = sensors_from(-0.003, 0.002), board = sensors_from(0.005, 0.03);
  // Photons in the faces of the rim would make it 0.064, and the board 0.984.
  CHECK(sum_of(room.at(rim, {.near = 0.2})) < 0.05 * sum_of(room.at(board, {.near = 0.2})));
  CHECK(ratio_to_paths(room, board, {.near = 0.2}) == Approx(1).margin(0.01));
}

TEST_CASE("gathering: what slats reflect into a room is the light of the parts that it sees") {
  // Their outer edges, next to the window, are much brighter than what the room sees of them, and
  // an estimate of photons is wider than a slat.
  SceneBuilder builder;
  builder.box(glm::vec3(0), glm::vec3(4, 3, 2.7f), builder.add(diffuse(0.02f)), true);
  builder.grid({1.2f, 0.002f, 0.9f}, {0, 0, 1.2f}, {1.6f, 0, 0}, 1, builder.add(diffuse(0.0f)),
               builder.add(area_light("window")));
  const std::uint32_t white = builder.add(diffuse(0.7f));
  for (float z = 0.9f; z < 2.1f; z += 0.022f) {
    builder.grid({1.2f, 0.01f, z}, {1.6f, 0, 0}, {0, 0.0205f, 0.0143f}, 1, white);
  }
  GatheringScene room(builder.build(), looked_up(200'000));
  const std::vector<Sensor> sensors = sensors_on({1, 0.8, 0}, {2, 0, 0}, {0, 1.6, 0}, up, 8);
  CHECK(ratio_to_paths(room, sensors, {.rays = 1024, .near = 0.08}) == Approx(1).margin(0.03));
}

TEST_CASE("gathering: walls get from a coated floor in the sun what paths find") {
  // Steep light taken as from all sides would be 7% too much; a matt floor tells other errors.
  double to_paths[2] = {0, 0};
  for (const bool coated : {false, true}) {
    SceneBuilder builder;
    builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 4,
                 builder.add(coated ? glossy(0.6f, 0.04f, 0.2f) : diffuse(0.6f)));
    builder.grid({-2, 2, 0}, {4, 0, 0}, {0, 0, 3}, 3, builder.add(diffuse(0.0f)));
    builder.add(sun_along(glm::normalize(glm::vec3(0.2f, -0.1f, -1))));
    GatheringScene room(builder.build(), looked_up(400'000));
    to_paths[coated] = ratio_to_paths(
        room, sensors_on({-1, 2, 0.3}, {2, 0, 0}, {0, 0, 1.5}, {0, -1, 0}, 6), {.rays = 1024});
  }
  CHECK(to_paths[1] == Approx(to_paths[0]).epsilon(0.01));
}

TEST_CASE("gathering: layers of glossy rooms are those of paths", "[slow]") {
  Scene scene = furnished_room();
  SECTION("a coat on the floor and the walls") { scene.materials[0] = glossy(0.6f, 0.04f, 0.3f); }
  SECTION("a metal") { scene.materials[1] = glossy(glm::vec3(0.0f), {0.9f, 0.7f, 0.5f}, 0.3f); }
  SECTION("a mirror") { scene.materials[1] = mirror({0.9f, 0.8f, 0.7f}); }
  scene.lights.pop_back();  // paths cannot find caustics of lamps without size
  check_against_paths(scene, 0.04);
}

TEST_CASE("gathering: the light of a caustic arrives once") {
  const Scene scene = lamp_below_mirror().build();
  const std::vector<Sensor> sensors = sensors_on({-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0}, up, 6);
  double squares = 0, stated = 0;
  const std::vector<double> ratio = of_seeds([&](std::uint64_t seed) {
    GatheringScene place(scene, looked_up(60'000, seed));
    const LightTable light = place.at(sensors);
    double sum = 0, truth = 0;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      const double expected = lux_of_image(sensors[i].position);
      sum += lux(light, i);
      truth += expected;
      CHECK(light.error(i) > 0.05 * lux(light, i));  // that of 100 photons at least, about
      CHECK(light.error(i) < 0.2 * lux(light, i));
      squares += std::pow(lux(light, i) - expected, 2);
      stated += std::pow(light.error(i), 2);
    }
    return sum / truth;
  });
  CHECK_VERDICT(mean_is(ratio, 1.0, 0.1));
  const double error_over_stated = std::sqrt(squares / stated);
  CAPTURE(error_over_stated);
  CHECK(error_over_stated < 1.25);
  CHECK(error_over_stated > 0.4);
}

TEST_CASE("gathering: a picture has direct light once, and the caustic beside it once") {
  SceneBuilder builder;
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 2, builder.add(diffuse(0.0f)));
  builder.grid({-9, -9, 1.2f}, {0, 18, 0}, {18, 0, 0}, 1, builder.add(mirror({1, 1, 1})));
  builder.add(point_light("lamp", {0.8f, 0, 1}));
  RenderParameters parameters = small_picture(60'000, 12, 12);
  parameters.light_maps = LightMapMode::on;
  parameters.light_map_rays = 64;
  const auto picture = render(builder.build(), above(0, 0, 1.1, 0.6), device(), parameters);
  const std::vector<float>& found = picture.layers.layers[0].illuminance;
  double sum = 0, truth = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double x = (static_cast<double>(i % 12) + 0.5) / 20 - 1.1;
    const double y = (static_cast<double>(i / 12) + 0.5) / 20 - 0.3;
    sum += double{found[i]};
    for (const double height : {1.0, 1.4}) {
      truth += height / (4 * pi * std::pow(x * x + y * y + height * height, 1.5));
    }
  }
  CHECK(sum / truth == Approx(1).margin(0.05));
}

TEST_CASE("gathering: a caustic ends where the image of its mirror ends") {
  // A spot shines up at a mirror of 0.2 m, 0.2 m above: its image, 1.4 m above the floor, lights a
  // square of 1.4 m.
  SceneBuilder builder;
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 2, builder.add(diffuse(0.0f)));
  builder.grid({-0.1f, -0.1f, 1.2f}, {0, 0.2f, 0}, {0.2f, 0, 0}, 1, builder.add(mirror(1.0f)));
  const Light spot = spot_light("spot", {0, 0, 1}, {0, 0, 1}, 1.0f, 1.1f);
  builder.add(spot);
  const double candela = 1 / (2 * pi * trace::SpotFalloff(spot).integral());
  GatheringScene place(builder.build(), looked_up(60'000));
  const std::vector<Sensor> within = sensors_on({-0.6, 0.66, 0}, {1.2, 0, 0}, {0, 0.02, 0}, up, 6);
  const std::vector<Sensor> beyond = sensors_on({-0.6, 0.8, 0}, {1.2, 0, 0}, {0, 0.1, 0}, up, 6);
  const LightTable lit = place.at(within), dark = place.at(beyond);
  double sum = 0, truth = 0, spilt = 0;
  for (std::size_t i = 0; i < within.size(); ++i) {
    const glm::dvec3 p = within[i].position;
    sum += lux(lit, i);
    truth += candela * 1.4 / std::pow(p.x * p.x + p.y * p.y + 1.4 * 1.4, 1.5);
    spilt += lux(dark, i);
  }
  CAPTURE(sum, truth, spilt);
  CHECK(sum / truth == Approx(1).margin(0.04));
  CHECK(spilt / truth < 0.02);
}

TEST_CASE("gathering: no caustic shines through a screen that stands on the floor") {
  SceneBuilder builder = lamp_below_mirror();
  builder.grid({0, -2, 0}, {0, 4, 0}, {0, 0, 1.1f}, 1, 0);
  const Scene scene = builder.build();
  GatheringScene place(scene, looked_up(60'000, 1));
  const LightTable behind = place.at(sensors_on({-0.2, -0.3, 0}, {0.19, 0, 0}, {0, 0.6, 0}, up, 6));
  for (std::size_t i = 0; i < 36; ++i) CHECK(lux(behind, i) == 0.0);

  // Farther from it than all neighbours are, the floor is lit as without it.
  const std::vector<Sensor> before = sensors_on({0.35, -0.3, 0}, {0.35, 0, 0}, {0, 0.6, 0}, up, 6);
  const LightTable lit = place.at(before);
  double sum = 0, truth = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    sum += lux(lit, i);
    truth += lux_of_image(before[i].position);
  }
  CHECK(sum / truth == Approx(1).margin(0.1));
}

TEST_CASE("gathering: surroundings are direct light, and seen once") {
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, builder.add(diffuse(0.5f)));
  builder.add_surroundings("sky", EnvironmentMap("sky", 1, 1, {glm::vec3(1.0f)}));
  const Scene scene = builder.build();
  GatheringScene open(scene, looked_up(50'000));
  const std::vector<Sensor> sensors = sensors_on({-0.9, -0.9, 0}, {1.8, 0, 0}, {0, 1.8, 0}, up, 4);
  const LightTable light = open.at(sensors);
  // Its flux falls on the disc of the scene's sphere: illuminance on a plane is 1 / that, times pi
  // over 4 pi's share of the sky's hemisphere.
  const double radius = bounding_sphere(scene).radius;
  const double truth = pi * (1 / (pi * radius * radius)) / (4 * pi);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    CHECK(lux(light, i) == Approx(truth).epsilon(0.01).margin(5 * light.error(i)));
  }
}

TEST_CASE("gathering: the stated error is the scatter of other random numbers") {
  GatheringScene room(furnished_room(), looked_up(200'000));
  const std::vector<Sensor> sensors = room_sensors(4);
  constexpr int trials = 24;
  const std::size_t values = 2 * sensors.size();
  std::vector<double> sum(values, 0.0), squares(values, 0.0), stated(values, 0.0);
  for (int trial = 0; trial < trials; ++trial) {
    cache::IrradianceGatherParameters parameters;
    parameters.seed = 100 + static_cast<std::uint64_t>(trial);
    const LightTable light = room.at(sensors, parameters);
    for (std::size_t i = 0; i < values; ++i) {
      sum[i] += lux(light, i) / trials;
      squares[i] += lux(light, i) * lux(light, i) / trials;
      stated[i] += std::pow(light.error(i), 2) / trials;
    }
  }
  double mean_ratio = 0;
  for (std::size_t i = 0; i < values; ++i) {
    const double scatter = (squares[i] - sum[i] * sum[i]) * trials / (trials - 1);
    mean_ratio += scatter / stated[i] / static_cast<double>(values);
  }
  // Each ratio has a relative standard deviation of about 0.3.
  CHECK(mean_ratio == Approx(1).margin(0.15));
}

TEST_CASE("gathering: the same bits in any order of points and on any number of threads") {
  Scene scene = furnished_room(2);
  scene.materials[1] = mirror(0.9f);
  scene.materials[2] = glossy(0.2f, 0.4f, 0.2f);
  GatheringScene room(scene, looked_up(50'000));
  std::vector<Sensor> sensors = room_sensors(16);  // more than one run of rays
  sensors.resize(700);
  const PrimaryHits hits = trace::sensor_hits(room.rays, sensors);
  const std::vector<std::uint64_t> number = numbers(sensors.size());
  cache::IrradianceGatherParameters parameters;
  parameters.rays = 512;
  parameters.light_samples = 16;
  const LightTable expected = room.gather(parameters).gather(hits, number);

  // Every seventh point after another: 700 has to be put in another order without a remainder.
  std::vector<Sensor> shuffled(sensors.size());
  std::vector<std::uint64_t> shuffled_number(sensors.size());
  const auto place = [&](std::size_t i) { return i % 7 * 100 + i / 7; };
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    shuffled[place(i)] = sensors[i];
    shuffled_number[place(i)] = number[i];
  }
  const PrimaryHits shuffled_hits = trace::sensor_hits(room.rays, shuffled);
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const LightTable light = room.gather(parameters).gather(shuffled_hits, shuffled_number);
    bool same = true;
    for (std::size_t i = 0; i < sensors.size(); ++i)
      for (std::size_t layer = 0; layer < 2; ++layer) {
        const std::size_t a = 2 * i + layer, b = 2 * place(i) + layer;
        same = same && expected.irradiance[a] == light.irradiance[b] &&
               expected.error(a) == light.error(b);
      }
    CHECK(same);
  }
}

TEST_CASE("gathering: layers are the same whatever the powers") {
  Scene scene = furnished_room();
  scene.lights.pop_back();  // half of the looks at lamps go by power; at a single lamp all do
  scene.materials[1] = mirror(0.9f);
  RenderParameters parameters = looked_up(50'000);
  parameters.photons.quota = PhotonQuota::equal;
  const std::vector<Sensor> sensors = room_sensors(3);
  const LightTable dim = GatheringScene(scene, parameters).at(sensors);
  scene.lights[0].power *= 1000;
  const LightTable bright = GatheringScene(scene, parameters).at(sensors);
  CHECK(dim.irradiance == bright.irradiance);
  CHECK(dim.batch == bright.batch);
}

TEST_CASE("gathering: many lights, each in its layer, are what their group is") {
  Scene scene = furnished_room();
  add_lamps(scene, 12);
  RenderParameters parameters = looked_up(50'000);
  parameters.radius = 0.3;
  const std::vector<Sensor> sensors = room_sensors(3);
  GatheringScene alone(scene, parameters);
  const LightTable layers = alone.at(sensors);
  REQUIRE(layers.first.size() == sensors.size() + 1);
  double power = 0;
  for (const Light& light : scene.lights) power += light.power;
  for (Light& light : scene.lights) light.group = "all";
  const LightTable together = GatheringScene(scene, parameters).at(sensors);
  REQUIRE(together.irradiance.size() == sensors.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const LightTable::Total total = layers.total(i, alone.estimators.layer_powers());
    CHECK(power * lux(together, i) == Approx(total.luminance).epsilon(1e-4));
    CHECK(power * together.error(i) == Approx(total.error).epsilon(1e-3));
  }
}

TEST_CASE("gathering: parameters out of range are refused") {
  GatheringScene box(closed_box(diffuse(0.5f)), looked_up(1'000));
  const auto refused = [&](const cache::IrradianceGatherParameters& parameters) {
    CHECK_THROWS_AS(box.gather(parameters), UsageError);
  };
  refused({.rays = -1});
  refused({.rays = 1'000'000});
  refused({.light_samples = -1});
  refused({.batches = 1});
}

}  // namespace photile::test
