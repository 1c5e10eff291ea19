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

TEST_CASE("lamps beyond the greatest power are refused by name") {
  for (const char* emission : {"1e39 1e39 1e39", "1e30 1e30 1e30", "1e300 0 0"}) {
    CHECK_THAT(refusal_of(emission), Contains("light 'panel'") && Contains("1e+30"));
  }
  CHECK(refusal_of("1e29 1e29 1e29").empty());
}

TEST_CASE("an emissive scale that makes a lamp too bright is refused, not the scene") {
  SceneLoadOptions options;
  options.emissive_scale = 1e38;
  CHECK_THROWS_WITH(load_obj(lit_square, mtl_with("2 2 2"), options),
                    Contains("emissive scale of 1e+38") && Contains("light 'panel'") &&
                        Contains("6.283e+38 W") && !Contains("scene.obj"));
  options.emissive_scale = 2;
  CHECK_THAT(refusal_of("1e38 1e38 1e38", options), Contains("scene.obj"));
}

TEST_CASE("an area light of an option beyond the greatest power is refused, not the scene") {
  SceneLoadOptions options;
  options.panels.push_back({"panel", 1, 1, 1e31});
  CHECK_THROWS_WITH(load_gltf(square_document(), options),
                    Contains("area light 'panel' of 1e+31 lm") && !Contains("scene.gltf"));
}

TEST_CASE("a sky or a sun of too much light for the scene's size is refused, not the scene") {
  // Ninety metres wide: its sphere takes more lumens than the light has lux.
  const std::string large = "v 0 0 0\nv 90 0 0\nv 90 90 0\nv 0 90 0\nusemtl lamp\nf 1 2 3 4\n";
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::uniform, 1e30};
  CHECK_THROWS_WITH(load_obj(large, mtl_with("1 1 1"), options), Contains("sky of 1e+30 lux") &&
                                                                     Contains("fewer lux") &&
                                                                     !Contains("scene.obj"));
  options.sky.reset();
  options.sun = Sun{0, 40, 1e30};
  CHECK_THROWS_WITH(load_obj(large, mtl_with("1 1 1"), options), Contains("sun of 1e+30 lux") &&
                                                                     Contains("fewer lux") &&
                                                                     !Contains("scene.obj"));
}

TEST_CASE("a sky and a sun beyond the greatest illuminance are refused, not the scene") {
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::uniform, 1e300};
  CHECK_THROWS_WITH(load_obj(lit_square, mtl_with("1 1 1"), options),
                    Contains("sky of 1e+300 lux") && !Contains("scene.obj"));
  options.sky.reset();
  options.sun = Sun{0, 40, 1e38};
  CHECK_THROWS_WITH(load_obj(lit_square, mtl_with("1 1 1"), options), Contains("sun of 1e+38 lux"));
}

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
