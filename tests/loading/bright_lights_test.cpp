// Lights of more power than floats can carry are refused by name, when they are loaded or changed.
#include <catch2/catch.hpp>

#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

const std::string lit_square = unit_square + "o panel\nusemtl lamp\nf 1 2 3 4\n";

std::string mtl_with(const std::string& emission) {
  return "newmtl lamp\nKd 0 0 0\nKe " + emission + "\n";
}

std::string refusal_of(const std::string& emission, const SceneLoadOptions& options = {}) {
  return input_error_of([&] { load_obj(lit_square, mtl_with(emission), options); });
}

}  // namespace

TEST_CASE(
    "an environment beyond floats is refused by its file, one of too much power by its light") {
  const SceneFolderOnDisk folder;
  Image picture;
  picture.width = 4;
  picture.height = 2;
  for (const char* channel : {"R", "G", "B"}) picture.add(channel).assign(8, 3e38f);
  write_exr(folder.path / "sky.exr", picture);
  SceneLoadOptions options;
  options.environment.file = folder.path / "sky.exr";
  options.environment.scale = 2;
  CHECK_THAT(refusal_of("1 1 1", options),
             Contains("sky.exr") && Contains("8 of its 8 texels") && !Contains("scene.obj"));
  options.environment.scale = 1;
  CHECK_THAT(refusal_of("1 1 1", options), Contains("sky.exr: light 'environment'") &&
                                               Contains("1e+30") && !Contains("scene.obj"));
}

TEST_CASE("a light is not turned up beyond the greatest power") {
  const Scene scene = load_obj(lit_square, mtl_with("1 1 1"));
  LightMix mix = LightMix::of(scene, 683);
  CHECK_THROWS_WITH(change_lights(mix, {{"panel", "x1e31"}}),
                    Contains("light 'panel'") && Contains("1e+30"));
  CHECK_THROWS_WITH(change_lights(mix, {{"panel", "2e30"}}), Contains("light 'panel'"));
  change_lights(mix, {{"panel", "1e30"}});
  CHECK(mix.lights[0].power == limits::max_light_power);
}

}  // namespace photile::test
