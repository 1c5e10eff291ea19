// Pictures that read light maps, beside the estimate at each hit, closed forms and each other.
#include <tbb/global_control.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "cache/surface_cache.hpp"
#include "gathering.hpp"
#include "light/light_at_points.hpp"
#include "photile/photons.hpp"
#include "render/pictures.hpp"
#include "render/quality.hpp"

namespace photile::test {
namespace {

RenderParameters with_light_maps() {
  RenderParameters parameters = small_picture(30'000, 64, 48);
  parameters.light_maps = LightMapMode::on;
  return parameters;
}

/// Rows of many lights, a lamp and its copies side by side.
Scene many_lamps() {
  Scene scene = furnished_room(2);
  add_lamps(scene, 20);
  return scene;
}

/// Mean over pixels of (value - expected)^2 / expected^2 of the first light, on a plate of albedo 1
/// under a lamp of 1 W straight above its middle, seen from above.
double error_of_lamp(const LightLayers& layers, double height, double side) {
  double sum = 0;
  for (int y = 0; y < layers.height; ++y) {
    for (int x = 0; x < layers.width; ++x) {
      const double px = ((x + 0.5) / layers.width - 0.5) * side;
      const double py = ((y + 0.5) / layers.height - 0.5) * side;
      const double squared = px * px + py * py + height * height;
      const double irradiance = height / (4 * glm::pi<double>() * std::pow(squared, 1.5));
      const double value =
          layers.layers[0].illuminance[static_cast<std::size_t>(y * layers.width + x)];
      sum += std::pow(value / irradiance - 1, 2);
    }
  }
  return sum / (layers.width * layers.height);
}

TEST_CASE("Light maps are no farther from a lamp's closed form than estimates at hits") {
  Scene scene = plate(diffuse(1.0f), 4, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}));
  RenderParameters parameters = with_light_maps();
  parameters.photons.emitted_photons = 400'000;
  parameters.neighbours = 200;
  parameters.film.width = parameters.film.height = 48;
  const Camera camera = above(0, 0, 30, 2.4);
  const double by_maps = error_of_lamp(render(scene, camera, device(), parameters).layers, 1, 2.4);
  parameters.light_maps = LightMapMode::off;
  const double at_hits = error_of_lamp(render(scene, camera, device(), parameters).layers, 1, 2.4);
  CAPTURE(by_maps, at_hits);
  CHECK(at_hits < 2.0 / 200);  // noise of k photons, and some bias
  CHECK(by_maps <= 1.02 * at_hits);
}

TEST_CASE("Nodes are as far apart as the radius asks, and no closer than half the photons are") {
  const Scene scene = furnished_room(2);
  const Photons photons = trace_photons(RayScene(scene), {.emitted_photons = 2'000}).photons;
  const std::vector<double> powers = light::layer_powers(scene);
  const auto spacing = [&](double radius) {
    return cache::light_map_parameters(scene, photons, 100, radius, 60, 0, 0, powers).spacing;
  };
  CHECK(spacing(0.4) == 2 * spacing(0.2));
  CHECK(spacing(0.4) < 0.4);
  // Half the median distance to the nearest photon, in steps of two.
  const double nearest = automatic_radius(photons, 1) / 2;
  for (const double radius : {1e-4, 1e-8, 1e-12}) {
    CAPTURE(radius);
    CHECK(spacing(radius) >= nearest / 2);
    CHECK(spacing(radius) < nearest);
  }
  CHECK(spacing(2 * nearest) < 1.5 * nearest);  // which is not held back
}

TEST_CASE("Pictures that read light maps are the same bits on one, two and three threads") {
  for (const Scene& scene : {furnished_room(3), many_lamps()}) {
    std::vector<LightLayers> pictures;
    for (const std::size_t threads : {1u, 2u, 3u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      pictures.push_back(render(scene, room_camera(), device(), with_light_maps()).layers);
    }
    CHECK(same_bits(pictures[0], pictures[1]));
    CHECK(same_bits(pictures[0], pictures[2]));
  }
}

TEST_CASE("What was looked at before changes no bit of a picture") {
  const Scene scene = furnished_room(2);
  const RenderParameters parameters = with_light_maps();
  SceneRenderer renderer(scene, std::span(&device(), 1), parameters);
  Film coarse = parameters.film;
  coarse.width = 16, coarse.height = 12, coarse.samples_per_pixel = 1;
  renderer.render(Camera::look_at({0.5, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0), coarse);
  renderer.render(room_camera(), coarse);
  const RenderResult kept = renderer.render(room_camera(), parameters.film);
  const RenderResult again = renderer.render(room_camera(), parameters.film);
  const RenderResult fresh = render(scene, room_camera(), device(), parameters);
  CHECK(same_bits(kept.layers, fresh.layers));
  CHECK(same_bits(again.layers, fresh.layers));
}

TEST_CASE("Rows traced in several batches change no bit of a picture") {
  const Scene scene = furnished_room(2);
  const RenderParameters parameters = with_light_maps();
  const RenderResult whole = render(scene, room_camera(), device(), parameters);
  CHECK(same_bits(whole.layers, picture_in_parts(scene, room_camera(), parameters)));
}

TEST_CASE("A first picture shows a lamp's closed form, whatever brings that light later") {
  Scene scene = plate(diffuse(1.0f), 2, 1);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}));
  constexpr double side = 0.8;
  const Camera camera = above(0, 0, 10, side);
  RenderParameters parameters = with_light_maps();
  parameters.maps = GENERATE(MapMode::automatic, MapMode::naive);
  parameters.light_maps = LightMapMode::automatic;
  parameters.direct_rays = GENERATE(0, 1);
  parameters.light_map_rays = GENERATE(0, 64);
  constexpr double power = 3;
  const int width = parameters.film.width, height = parameters.film.height;
  std::vector<glm::vec3> picture(static_cast<std::size_t>(width * height));
  SceneRenderer renderer(scene, std::span(&device(), 1), first_picture_parameters(parameters));
  renderer.draw(camera, {width, height, 1}, std::vector{glm::vec3(power)},
                std::numeric_limits<double>::infinity(), picture);
  double mean = 0, expected = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double px = ((x + 0.5) / width - 0.5) * side * width / height;
      const double py = ((y + 0.5) / height - 0.5) * side;
      const double irradiance =
          power / (4 * glm::pi<double>() * std::pow(px * px + py * py + 1, 1.5));
      expected += irradiance / glm::pi<double>();
      mean += picture[static_cast<std::size_t>(y * width + x)].y;
    }
  }
  CHECK(mean / expected == Approx(1).margin(0.1));
}

