// Pictures of rooms with a lamp close to surface, against quadrature of closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "lamp_below_ceiling.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "test_device.hpp"

namespace photile::test {

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

}  // namespace photile::test
