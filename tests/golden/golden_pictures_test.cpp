// The bundled scenes look as they did when golden.csv was made, but for the noise of 16 seeds. The
// truth of pictures is told elsewhere (tests/validation, tests/reference): these tell that a change
// changes what it is meant to.
//
// PHOTILE_RENEW_GOLDEN=1 writes golden.csv anew, and says what has changed.

#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>

#include "file_bytes.hpp"
#include "light/light_at_points.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"
#include "tile_means.hpp"

namespace photile::test {
namespace {

constexpr int width = 32, height = 24, tile_side = 8;  ///< pixels

enum class Method {
  photons,  ///< photon estimates at nodes
  nodes,    ///< light maps whose nodes gather, as the quality good
  paths
};

struct Golden {
  std::string scene;  ///< below scenes/
  Method method;
  std::string name() const {
    const std::string file = std::filesystem::path(scene).stem().string();
    return file + (method == Method::photons ? " by photons"
                   : method == Method::nodes ? " by nodes"
                                             : " by paths");
  }
};

/// Every method where it has most to do.
const std::vector<Golden> few_pictures = {{"gallery/glossy-floor.gltf", Method::photons},
                                          {"cornell-box/cornell-box.gltf", Method::nodes},
                                          {"gallery/sun-and-sky.gltf", Method::paths}};
/// Every bundled scene.
const std::vector<Golden> other_pictures = {
    {"cornell-box/cornell-box.gltf", Method::photons},
    {"cornell-box/cornell-box-specular.gltf", Method::photons},
    {"gallery/coloured-lamps.gltf", Method::photons},
    {"gallery/downlights.gltf", Method::photons},
    {"gallery/glass-sphere.gltf", Method::photons},
    {"living-room/living-room.gltf", Method::photons},
    {"gallery/metal-ring.gltf", Method::photons},
    {"gallery/sun-and-sky.gltf", Method::photons},
    {"cornell-box/cornell-box.gltf", Method::paths},
    {"gallery/sun-and-sky.gltf", Method::nodes},
    {"gallery/glossy-floor.gltf", Method::nodes},
    {"gallery/glossy-floor.gltf", Method::paths}};

RenderParameters parameters_of(Method method, std::uint64_t seed) {
  RenderParameters parameters;
  if (method == Method::nodes) set_quality(parameters, Quality::good);
  if (method == Method::photons) parameters.neighbours = 500;
  parameters.seed = seed;
  const int samples = method == Method::nodes ? 2 : method == Method::photons ? 8 : 32;
  parameters.film = {width, height, samples};
  parameters.photons.emitted_photons = 30'000;
  return parameters;
}

/// The sum of all lights.
Pixels picture_of(const Scene& scene, Method method, std::uint64_t seed) {
  const RenderParameters parameters = parameters_of(method, seed);
  const Camera& camera = scene.cameras.front();
  const LightLayers layers =
      (method == Method::paths ? trace_paths(scene, camera, eye_rays(parameters)).layers
                               : render(scene, camera, device(), parameters).layers)
          .dense();
  const std::vector<double> powers = light::layer_powers(scene);
  Pixels pixels(static_cast<std::size_t>(width * height), glm::dvec4(0));
  for (std::size_t layer = 0; layer < powers.size(); ++layer) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const LightLayers::Layer& light = layers.layers[layer];
      pixels[i] += powers[layer] * glm::dvec4(light.radiance[i], light.illuminance[i]);
    }
  }
  return pixels;
}

TileMeans rendered(const Golden& golden) {
  SceneLoadOptions options;
  if (golden.scene == "gallery/sun-and-sky.gltf") {
    options.sun = Sun::parse("60,40,40000");
    options.sky = Sky::parse("clear=12000");
    options.ground = 0;
  }
  const Scene scene = load_scene(source_folder() / "scenes" / golden.scene, options);
  std::vector<Pixels> seeds;
  for (std::uint64_t seed = 1; seed <= golden_seeds; ++seed)
    seeds.push_back(picture_of(scene, golden.method, seed));
  return tile_means(golden.name(), seeds, width, tile_side);
}

const TileMeans* find(const std::vector<TileMeans>& pictures, const std::string& name) {
  for (const TileMeans& picture : pictures) {
    if (picture.picture == name) return &picture;
  }
  return nullptr;
}

/// A picture as if its lamps were that much brighter.
TileMeans brighter(TileMeans means, double factor) {
  for (TileMean& tile : means.tiles) {
    tile.mean *= factor;
    tile.deviation *= factor;
  }
  return means;
}

/// Whether these pictures look as they did, but for the noise of 16 seeds.
void check_pictures(const std::vector<Golden>& pictures) {
  const auto file = source_folder() / "tests/golden/golden.csv";
  const std::vector<TileMeans> before = from_csv(bytes_of(file));
  const bool renew = std::getenv("PHOTILE_RENEW_GOLDEN") != nullptr;
  std::vector<TileMeans> all;
  for (const Golden& golden : pictures) {
    all.push_back(rendered(golden));
    const TileMeans& now = all.back();
    const TileMeans* const known = find(before, now.picture);
    if (known == nullptr) {
      if (!renew)
        FAIL("golden.csv lacks " << now.picture << "; renew it with PHOTILE_RENEW_GOLDEN=1");
      std::cout << now.picture << ": new\n";
      continue;
    }
    const TileComparison found = compare(*known, now);
    const std::string line =
        fmt::format("{}: {:+.2f}% (seen from {:.1f}% on); most: {}, {:.2f} of what is allowed",
                    now.picture, 100 * found.change, 100 * found.visible,
                    found.where.empty() ? "nothing" : found.where, found.most);
    if (renew) {
      std::cout << line << "\n";
      continue;
    }
    INFO(line);
    CHECK(found.most <= 1);
    // Otherwise the test would prove little: lamps so much brighter have to be seen.
    CHECK(found.visible < 0.15);
    CHECK(compare(*known, brighter(now, 1.01 + found.visible + std::abs(found.change))).most > 1);
  }
  CHECK(before.size() == few_pictures.size() + other_pictures.size());
  if (!renew) return;
  for (const TileMeans& picture : before) {
    if (!find(all, picture.picture)) all.push_back(picture);
  }
  std::ofstream(file) << to_csv(all);
}

}  // namespace

TEST_CASE("the bundled scenes look as they did, by every method") { check_pictures(few_pictures); }
TEST_CASE("all other bundled scenes look as they did", "[slow]") { check_pictures(other_pictures); }

}  // namespace photile::test
