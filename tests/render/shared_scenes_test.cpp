// Every scene that lies beside a checkout, where one does, as a picture.
#include "shared_scenes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "skipped.hpp"

namespace photile::test {
namespace {

/// PixelCounts that no picture may have, and those that are not black.
struct PixelCounts {
  std::size_t bad = 0, lit = 0;
};

PixelCounts values_of(const LightLayers& layers) {
  PixelCounts values;
  for (const LightLayers::Layer& layer : layers.dense().layers) {
    for (const glm::vec3& pixel : layer.radiance) {
      for (int c = 0; c < 3; ++c) {
        values.bad += !(std::isfinite(pixel[c]) && pixel[c] >= 0.0f);
        values.lit += pixel[c] > 0.0f;
      }
    }
  }
  return values;
}

}  // namespace

/// A hundred files of every kind: half of them are closed boxes, which are dark inside.
TEST_CASE("every shared scene that loads renders to finite light under a sky", "[slow]") {
  if (!std::filesystem::exists(test::shared_scenes_folder())) {
    test::skip("no " + test::shared_scenes_folder().string());
    return;
  }
  Device device;
  RenderParameters parameters = small_picture(2'000, 16, 12, 1);
  int pictures = 0, lit = 0;
  for (const test::SharedScene& shared : test::shared_scenes) {
    if (!shared.refusal.empty()) continue;
    CAPTURE(shared.file);
    const Scene scene = test::load_shared_scene(shared);
    const PixelCounts values =
        values_of(render(scene, scene.cameras.front(), device, parameters).layers);
    CHECK(values.bad == 0);
    ++pictures;
    lit += values.lit > 0;
  }
  CHECK(2 * lit > pictures);
}

}  // namespace photile::test
