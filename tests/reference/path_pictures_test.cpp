// Pictures of the path tracer: what they do not depend on, and their layers.
#include <glm/gtc/constants.hpp>

#include "photile/image.hpp"
#include "render/pictures.hpp"
#include "shared_scenes.hpp"
#include "skipped.hpp"

namespace photile::test {
namespace {

PrimaryHitParameters film(int width, int height, int samples, std::uint64_t seed = 1) {
  PrimaryHitParameters result;
  result.width = width;
  result.height = height;
  result.samples_per_pixel = samples;
  result.seed = seed;
  return result;
}

TEST_CASE("another seed gives another path-traced picture") {
  const Scene scene = furnished_room();
  const auto of = [&](std::uint64_t seed) {
    return trace_paths(scene, room_camera(), film(8, 6, 1, seed)).layers;
  };
  CHECK_FALSE(same_bits(of(1), of(2)));
}

TEST_CASE("lights beyond the dense ones give the same path-traced layers, in the sparse form") {
  Scene scene = furnished_room();
  for (int i = 0; i < 7; ++i) {
    scene.lights.push_back(point_light("spare " + std::to_string(i),
                                       {0.3f + 0.4f * static_cast<float>(i), 1, 2}, 100));
  }
  const LightLayers sparse = trace_paths(scene, room_camera(), film(16, 12, 4)).layers;
  REQUIRE(sparse.sparse());
  // In one group the same paths give the same light together: sum of shares x layers.
  Scene grouped = scene;
  for (Light& light : grouped.lights) light.group = "all";
  const LightLayers together = trace_paths(grouped, room_camera(), film(16, 12, 4)).layers;
  REQUIRE(together.layers.size() == 1);
  double power = 0, sum = 0;
  const LightLayers dense = sparse.dense();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    power += scene.lights[i].power;
    sum += scene.lights[i].power * LayerMeans(dense.layers[i]).radiance;
    CHECK(LayerMeans(dense.layers[i]).radiance > 0);
  }
  CHECK(power * LayerMeans(together.layers[0]).radiance == Approx(sum).epsilon(1e-4));
}

TEST_CASE("a path-traced floor under a point light: mean illuminance and radiance over a square") {
  // The closed form of tests/render: the solid angle of the square, 4 asin(1 / 2), times 1 cd, over
  // 4 m2.
  constexpr float albedo = 0.6f;
  Scene scene = plate(diffuse(albedo), 4.0f, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}, 4.0 * glm::pi<double>()));
  const Camera camera =
      Camera::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(1.0 / 3.0));
  const double truth = std::asin(0.5);
  std::vector<double> illuminance, radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto layer = trace_paths(scene, camera, film(48, 48, 4, seed)).layers.layers[0];
    illuminance.push_back(scene.lights[0].power * LayerMeans(layer).illuminance);
    radiance.push_back(scene.lights[0].power * LayerMeans(layer).radiance);
  }
  CHECK_VERDICT(mean_is(illuminance, truth, 0.001 * truth));
  const double reflected = truth * double{albedo} / glm::pi<double>();
  CHECK_VERDICT(mean_is(radiance, reflected, 0.001 * reflected));
}

TEST_CASE("reflections by paths are what the lobe reflects of a lamp, whatever lies below it") {
  // No light comes back to the plate: with a black base the lobe is all that is seen of it.
  const auto plate = [](float albedo) {
    Scene scene = test::plate(glossy(albedo, 0.3f, 0.4f), 4.0f, 3);
    scene.lights.push_back(point_light("lamp", {0.5f, 0, 1}, 10));
    return scene;
  };
  const Camera camera = Camera::look_at({-1, 0, 2}, {0, 0, 0}, {0, 0, 1}, 0.5);
  const LightLayers black = trace_paths(plate(0.0f), camera, film(16, 12, 4)).layers;
  const LightLayers white = trace_paths(plate(0.9f), camera, film(16, 12, 4)).layers;
  const LightLayers lobe =
      trace_paths_of_hits(plate(0.9f), reflected_hits(camera), film(16, 12, 4), Progress::none())
          .layers;
  for (std::size_t pixel = 0; pixel < lobe.layers[0].radiance.size(); ++pixel) {
    CHECK(luminance(lobe.layers[0].radiance[pixel]) ==
          Approx(luminance(black.layers[0].radiance[pixel])).epsilon(1e-5));
  }
  CHECK(LayerMeans(lobe.layers[0]).radiance > 0);
  CHECK(LayerMeans(lobe.layers[0]).radiance < 0.5 * LayerMeans(white.layers[0]).radiance);
}

// The path tracer beside the photon maps, which share no estimate with it, and beside references of
// another renderer.

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

TEST_CASE("paths and photon maps see the same light in the living room, light by light", "[slow]") {
  const Scene scene = load_scene(source_folder() / "scenes/living-room/living-room.gltf");
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
      return render(scene, scene.cameras[0], device(), parameters).layers;
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
    CHECK_VERDICT(mean_is(differences[light], 0.0, 0.1 * by_paths[light]));
  }
}

TEST_CASE("paths agree with the references of another renderer", "[slow]") {
  const std::string name = GENERATE("kitchen", "classroom");
  const std::filesystem::path shared = shared_scenes_folder();
  const auto file = shared / name / (name + "-diffuse.gltf");
  if (!std::filesystem::exists(file)) {
    skip("no " + file.string());
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
  CHECK_VERDICT(mean_is(sums, 1.0, 0.02));
}

}  // namespace
}  // namespace photile::test
