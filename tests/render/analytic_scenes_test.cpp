// Whole pictures against closed forms: photons traced, grouped, mapped and estimated.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// The inside of a sphere of radius 1 whose wall reflects and emits.
Scene furnace(float albedo, double emitted_radiance, int rings) {
  test::SceneBuilder builder("furnace");
  const std::uint32_t wall = builder.add(test::diffuse(glm::vec3(albedo)));
  const std::uint32_t lamp = builder.add(test::area_light("wall"));
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

}  // namespace

TEST_CASE("a point light over a floor: mean illuminance and radiance over a square") {
  // Flux of an isotropic lamp of 1 cd, one metre above the middle of a square of 2 x 2 m: its solid
  // angle, 4 asin(1 / 2) lm. The camera sees just that square of a larger floor.
  constexpr float albedo = 0.6f;
  Scene scene = test::plate(test::diffuse(glm::vec3(albedo)), 4.0f, 3);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1}, 4.0 * glm::pi<double>()));
  const Camera camera =
      Camera::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(1.0 / 3.0));
  const double illuminance = 4.0 * std::asin(0.5) / 4.0;

  std::vector<double> read_illuminance, read_radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = test::small_picture(200'000, 48, 48, 4);
    parameters.seed = seed;
    const RenderResult result = render(scene, camera, test::device(), parameters);
    const test::LayerMeans mean(result.layers.layers[0]);
    read_illuminance.push_back(scene.lights[0].power * mean.illuminance);
    read_radiance.push_back(scene.lights[0].power * mean.radiance);
  }
  CHECK_VERDICT(test::mean_is(read_illuminance, illuminance, 0.015 * illuminance));
  const double radiance = illuminance * albedo / glm::pi<double>();
  CHECK_VERDICT(test::mean_is(read_radiance, radiance, 0.015 * radiance));
}

TEST_CASE("a furnace: inside a sphere that emits L and reflects rho the radiance is L / (1 - rho)",
          "[slow]") {
  // Direct emission is seen as L; what the photon map adds is L rho / (1 - rho). On a sphere the
  // surface within the disc is larger than the disc by (r / 2)^2, under 0.2% here.
  for (const float albedo : {0.5f, 0.8f}) {
    const Scene scene = furnace(albedo, 1.0 - albedo, 14);
    const Camera camera = Camera::look_at({0, 0, 0}, {1, 0.3, 0.2}, {0, 0, 1}, 1.2);
    std::vector<double> radiances;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      RenderParameters parameters = test::small_picture(150'000, 40, 40, 4);
      parameters.seed = seed;
      const RenderResult result = render(scene, camera, test::device(), parameters);
      radiances.push_back(scene.lights[0].power *
                          test::LayerMeans(result.layers.layers[0]).radiance);
    }
    CHECK_VERDICT(test::mean_is(radiances, 1.0, 0.015));
  }
}

}  // namespace photile::test
