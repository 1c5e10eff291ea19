// Figures 1 and 2 of the paper: without neighbour groups, edges between triangles are dark.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "photile/renderer.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// Mean illuminance of the pixels on the diagonal of a square plate lit by a far lamp, over that of
/// the whole picture's middle.
double diagonal_over_middle(MapMode mode) {
  // Two triangles that meet along the diagonal.
  Scene scene = test::plate(test::diffuse(glm::vec3(0.5f)), 2.0f, 1);
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::directional;
  sun.direction = {0, 0, -1};
  sun.power = 1;
  scene.lights.push_back(sun);
  // The camera sees the inner 1 x 1 m.
  const Camera camera =
      Camera::look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(0.5 / 2.0));
  RenderParameters parameters;
  parameters.photons.emitted_photons = 400'000;
  parameters.maps = mode;
  constexpr int side = 100;
  parameters.film.width = parameters.film.height = side;
  const auto layers = render(scene, camera, test::device(), parameters).layers;
  const std::vector<float>& illuminance = layers.layers[0].illuminance;
  double diagonal = 0, middle = 0;
  int middle_count = 0;
  for (int y = 0; y < side; ++y) {
    // The plate's diagonal runs from (-1, -1) to (1, 1): upwards to the right.
    diagonal += illuminance[static_cast<std::size_t>(y * side + (side - 1 - y))] / side;
    for (int x = 0; x < side; ++x) {
      if (std::abs(x + y - (side - 1)) < 30) continue;
      middle += illuminance[static_cast<std::size_t>(y * side + x)];
      ++middle_count;
    }
  }
  return diagonal * middle_count / middle;
}

}  // namespace

TEST_CASE("naive maps darken the edge between two triangles to about half") {
  // On the edge half of the disc has no photons. Pixels reach half a pixel off the diagonal, a
  // quarter of the radius here, so they read a little more than the 0.51 of the edge itself.
  const double ratio = diagonal_over_middle(MapMode::naive);
  CHECK(ratio > 0.45);
  CHECK(ratio < 0.75);
}

TEST_CASE("maps of neighbour groups and patches show no edge between two triangles") {
  const MapMode mode = GENERATE(MapMode::triangle, MapMode::patch, MapMode::automatic);
  // 100 pixels on the diagonal hold about 100 x 0.01 m / 0.04 m = 25 independent estimates of 14%:
  // a deviation of 3%.
  CHECK(diagonal_over_middle(mode) == Approx(1.0).margin(0.1));
}

}  // namespace photile::test