TEST_CASE("A hit on a wall reads the same light from wherever it is seen") {
  // Cameras that look straight at the same points of a plate, from nearer and farther.
  Scene scene = plate(diffuse(0.5f), 2, 1);
  scene.lights.push_back(point_light("lamp", {0.3f, 0.2f, 1}));
  RenderParameters parameters = with_light_maps();
  SceneRenderer renderer(scene, std::span(&device(), 1), parameters);
  const RenderResult first = renderer.render(above(0, 0, 10, 1.6), parameters.film);
  renderer.render(above(0.2, 0.1, 3, 1.0), parameters.film);
  const RenderResult later = renderer.render(above(0, 0, 10, 1.6), parameters.film);
  CHECK(same_bits(first.layers, later.layers));
}

TEST_CASE("Automatic light maps are read by pictures, but not by several passes or naive maps") {
  const Scene scene = furnished_room(2);
  RenderParameters parameters = with_light_maps();
  parameters.light_maps = LightMapMode::automatic;
  const auto used = [&] {
    return render(scene, room_camera(), device(), parameters).used.light_maps;
  };
  CHECK(used() == LightMapMode::on);
  parameters.passes = 2;
  CHECK(used() == LightMapMode::off);
  parameters.passes = 1;
  parameters.maps = MapMode::naive;
  CHECK(used() == LightMapMode::off);
}

