// Every material by photon maps and by paths: the same picture.
#include <catch2/catch.hpp>

#include "../render/pictures.hpp"
#include "photile/renderer.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// Mean radiance of a layer over the picture, green.
double mean_radiance(const LightLayers& layers) {
  double sum = 0;
  for (const glm::vec3& radiance : layers.layers[0].radiance) sum += double{radiance.g};
  return sum / static_cast<double>(layers.layers[0].radiance.size());
}

/// One texel over every triangle, whose coordinates run along two of its edges.
void cover(Scene& scene, std::array<std::uint8_t, 4> texel) {
  scene.textures.emplace_back("texel", 1, 1, std::vector<std::array<std::uint8_t, 4>>{texel});
  scene.corner_uv.assign(scene.triangle_count(),
                         {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)});
}

/// A room with a lamp at z = 0.7, its walls of the first material.
Scene room(const Material& walls) { return test::closed_box(walls, 2); }

/// The room with a plate of the material between lamp and floor.
Scene room_with_plate(const Material& plate) {
  test::SceneBuilder builder("room with a plate");
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(test::diffuse(glm::vec3(0.6f))), true,
              2);
  builder.grid({0, 0, 0.3f}, {1, 0, 0}, {0, 1, 0}, 2, builder.add(plate));
  builder.add(test::point_light("lamp", {0.4f, 0.5f, 0.7f}));
  return builder.build();
}

double mean_illuminance(const LightLayers& layers) {
  return test::LayerMeans(layers.layers[0]).illuminance;
}

RenderParameters effort(std::uint64_t photons, int samples) {
  RenderParameters parameters = test::small_picture(photons, 16, 16, samples);
  parameters.radius = 0.1;
  return parameters;
}

/// Looks down at the floor, away from its edges by more than the estimates reach; paths and photons
/// see as much light, but for a share of it.
void check_agreement(const Scene& scene, RenderParameters parameters = effort(200'000, 36),
                     double share = 0.04, double (&mean_of)(const LightLayers&) = mean_radiance) {
  const Camera camera =
      Camera::look_at({0.5, 0.5, 0.9}, {0.5, 0.5, 0}, {0, 1, 0}, 2 * std::atan(0.3 / 0.9));
  std::vector<double> differences;
  double mean = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    parameters.seed = seed;
    const double photons = mean_of(render(scene, camera, test::device(), parameters).layers);
    const double paths = mean_of(trace_paths(scene, camera, eye_rays(parameters)).layers);
    differences.push_back(photons - paths);
    mean += paths / 16;
  }
  CHECK_VERDICT(test::mean_is(differences, 0.0, share * mean));
}

}  // namespace

TEST_CASE("paths and photon maps see the same light in a closed box, away from its edges") {
  RenderParameters parameters = effort(500'000, 64);
  parameters.neighbours = 200;  // the nodes of so small a floor are few
  check_agreement(room(test::diffuse(glm::vec3(0.6f))), parameters, 0.015, mean_illuminance);
}

TEST_CASE("paths and photon maps agree on a coated wall") {
  check_agreement(room(test::glossy(glm::vec3(0.5f), glm::vec3(0.04f), 0.4f)));
}

TEST_CASE("paths and photon maps agree on a rough metal", "[slow]") {
  check_agreement(room(test::glossy(glm::vec3(0.0f), glm::vec3(0.7f), 0.6f)));
}

TEST_CASE("paths and photon maps agree under a normal map", "[slow]") {
  const auto [albedo, specular] =
      GENERATE(std::pair(0.6f, 0.0f), std::pair(0.5f, 0.04f), std::pair(0.0f, 0.7f));
  const Material walls = test::glossy(glm::vec3(albedo), glm::vec3(specular), 0.5f);
  Scene scene = room(walls);
  cover(scene, {145, 112, 253, 255});
  scene.materials[0].normal_texture = 0;
  CAPTURE(albedo, specular);
  check_agreement(scene);
}

TEST_CASE("paths and photon maps agree through holes", "[slow]") {
  Material plate = test::diffuse(glm::vec3(0.4f));
  plate.opacity = GENERATE(0.0f, 0.4f);
  CAPTURE(plate.opacity);
  check_agreement(room_with_plate(plate));
}

}  // namespace photile::test
