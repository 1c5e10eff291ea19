// Whole pictures against closed forms: photons traced, grouped, mapped and estimated.
#include <array>

#include "lamp_below_ceiling.hpp"
#include "light/light_at_points.hpp"
#include "photile/load_scene.hpp"
#include "pictures.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

/// The inside of a sphere of radius 1 whose wall reflects and emits.
Scene furnace(float albedo, double emitted_radiance, int rings) {
  SceneBuilder builder("furnace");
  const std::uint32_t wall = builder.add(diffuse(albedo));
  const std::uint32_t lamp = builder.add(area_light("wall"));
  const auto at = [&](int i, int j) {
    const float theta = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
    const float phi = glm::pi<float>() * static_cast<float>(j) / static_cast<float>(rings);
    return glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                     std::cos(theta));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      // Fronts look inwards; the caps are triangles.
      if (i > 0) builder.triangle(at(i, j), at(i, j + 1), at(i + 1, j), wall, lamp);
      if (i + 1 < rings) builder.triangle(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j), wall, lamp);
    }
  }
  Scene scene = builder.build();
  double area = 0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) area += triangle_area(scene, t);
  scene.lights[0].power = emitted_radiance * glm::pi<double>() * area;
  return scene;
}

TEST_CASE("a point light over a floor: mean illuminance and radiance over a square") {
  // Flux of an isotropic lamp of 1 cd, one metre above the middle of a square of 2 x 2 m: its solid
  // angle, 4 asin(1 / 2) lm. The camera sees just that square of a larger floor.
  constexpr float albedo = 0.6f;
  Scene scene = plate(diffuse(albedo), 4.0f, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}, 4.0 * glm::pi<double>()));
  const Camera camera =
      Camera::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(1.0 / 3.0));
  const double illuminance = 4.0 * std::asin(0.5) / 4.0;

  std::vector<double> read_illuminance, read_radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = small_picture(200'000, 48, 48, 4);
    parameters.seed = seed;
    const RenderResult result = render(scene, camera, device(), parameters);
    const LayerMeans mean(result.layers.layers[0]);
    read_illuminance.push_back(scene.lights[0].power * mean.illuminance);
    read_radiance.push_back(scene.lights[0].power * mean.radiance);
  }
  CHECK_VERDICT(mean_is(read_illuminance, illuminance, 0.015 * illuminance));
  const double radiance = illuminance * albedo / glm::pi<double>();
  CHECK_VERDICT(mean_is(read_radiance, radiance, 0.015 * radiance));
}

TEST_CASE("a furnace: inside a sphere that emits L and reflects rho the radiance is L / (1 - rho)",
          "[slow]") {
  // Direct emission is seen as L; what the photon map adds is L rho / (1 - rho). On a sphere the
  // surface within the disc is larger than the disc by (r / 2)^2, under 0.2% here.
  for (const float albedo : {0.5f, 0.8f}) {
    const Scene scene = furnace(albedo, 1.0 - albedo, 14);
    const Camera camera = Camera::look_at({0, 0, 0}, {1, 0.3, 0.2}, {0, 0, 1}, 1.2);
    const std::vector<double> radiances = of_seeds([&](std::uint64_t seed) {
      RenderParameters parameters = small_picture(150'000, 40, 40, 4);
      parameters.seed = seed;
      const RenderResult result = render(scene, camera, device(), parameters);
      return scene.lights[0].power * LayerMeans(result.layers.layers[0]).radiance;
    });
    CHECK_VERDICT(mean_is(radiances, 1.0, 0.015));
  }
}

// A lamp close to surface, against quadrature of closed forms.

TEST_CASE("hot spots: pictures show the light that a lamp below the ceiling has the floor get") {
  const float below = GENERATE(0.001f, 0.01f);
  SceneBuilder builder = ceiling_and_floor();
  const Light lamp = point_light("lamp", {0.1f, 0.2f, ceiling_height - below});
  builder.add(lamp);
  const Scene scene = builder.build();
  RenderParameters parameters = small_picture(20'000, 16, 16);
  parameters.light_map_rays = 64;
  CAPTURE(below);
  const auto mean = [&](const Camera& camera) {
    const LightLayers layers =
        render(scene, camera, std::span(&device(), 1), parameters).layers.dense();
    return LayerMeans(layers.layers[0]).illuminance;
  };
  const double truth = lux_below_ceiling(scene, lamp, {0.5, -0.5, 0});
  CHECK(mean(above(0.5, -0.5, 1, 0.1)) == Approx(truth).epsilon(0.02));
  // The spot itself: the flux that meets a square of a metre of the ceiling.
  double lumens = 0;
  for_each_lit(scene, lamp, [&](const glm::dvec3& lit, double part) {
    if (std::max(std::abs(lit.x - 0.1), std::abs(lit.y - 0.2)) < 0.5) lumens += part;
  });
  parameters.film.width = parameters.film.height = 256;
  const Camera upwards = Camera::look_at({0.1, 0.2, 0.5}, {0.1, 0.2, 3}, {0, 1, 0},
                                         2 * std::atan(0.5 / (ceiling_height - 0.5)));
  CHECK(mean(upwards) == Approx(lumens).epsilon(0.05));
}

// The mean of a room full of small things, between which photon estimates blur.

/// Mean luminance of all lights at their powers.
double mean_of(const LightLayers& picture, const Scene& scene) {
  const std::vector<double> powers = light::layer_powers(scene);
  const LightLayers dense = picture.dense();
  double sum = 0;
  for (std::size_t layer = 0; layer < powers.size(); ++layer) {
    for (const glm::vec3& pixel : dense.layers[layer].radiance) {
      sum += powers[layer] * luminance(glm::dvec3(pixel));
    }
  }
  return sum;
}

TEST_CASE("crowded rooms: by default the living room is as bright as paths find it", "[slow]") {
  const Scene scene = load_scene(source_folder() / "scenes/living-room/living-room.gltf");
  const Camera& camera = scene.cameras.front();
  RenderParameters parameters;
  set_quality(parameters, Quality::good);
  parameters.film.width = 96;
  parameters.film.height = 64;
  PrimaryHitParameters paths = eye_rays(parameters);
  paths.samples_per_pixel = 2048;
  const double truth = mean_of(trace_paths(scene, camera, paths).layers, scene);
  double mean = 0;
  constexpr std::array<std::uint64_t, 3> seeds{1, 2, 3};
  for (const std::uint64_t seed : seeds) {
    parameters.seed = seed;
    mean += mean_of(render(scene, camera, device(), parameters).layers, scene) / seeds.size();
  }
  CAPTURE(mean / truth);
  CHECK(mean == Approx(truth).epsilon(0.005));
}

}  // namespace
}  // namespace photile::test