TEST_CASE("Bounded light maps whose nodes gather draw the same bits") {
  const Scene scene = furnished_room(2);
  RenderParameters parameters = with_light_maps();
  parameters.light_map_rays = 8;
  const auto renderer = [&] {
    return std::make_unique<SceneRenderer>(scene, std::span(&device(), 1), parameters);
  };
  const auto free = renderer(), bounded = renderer();
  const Film film{24, 16, 1};
  const std::vector<glm::vec3> powers(light_groups_of(scene).groups.size(), glm::vec3(1.0f));
  const auto draw = [&](SceneRenderer& from, double x) {
    std::vector<glm::vec3> picture(24 * 16);
    from.draw(Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0), film, powers,
              std::numeric_limits<double>::infinity(), picture);
    return picture;
  };
  bounded->bound_light_maps(1);
  for (const double x : {0.5, 1.5, 0.5, 2.5}) CHECK(draw(*bounded, x) == draw(*free, x));
}

TEST_CASE("Glossy surfaces keep the estimate at the hit where photons bring gloss") {
  // Only the table is glossy: pixels that see nothing else are those of an estimate at each hit.
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(diffuse(0.5f)));
  builder.grid({-0.5f, -0.5f, 0.3f}, {1, 0, 0}, {0, 1, 0}, 1,
               builder.add(glossy(0.4f, 0.05f, 0.3f)));
  builder.add(point_light("lamp", {0.3f, 0.2f, 1}, 1.0));
  const Scene scene = builder.build();
  RenderParameters parameters = with_light_maps();
  parameters.gloss = GlossMode::photons;
  const Camera camera = above(0, 0, 10, 0.6);
  const RenderResult maps = render(scene, camera, device(), parameters);
  parameters.light_maps = LightMapMode::off;
  const RenderResult hits = render(scene, camera, device(), parameters);
  const auto& a = maps.layers.layers[0].radiance;
  const auto& b = hits.layers.layers[0].radiance;
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].x == Approx(b[i].x).epsilon(1e-5));  // sums of photons in another order
  }
}

// Sensors that read light maps, beside the estimate at each point and closed forms.

RenderParameters parameters_of(LightMapMode mode, int rays = 0) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 200'000;
  parameters.neighbours = 200;
  parameters.light_maps = mode;
  parameters.light_map_rays = rays;
  return parameters;
}

std::span<Device> one_device() { return {&device(), 1}; }

/// Nodes that a run has valued.
double nodes_of(const RenderResult& result) {
  for (const StageStatistics& stage : result.statistics) {
    if (stage.stage == "light maps") return stage.figures.front().second;
  }
  return 0;
}

/// Illuminance of all lights of a result, per sensor.
std::vector<double> lux_of(const RenderResult& result) {
  const LightLayers layers = result.layers.dense();
  std::vector<double> lux(layers.layers.front().illuminance.size(), 0.0);
  for (const LightLayers::Layer& layer : layers.layers) {
    for (std::size_t i = 0; i < lux.size(); ++i) lux[i] += double{layer.illuminance[i]};
  }
  return lux;
}

/// A grid of sensors on the plane z = 0, facing up.
std::vector<Sensor> grid_on_floor(double side, int count) {
  std::vector<Sensor> sensors;
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < count; ++x) {
      sensors.push_back(
          {{((x + 0.5) / count - 0.5) * side, ((y + 0.5) / count - 0.5) * side, 0.0}, {0, 0, 1}});
    }
  }
  return sensors;
}

/// Mean of the squares of relative errors.
double error_of(const std::vector<double>& values, const std::vector<double>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += std::pow(values[i] / truth[i] - 1, 2);
  return sum / static_cast<double>(values.size());
}

