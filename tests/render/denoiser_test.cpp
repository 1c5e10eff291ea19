// The optional last step of a picture, --denoise. What it is given and what is kept of its answer
// are tested with a denoiser of means, which is known in closed form.
#include <random>

#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "pictures.hpp"
#include "skipped.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Matchers::Contains;

constexpr int spot_side = 3;

/// One layer, black but for the pixel in the middle.
LightLayers spot(float radiance) {
  LightLayers layers(spot_side, spot_side, std::vector<std::string>{"lamp"});
  layers.layers[0].radiance[4] = glm::vec3(radiance);
  layers.layers[0].illuminance[4] = radiance;
  return layers;
}

DenoisingGuides same_surface() {
  return {std::vector<glm::vec3>(spot_side * spot_side, glm::vec3(0.5f)),
          std::vector<glm::vec3>(spot_side * spot_side, glm::vec3(0, 0, 1))};
}

Denoiser means() { return Denoiser(PHOTILE_MEAN_DENOISER); }

}  // namespace

TEST_CASE("a library that is not there, or is another, is named") {
  CHECK_THROWS_WITH(Denoiser("/nowhere/libOpenImageDenoise.so.2"),
                    Contains("--denoise") && Contains("/nowhere/libOpenImageDenoise.so.2"));
  CHECK_THROWS_WITH(Denoiser("libm.so.6"), Contains("libm.so.6 has no oidnNewDevice"));
}

TEST_CASE("a library that is not there is brought by one command") {
  CHECK_THROWS_WITH(Denoiser("libOpenImageDenoise.so.none"), Contains("cmake/fetch.sh denoiser"));
}

TEST_CASE("Open Image Denoise takes the noise of even light, and keeps its mean") {
  if (!std::filesystem::exists(source_folder() / "build/denoiser/complete")) {
    skip("no Open Image Denoise; cmake/fetch.sh denoiser brings it");
    return;
  }
  constexpr int width = 64;
  constexpr double mean = 5;
  LightLayers layers(width, width, std::vector<std::string>{"lamp"});
  std::mt19937_64 random(1);
  std::exponential_distribution<float> radiance(1 / static_cast<float>(mean));
  for (glm::vec3& pixel : layers.layers[0].radiance) pixel = glm::vec3(radiance(random));
  const DenoisingGuides guides{std::vector<glm::vec3>(width * width, glm::vec3(0.5f)),
                               std::vector<glm::vec3>(width * width, glm::vec3(0, 0, 1))};
  const auto denoised = Denoiser(defaults::denoising_library).denoised(layers, guides, nullptr);
  double sum = 0, squares = 0;
  for (const glm::vec3& pixel : denoised.layers[0].radiance) {
    sum += pixel.y / double{width * width};
    squares += std::pow(pixel.y - mean, 2) / double{width * width};
  }
  // The mean of 4,096 values scatters by 1.6%, and each of them by 100%.
  CHECK(sum == Approx(mean).epsilon(0.08));
  CHECK(std::sqrt(squares) < 0.2 * mean);
}

TEST_CASE("radiance is denoised in proportion, illuminance stays") {
  for (const float radiance : {1.0f, 4.0f}) {
    const LightLayers layers = spot(radiance);
    const LightLayers::Layer denoised = means().denoised(layers, same_surface(), nullptr).layers[0];
    CHECK(denoised.radiance[0].x == Approx(radiance / 4));  // a corner sees four pixels
    CHECK(denoised.radiance[1].x == Approx(radiance / 6));
    CHECK(denoised.radiance[4].x == Approx(radiance / 9));
    CHECK(denoised.illuminance == layers.layers[0].illuminance);
  }
}

TEST_CASE("each of many layers is denoised on its own") {
  std::vector<std::string> names;
  for (std::size_t i = 0; i <= max_dense_lights; ++i) names.push_back("lamp " + std::to_string(i));
  LightLayers layers(spot_side, spot_side, names);
  REQUIRE(layers.sparse());
  layers.rows[1] = {
      .first = {0, 0, 1, 1}, .light = {7}, .radiance = {glm::vec3(9)}, .illuminance = {2}};
  const LightLayers denoised = means().denoised(layers, same_surface(), nullptr);
  for (std::size_t light = 0; light < names.size(); ++light) {
    CHECK(denoised.layers[light].radiance[4].x == Approx(light == 7 ? 1.0 : 0.0));
    CHECK(denoised.layers[light].illuminance[4] == (light == 7 ? 2.0f : 0.0f));
  }
}

TEST_CASE("guides keep surfaces apart") {
  DenoisingGuides guides = same_surface();
  guides.normal[4] = {1, 0, 0};
  const LightLayers denoised = means().denoised(spot(9), guides, nullptr);
  CHECK(denoised.layers[0].radiance[4].x == 9);
  CHECK(denoised.layers[0].radiance[0].x == 0);
}

TEST_CASE("guides are denoised before they lead") {
  DenoisingGuides guides = same_surface();
  for (std::size_t i = 0; i < guides.albedo.size(); ++i) {
    guides.albedo[i] += 0.01f * static_cast<float>(i);
    guides.normal[i].x += 0.01f * static_cast<float>(i);
  }
  const LightLayers denoised = means().denoised(spot(9), guides, nullptr);
  CHECK(denoised.layers[0].radiance[4].x == Approx(1));
}

TEST_CASE("values move by no more than their known errors allow") {
  LightLayers errors(spot_side, spot_side, std::vector<std::string>{"lamp"});
  errors.layers[0].radiance[0] = glm::vec3(0.1f);
  const LightLayers denoised = means().denoised(spot(9), same_surface(), &errors);
  CHECK(denoised.layers[0].radiance[4].x == 9);  // is exact
  CHECK(denoised.layers[0].radiance[0].x == Approx(0.1f * defaults::denoising_errors));
}

TEST_CASE("guides are what is seen, over mirrors in their tint") {
  const glm::vec3 albedo(0.2f, 0.5f, 0.8f), tint(0.9f, 0.5f, 0.1f);
  SceneBuilder builder("a plate that a mirror shows");
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  const std::uint32_t plate = builder.add(diffuse(albedo)), slope = builder.add(mirror(tint));
  // Seen from above: a plate to the left, a mirror to the right that shows a wall, a lamp between.
  builder.grid({-3, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, plate);
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, plate, lamp);
  builder.grid({1, -1, 0}, {2, 0, 2}, {0, 2, 0}, 1, slope);
  builder.grid({-9, -50, -50}, {0, 100, 0}, {0, 0, 100}, 1, plate);
  const Scene scene = builder.build();
  const Camera camera = Camera::look_at({0, 0, 100}, {0, 0, 0}, {0, 1, 0}, 2 * std::atan(0.03));
  const DenoisingGuides guides = denoising_guides(
      RayScene(scene), camera, {.width = 3, .height = 3, .samples_per_pixel = 4}, 1);
  constexpr std::size_t left = 3, middle = 4, right = 5;
  for (int c = 0; c < 3; ++c) {
    CHECK(guides.albedo[left][c] == Approx(albedo[c]).epsilon(1e-3));
    CHECK(guides.albedo[middle][c] == 1.0f);
    CHECK(guides.albedo[right][c] == Approx(albedo[c] * tint[c]).epsilon(1e-3));
  }
  CHECK(guides.normal[left].z == Approx(1.0).epsilon(1e-3));
  CHECK(guides.normal[right].x > 0.3f);  // the wall's
}

}  // namespace photile::test
