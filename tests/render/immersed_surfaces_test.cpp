// Surfaces in water and in glass, seen from outside and measured inside: radiance over the squared
// index of refraction is what a boundary keeps, irradiance is flux per area in any medium.
#include <numbers>

#include "photile/sensors.hpp"
#include "pictures.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

constexpr double water = 1.33;
constexpr int picture_side = 8;

/// Reflectance of water for unpolarised light from the air, at an angle above 0.
double fresnel(double angle) {
  const double inside = std::asin(std::sin(angle) / water);
  const double s = std::sin(angle - inside) / std::sin(angle + inside);
  const double p = std::tan(angle - inside) / std::tan(angle + inside);
  return 0.5 * (s * s + p * p);
}

/// An endless pool with a diffuse floor under a sky of even radiance 1: light goes to and
/// fro between floor and surface, which reflects 1 - (1 - R) / n^2 of what is diffuse below it
/// where it reflects R of what is diffuse above.
struct PoolTruth {
  double albedo;
  double irradiance;  ///< of the floor

  explicit PoolTruth(double floor_albedo) : albedo(floor_albedo) {
    constexpr int steps = 20'000;
    double passes = 0;
    for (int i = 0; i < steps; ++i) {
      const double angle = 0.5 * pi * (i + 0.5) / steps;
      passes += (1 - fresnel(angle)) * std::sin(2 * angle) * 0.5 * pi / steps;
    }
    irradiance = pi * passes / (1 - albedo * (1 - passes / (water * water)));
  }
  /// That leaves towards an eye above the water.
  double radiance(double angle) const {
    const double reflected = fresnel(angle);
    return reflected + (1 - reflected) * albedo / pi * irradiance / (water * water);
  }
};

/// That pool, a metre deep; mirrors at its sides make its 4 x 4 m endless. At the power 1 of its
/// layer the sky has the radiance `unit`.
struct Pool {
  Scene scene;
  double unit;

  explicit Pool(double albedo) {
    SceneBuilder builder("pool");
    const auto floor = builder.add(diffuse(glm::vec3(static_cast<float>(albedo))));
    const auto side = builder.add(mirror(1.0f));
    const auto surface = builder.add(glass(static_cast<float>(water)));
    const glm::vec3 low(-2, -2, -1), x(4, 0, 0), y(0, 4, 0), z(0, 0, 1);
    builder.grid(low, x, y, 1, floor);
    builder.grid(low + z, x, y, 1, surface);
    builder.grid(low, z, x, 1, side);
    builder.grid(low + y, x, z, 1, side);
    builder.grid(low, y, z, 1, side);
    builder.grid(low + x, z, y, 1, side);
    scene = builder.build();
    // The middle of a map lies towards -z: a hemisphere around z is its left and right quarter.
    const glm::vec3 on(1.0f), off(0.0f);
    const EnvironmentMap map("even", 4, 1, {on, off, off, on});
    add_environment(scene, map);
    unit = 1 / scene.lights.back().power;
  }
};

/// Looks at three metres of the water from so far that one angle serves.
Camera towards_water(double angle) {
  constexpr double distance = 50;
  return Camera::look_at({distance * std::sin(angle), 0, distance * std::cos(angle)}, {0, 0, 0},
                         {0, 1, 0}, 2 * std::atan(1.5 * std::cos(angle) / distance));
}

RenderParameters parameters_of(std::uint64_t photons, int samples, std::uint64_t seed) {
  RenderParameters parameters = small_picture(photons, picture_side, picture_side, samples);
  parameters.neighbours = 200;
  parameters.seed = seed;
  return parameters;
}

/// Whether the radiance that 16 seeds see of a pool at two angles is that of the closed form, and
/// the illuminance, which only those rays see that enter the water.
///   pictures   of a scene, given a list of cameras and a seed
template <class Pictures>
void check_pool(double albedo, double delta, const Pictures& pictures) {
  const std::vector<double> angles{0.3, 1.2};
  const std::vector<Camera> cameras{towards_water(angles[0]), towards_water(angles[1])};
  const Pool pool(albedo);
  const PoolTruth truth(albedo);
  std::vector<std::vector<double>> radiance(angles.size()), illuminance(angles.size());
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const std::vector<LightLayers> layers = pictures(pool.scene, cameras, seed);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const LayerMeans mean(layers[i].layers[0]);
      radiance[i].push_back(mean.radiance / pool.unit / truth.radiance(angles[i]));
      illuminance[i].push_back(mean.illuminance / pool.unit /
                               ((1 - fresnel(angles[i])) * truth.irradiance));
    }
  }
  for (std::size_t i = 0; i < angles.size(); ++i) {
    CAPTURE(albedo, angles[i]);
    CHECK_VERDICT(mean_is(radiance[i], 1, delta));
    CHECK_VERDICT(mean_is(illuminance[i], 1, delta));
  }
}

std::vector<LightLayers> by_maps(const Scene& scene, const std::vector<Camera>& cameras,
                                 const RenderParameters& parameters) {
  SceneRenderer renderer(scene, std::span(&device(), 1), parameters);
  std::vector<LightLayers> layers;
  for (const Camera& camera : cameras)
    layers.push_back(renderer.render(camera, parameters.film).layers);
  return layers;
}

double illuminance_of(const LightLayers& layers, std::size_t sensor) {
  return static_cast<double>(layers.dense().layers.at(0).illuminance.at(sensor));
}