/// A closed room of 2 m on a yard of 8 m under an even sky. Its walls are sheets, or boxes, or
/// sheets that stand above the ceiling.
Scene room_in_a_yard(float thickness, float above) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.add(diffuse(0.7f));
  builder.grid({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 1, paint);
  builder.grid({-1, -1, 1.5f}, {2, 0, 0}, {0, 2, 0}, 1, paint);
  const float side = 1 + thickness, height = 1.5f + above;
  for (const float end : {-1.0f, 1.0f}) {
    if (thickness > 0) {
      const float low = std::min(end, end * side), high = std::max(end, end * side);
      builder.box({low, -side, 0}, {high, side, height}, paint, false);
      builder.box({-1, low, 0}, {1, high, height}, paint, false);
    } else {
      builder.grid({end, -1, 0}, {0, 2, 0}, {0, 0, height}, 1, paint);
      builder.grid({-1, end, 0}, {2, 0, 0}, {0, 0, height}, 1, paint);
    }
  }
  builder.add_surroundings("sky", EnvironmentMap("sky", 1, 1, {glm::vec3(1.0f)}));
  return builder.build();
}

/// Light in the cavity of a closed room's double shell: a panel that faces the ceiling from above,
/// or a lamp in the gap of double walls.
Scene room_in_a_shell(float gap, bool panel_above) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.add(diffuse(0.7f));
  builder.box({0, 0, 0}, {4, 4, 3}, paint, true);
  const std::uint32_t black = builder.add(diffuse(0.0f));
  if (panel_above) {
    builder.grid({1.7f, 1.7f, 3 + gap}, {0, 0.6f, 0}, {0.6f, 0, 0}, 1, black,
                 builder.add(area_light("panel")));
  } else {
    builder.box({-gap, -gap, -gap}, {4 + gap, 4 + gap, 3 + gap}, paint, true);
    builder.add(point_light("cavity", {2, 2, 3 + 0.5f * gap}));
  }
  return builder.build();
}

TEST_CASE("No light comes through the walls of a closed room") {
  const auto [thickness, above] =
      GENERATE(std::pair{0.0f, 0.0f}, std::pair{0.1f, 0.0f}, std::pair{0.0f, 0.4f});
  const auto [mode, rays] =
      GENERATE(std::pair{LightMapMode::automatic, 0}, std::pair{LightMapMode::on, 0},
               std::pair{LightMapMode::on, 64});
  CAPTURE(thickness, above, rays, name_of(mode));
  const Scene scene = room_in_a_yard(thickness, above);
  constexpr std::size_t within = 16, beside = 16;
  std::vector<Sensor> sensors = grid_on_floor(1.6, 4);
  for (Sensor& sensor : sensors) sensor.position.z = 0.7;
  for (std::size_t i = 0; i < beside; ++i) {
    const double along = -0.9 + 0.12 * static_cast<double>(i);
    sensors.push_back({{1.2 + thickness, along, 0}, {0, 0, 1}});
  }
  const std::vector<double> lux =
      lux_of(gather(scene, sensors, {.rays = 256}, one_device(), parameters_of(mode, rays)));
  double inside = 0, yard = 0;
  for (std::size_t i = 0; i < within; ++i) inside += lux[i] / within;
  for (std::size_t i = within; i < lux.size(); ++i) yard += lux[i] / beside;
  CAPTURE(inside, yard);
  CHECK(inside < 1e-4 * yard);
}

