// The path tracer beside the photon maps, which share no estimate with it, and beside references of
// another renderer.
#include <catch2/catch.hpp>
#include <filesystem>

#include "../render/pictures.hpp"
#include "photile/image.hpp"
#include "photile/renderer.hpp"
#include "shared_scenes.hpp"
#include "skipped.hpp"
#include "source_folder.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// Mean over a square of pixels of a layer's illuminance.
double tile_mean(const LightLayers& layers, std::size_t light, int left, int top, int side) {
  double sum = 0;
  for (int y = top; y < top + side; ++y) {
    for (int x = left; x < left + side; ++x) {
      sum += layers.layers[light].illuminance[static_cast<std::size_t>(y * layers.width + x)];
    }
  }
  return sum / (side * side);
}

}  // namespace

TEST_CASE("paths and photon maps see the same light in the living room, light by light", "[slow]") {
  const Scene scene = load_scene(test::source_folder() / "scenes/living-room/living-room.gltf");
  const std::size_t lights = scene.lights.size();
  std::vector<std::vector<double>> differences(lights);
  std::vector<double> by_paths(lights);  // means
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters;
    parameters.film.width = 48;
    parameters.film.height = 36;
    parameters.film.samples_per_pixel = 128;
    parameters.seed = seed;
    parameters.photons.quota = PhotonQuota::equal;
    const auto from_photons = [&](std::uint64_t emitted) {
      parameters.photons.emitted_photons = emitted;
      return render(scene, scene.cameras[0], test::device(), parameters).layers;
    };
    const LightLayers few = from_photons(400'000), many = from_photons(3'200'000);
    PrimaryHitParameters film = eye_rays(parameters);
    film.samples_per_pixel = 4096;  // few paths find the lamp within its shade
    const LightLayers paths = trace_paths(scene, scene.cameras[0], film).layers;
    for (std::size_t light = 0; light < lights; ++light) {
      // Photons are blurred across the ends of surfaces in proportion to the radius of k of them,
      // the root of 8 smaller with 8 times as many: a line through both meets no blur at zero.
      const double with_few = tile_mean(few, light, 0, 0, 36),
                   with_many = tile_mean(many, light, 0, 0, 36);
      const double by_photons = with_many + (with_many - with_few) / (std::sqrt(8.0) - 1);
      const double traced = tile_mean(paths, light, 0, 0, 36);
      differences[light].push_back(by_photons - traced);
      by_paths[light] += traced / 16;
    }
  }
  for (std::size_t light = 0; light < lights; ++light) {
    INFO(scene.lights[light].name);
    CHECK_VERDICT(test::mean_is(differences[light], 0.0, 0.1 * by_paths[light]));
  }
}

TEST_CASE("paths agree with the references of another renderer", "[slow]") {
  const std::string name = GENERATE("kitchen", "classroom");
  const std::filesystem::path shared = test::shared_scenes_folder();
  const auto file = shared / name / (name + "-diffuse.gltf");
  if (!std::filesystem::exists(file)) {
    test::skip("no " + file.string());
    return;
  }
  const Image reference = read_image(shared / "references" / (name + "-diffuse-256x192.exr"));
  const Scene scene = load_scene(file);
  const std::vector<float>&r = *reference.find("R"), &g = *reference.find("G"),
        &b = *reference.find("B");
  // Pixels that see lamps are left out: above 20 times the median.
  std::vector<double> bright;
  for (std::size_t i = 0; i < r.size(); ++i) bright.push_back(luminance({r[i], g[i], b[i]}));
  std::vector<double> sorted = bright;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(r.size() / 2),
                   sorted.end());
  const double lamp = 20 * sorted[r.size() / 2];
  double truth = 0;
  for (const double value : bright) truth += value <= lamp ? value : 0;
  std::vector<double> sums;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    PrimaryHitParameters film;
    film.width = 256;
    film.height = 192;
    film.samples_per_pixel = 4;
    film.seed = seed;
    const LightLayers layers = trace_paths(scene, scene.cameras[0], film).layers.dense();
    double sum = 0;
    for (std::size_t i = 0; i < bright.size(); ++i) {
      if (bright[i] > lamp) continue;
      for (std::size_t light = 0; light < layers.layers.size(); ++light) {
        sum += scene.lights[light].power * luminance(layers.layers[light].radiance[i]);
      }
    }
    sums.push_back(sum / truth);
  }
  CHECK_VERDICT(test::mean_is(sums, 1.0, 0.02));
}

}  // namespace photile::test