/// A grey box cast in a block of glass that lies on a floor, under a luminous ceiling.
Scene box_in_glass() {
  SceneBuilder builder("box in glass");
  const auto floor = builder.add(diffuse(0.6f));
  const auto box = builder.add(diffuse(0.4f));
  const auto block = builder.add(glass(1.5f));
  const auto ceiling = builder.add(area_light("ceiling"));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, floor);
  builder.grid({-1, -1, 1.6f}, {0, 2, 0}, {2, 0, 0}, 1, floor, ceiling);
  builder.box({-0.6f, -0.6f, 0.01f}, {0.6f, 0.6f, 0.8f}, block, false);
  builder.box({-0.4f, -0.4f, 0.2f}, {0.4f, 0.4f, 0.6f}, box, false);
  return builder.build();
}

}  // namespace

TEST_CASE("a pool shows the radiance of its closed form, by photon maps") {
  const double albedo = GENERATE(0.5, 1.0);
  check_pool(albedo, 0.05, [](const Scene& scene, const auto& cameras, std::uint64_t seed) {
    return by_maps(scene, cameras, parameters_of(80'000, 144, seed));
  });
}

TEST_CASE("a pool shows the radiance of its closed form, by paths") {
  const double albedo = GENERATE(0.5, 1.0);
  check_pool(albedo, 0.05, [](const Scene& scene, const auto& cameras, std::uint64_t seed) {
    std::vector<LightLayers> layers;
    for (const Camera& camera : cameras)
      layers.push_back(trace_paths(scene, camera, eye_rays(parameters_of(1, 256, seed))).layers);
    return layers;
  });
}

TEST_CASE("a white pool is a furnace: nobody sees it") {
  CHECK(PoolTruth(1).irradiance == Approx(pi * water * water));
  for (const double angle : {0.1, 0.7, 1.5}) CHECK(PoolTruth(1).radiance(angle) == Approx(1));
}

TEST_CASE("a pool by rays to lamps is the same pool", "[slow]") {
  check_pool(0.5, 0.05, [&](const Scene& scene, const auto& cameras, std::uint64_t seed) {
    RenderParameters parameters = parameters_of(80'000, 144, seed);
    parameters.direct_rays = 1;
    return by_maps(scene, cameras, parameters);
  });
}

TEST_CASE("whatever is seen in a pool is seen by refraction or reflection") {
  const Pool pool(0.5);
  RenderParameters parameters = parameters_of(20'000, 16, 1);
  parameters.light_maps = GENERATE(LightMapMode::off, LightMapMode::on);
  SceneRenderer renderer(pool.scene, std::span(&device(), 1), parameters);
  const Camera camera = towards_water(0.3);
  CHECK(same_bits(renderer.render(camera, parameters.film).layers,
                  renderer.render_reflections(camera, parameters.film).layers));
}

TEST_CASE("sensors under water read what the floor gets, and what it sends up") {
  constexpr double albedo = 0.5;
  const Pool pool(albedo);
  const double truth = PoolTruth(albedo).irradiance;
  const std::vector<Sensor> sensors{{{0.1, 0.2, -0.5}, {0, 0, 1}}, {{0.1, 0.2, -0.5}, {0, 0, -1}}};
  std::vector<double> maps_down, maps_up, paths_down, paths_up;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const GatherParameters gathering{.rays = 4096};
    const LightLayers maps = gather(pool.scene, sensors, gathering, std::span(&device(), 1),
                                    parameters_of(60'000, 1, seed))
                                 .layers;
    const LightLayers paths = gather_by_paths(pool.scene, sensors, gathering, seed).layers;
    maps_down.push_back(illuminance_of(maps, 0) / pool.unit / truth);
    maps_up.push_back(illuminance_of(maps, 1) / pool.unit / (albedo * truth));
    paths_down.push_back(illuminance_of(paths, 0) / pool.unit / truth);
    paths_up.push_back(illuminance_of(paths, 1) / pool.unit / (albedo * truth));
  }
  for (const auto& values : {maps_down, maps_up, paths_down, paths_up}) {
    CHECK_VERDICT(mean_is(values, 1, 0.06));
  }
}

TEST_CASE("a box cast in glass looks the same by photon maps and by paths") {
  const Scene scene = box_in_glass();
  // Aslant: the glass reflects nothing but the dark. What is seen of the box lies far from its
  // edges.
  const Camera camera = Camera::look_at({-17.4, 0, 10.8}, {-0.07, 0, 0.8}, {0, 0, 1}, 0.01);
  constexpr int side = 2;
  std::vector<std::vector<double>> radiance(side * side), illuminance(side * side);
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = parameters_of(300'000, 400, seed);
    parameters.film.width = parameters.film.height = side;
    const auto maps = render(scene, camera, device(), parameters).layers.layers[0];
    parameters.film.samples_per_pixel = 4'000;
    const auto paths = trace_paths(scene, camera, eye_rays(parameters)).layers.layers[0];
    for (std::size_t pixel = 0; pixel < radiance.size(); ++pixel) {
      radiance[pixel].push_back(luminance(maps.radiance[pixel]) / luminance(paths.radiance[pixel]));
      illuminance[pixel].push_back(static_cast<double>(maps.illuminance[pixel]) /
                                   static_cast<double>(paths.illuminance[pixel]));
    }
  }
  for (std::size_t pixel = 0; pixel < radiance.size(); ++pixel) {
    CHECK_VERDICT(mean_is(radiance[pixel], 1, 0.15));
    CHECK_VERDICT(mean_is(illuminance[pixel], 1, 0.15));
  }
}

}  // namespace photile::test