TEST_CASE("No light comes through a thin shell whose other side is lit") {
  const float gap = GENERATE(1e-5f, 1e-4f, 1e-3f, 1e-2f);
  const bool panel_above = GENERATE(true, false);
  const auto mode = GENERATE(LightMapMode::automatic, LightMapMode::on);
  CAPTURE(gap, panel_above, name_of(mode));
  const Scene scene = room_in_a_shell(gap, panel_above);
  const std::vector<Sensor> sensors{
      {{2, 2, 0.75}, {0, 0, 1}}, {{1, 1, 0.75}, {0, 0, 1}}, {{2, 2, 2.9}, {0, 0, 1}}};
  RenderParameters parameters = parameters_of(mode);
  parameters.photons.emitted_photons = GENERATE(20'000, 100'000);
  const std::vector<double> lux =
      lux_of(gather(scene, sensors, {.rays = 1024}, one_device(), parameters));
  // In the room the light would be some 0.1 lux.
  for (const double value : lux) CHECK(value < 1e-4);
}

TEST_CASE("A grid on a floor under a lamp reads its closed form between nodes") {
  Scene scene = plate(diffuse(0.5f), 4, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}));
  const std::vector<Sensor> sensors = grid_on_floor(2.4, 24);
  std::vector<double> truth;
  for (const Sensor& sensor : sensors) {
    const double squared = glm::dot(sensor.position, sensor.position) + 1;
    truth.push_back(1 / (4 * glm::pi<double>() * std::pow(squared, 1.5)));
  }
  const RenderResult at_points =
      measure(scene, sensors, one_device(), parameters_of(LightMapMode::automatic));
  const RenderResult by_photons =
      measure(scene, sensors, one_device(), parameters_of(LightMapMode::on));
  const RenderResult by_rays =
      measure(scene, sensors, one_device(), parameters_of(LightMapMode::on, 16));
  CHECK(nodes_of(at_points) == 0);
  CHECK(nodes_of(by_photons) > 0);
  CHECK(nodes_of(by_rays) > 0);
  const double error = error_of(lux_of(by_photons), truth);
  CAPTURE(error, error_of(lux_of(at_points), truth));
  CHECK(error < 2.0 / 200);  // noise of k photons, and some bias
  CHECK(error <= 1.02 * error_of(lux_of(at_points), truth));
  CHECK(error_of(lux_of(by_rays), truth) <
        1e-4);  // a look at a lamp is exact; nodes lie 8 cm apart
}

TEST_CASE("Sensors in the air of a furnace read the same light everywhere, by rays to light maps") {
  constexpr double albedo = 0.5;
  const Scene box = furnace(diffuse(albedo));
  const double truth = 1.0 / 6 / (1 - albedo);  // 1 lm over 6 m2, and each bounce returns half
  std::vector<Sensor> sensors;
  for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0)}) {
    sensors.push_back({{0.3, 0.6, 0.5}, normal});
    sensors.push_back({{0.9, 0.1, 0.2}, normal});
  }
  const RenderResult result =
      gather(box, sensors, {.rays = 1024}, one_device(), parameters_of(LightMapMode::on));
  CHECK(nodes_of(result) > 0);
  for (const double lux : lux_of(result)) CHECK(lux == Approx(truth).epsilon(0.02));
}

TEST_CASE("Sensors in a furnished room read what estimates at the ends of their rays give") {
  const Scene scene = furnished_room(2);
  std::vector<Sensor> sensors;
  for (int i = 0; i < 40; ++i)
    sensors.push_back({{0.3 + 0.08 * i, 0.4 + 0.05 * i, 1.2}, {0, 0, 1}});
  const auto mean_of = [&](LightMapMode mode, double& nodes) {
    const RenderResult result =
        gather(scene, sensors, {.rays = 256}, one_device(), parameters_of(mode));
    nodes = nodes_of(result);
    return lux_of(result);
  };
  double nodes = 0;
  const std::vector<double> at_ends = mean_of(LightMapMode::off, nodes);
  CHECK(nodes == 0);
  const std::vector<double> between_nodes = mean_of(LightMapMode::on, nodes);
  CHECK(nodes > 0);
  // Rays and photons are the same; what differs is the mean over 256 interpolations.
  CHECK(error_of(between_nodes, at_ends) < 0.01 * 0.01);
}

}  // namespace
}  // namespace photile::test
