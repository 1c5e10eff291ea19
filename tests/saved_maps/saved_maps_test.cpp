// Photons and groups saved and loaded: the same bits, and nothing that is not.
#include "saved_maps/saved_maps.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <limits>

#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "temporary_folder.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {

using Catch::Contains;

namespace {

RenderParameters small(MapMode maps = MapMode::automatic) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 2'000;
  parameters.maps = maps;
  parameters.film.width = 24;
  parameters.film.height = 16;
  return parameters;
}

/// A file saved while a picture's maps are built.
struct Saved {
  explicit Saved(const Scene& scene, const RenderParameters& parameters = small())
      : file(folder.path / "maps.photile") {
    SceneRenderer renderer(
        scene, std::span(&test::device(), 1), parameters, nullptr,
        [&](const PreparedPhotons& prepared) { saved_maps::save(file, scene, "words", prepared); });
    layers = renderer.render(scene_camera(), parameters.film).layers;
  }

  static Camera scene_camera() {
    return Camera::look_at({0.5, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0);
  }
  std::string bytes() const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(file, std::ios::binary) << bytes; }

  TemporaryFolder folder;
  std::filesystem::path file;
  LightLayers layers;
};

}  // namespace

TEST_CASE("a picture from loaded maps is the picture, bit for bit") {
  const Scene scene = test::furnished_room();
  const MapMode mode =
      GENERATE(MapMode::automatic, MapMode::triangle, MapMode::patch, MapMode::naive);
  const RenderParameters parameters = small(mode);
  const Saved saved(scene, parameters);
  PreparedPhotons prepared = saved_maps::load(saved.file, scene, "words");
  SceneRenderer renderer(scene, std::span(&test::device(), 1), parameters, &prepared);
  const LightLayers layers = renderer.render(Saved::scene_camera(), parameters.film).layers;
  for (std::size_t light = 0; light < layers.layers.size(); ++light) {
    CHECK(layers.layers[light].radiance == saved.layers.layers[light].radiance);
    CHECK(layers.layers[light].illuminance == saved.layers.layers[light].illuminance);
  }
}

TEST_CASE("saving twice gives the same bytes") {
  const Scene scene = test::furnished_room();
  CHECK(Saved(scene).bytes() == Saved(scene).bytes());
}

TEST_CASE("a file cut off anywhere is refused") {
  const Scene scene = test::furnished_room();
  const Saved saved(scene);
  const std::string whole = saved.bytes();
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t length = i < 100 ? i : (i - 100) * whole.size() / 200;
    saved.write(whole.substr(0, length));
    INFO(length << " of " << whole.size() << " bytes");
    REQUIRE_THROWS_AS(saved_maps::load(saved.file, scene, "words"), InputError);
  }
}

TEST_CASE("a file with any byte changed, or with more of them, is refused") {
  const Scene scene = test::furnished_room();
  const Saved saved(scene);
  const std::string whole = saved.bytes();
  for (std::size_t i = 0; i < 300; ++i) {
    std::string spoilt = whole;
    const std::size_t at = i < 120 ? i : (i - 120) * whole.size() / 180;
    spoilt[at] = static_cast<char>(spoilt[at] ^ (i % 2 == 0 ? 0x80 : 1));
    saved.write(spoilt);
    INFO("byte " << at);
    REQUIRE_THROWS_AS(saved_maps::load(saved.file, scene, "words"), InputError);
  }
  saved.write(whole + "x");
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, "words"), Contains("after its end"));
}

TEST_CASE("light maps are kept with their photons, and read again without an estimate") {
  const Scene scene = test::furnished_room();
  RenderParameters parameters = small();
  parameters.light_maps = LightMapMode::on;
  const std::vector<glm::vec3> powers(2, glm::vec3(1.0f));
  const Film film{24, 16, 1};
  const auto draw = [&](SceneRenderer& renderer, double seconds, DrawnFrame& drawn) {
    std::vector<glm::vec3> picture(24 * 16);
    drawn = renderer.draw(Saved::scene_camera(), film, powers, seconds, picture);
    return picture;
  };
  DrawnFrame drawn;
  std::vector<glm::vec3> expected;
  const TemporaryFolder folder;
  const auto file = folder.path / "maps.photile";
  LightLayers layers;
  {
    SceneRenderer renderer(
        scene, std::span(&test::device(), 1), parameters, nullptr,
        [&](const PreparedPhotons& photons) { saved_maps::save(file, scene, "words", photons); });
    CHECK_FALSE(renderer.light_maps());
    expected = draw(renderer, std::numeric_limits<double>::infinity(), drawn);
    layers = renderer.render(Saved::scene_camera(), parameters.film).layers;
    saved_maps::add_light_maps(file, *renderer.light_maps());
    saved_maps::add_light_maps(file, *renderer.light_maps());  // in place of the first
  }
  SECTION("the same settings") {
    PreparedPhotons prepared = saved_maps::load(file, scene, "words");
    REQUIRE(prepared.light_maps);
    SceneRenderer renderer(scene, std::span(&test::device(), 1), parameters, &prepared);
    CHECK(draw(renderer, 0, drawn) == expected);
    CHECK(drawn.lacking == 0);
    const LightLayers again = renderer.render(Saved::scene_camera(), parameters.film).layers;
    CHECK(again.layers[1].radiance == layers.layers[1].radiance);
  }
  SECTION("another k: nodes are made anew") {
    PreparedPhotons prepared = saved_maps::load(file, scene, "words");
    RenderParameters other = parameters;
    other.neighbours = parameters.neighbours / 2;
    SceneRenderer renderer(scene, std::span(&test::device(), 1), other, &prepared);
    draw(renderer, 0, drawn);
    CHECK(drawn.lacking > 0);
  }
  SECTION("light maps off: photons alone") {
    PreparedPhotons prepared = saved_maps::load(file, scene, "words");
    SceneRenderer renderer(scene, std::span(&test::device(), 1), small(), &prepared);
    CHECK(renderer.render(Saved::scene_camera(), parameters.film).layers.layers.size() == 2);
  }
  SECTION("damage") {
    std::ifstream stream(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t photons = whole.find("PHOTNODE");
    REQUIRE(photons != std::string::npos);
    for (std::size_t i = 0; i < 100; ++i) {
      const std::size_t at = photons + (i < 40 ? i : 32 + (i - 40) * (whole.size() - photons) / 80);
      std::string spoilt = whole;
      spoilt[at] = static_cast<char>(spoilt[at] ^ 4);
      std::ofstream(file, std::ios::binary) << spoilt;
      INFO("byte " << at);
      REQUIRE_THROWS_AS(saved_maps::load(file, scene, "words"), InputError);
      std::ofstream(file, std::ios::binary) << whole.substr(0, at + 1);
      REQUIRE_THROWS_AS(saved_maps::load(file, scene, "words"), InputError);
    }
  }
}

TEST_CASE("another scene, other settings and other files are told apart") {
  const Scene scene = test::furnished_room();
  const Saved saved(scene);
  Scene moved = scene;
  moved.vertices[3].x += 1e-4f;
  CHECK_THROWS_WITH(saved_maps::load(saved.file, moved, "words"), Contains("another scene"));
  Scene painted = scene;
  painted.materials[0].diffuse.g += 1e-3f;
  CHECK_THROWS_WITH(saved_maps::load(saved.file, painted, "words"), Contains("another scene"));
  Scene lit = scene;
  lit.lights[1].position.z += 1e-4f;
  CHECK_THROWS_WITH(saved_maps::load(saved.file, lit, "words"), Contains("another scene"));
  Scene renamed = scene;
  renamed.source = "elsewhere/room.gltf";
  CHECK_NOTHROW(saved_maps::load(saved.file, renamed, "words"));
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, "other words"),
                    Contains("words") && Contains("other words"));
  CHECK_THROWS_WITH(saved_maps::load(saved.folder.path / "none", scene, "words"),
                    Contains("no such file"));
  saved.write("v 0 0 0\n");
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, "words"), Contains("no photon maps"));
}

TEST_CASE("another version or byte order is named") {
  const Scene scene = test::furnished_room();
  const Saved saved(scene);
  std::string bytes = saved.bytes();
  std::string newer = bytes;
  newer[8] = 9;
  saved.write(newer);
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, "words"), Contains("version 9"));
  std::swap(bytes[12], bytes[15]);
  std::swap(bytes[13], bytes[14]);
  saved.write(bytes);
  CHECK_THROWS_WITH(saved_maps::load(saved.file, scene, "words"), Contains("byte order"));
}

TEST_CASE("a whole file whose indices lead nowhere is refused") {
  const Scene scene = test::furnished_room();
  const TemporaryFolder folder;
  const auto file = folder.path / "maps.photile";
  PreparedPhotons good;
  const SceneRenderer renderer(scene, std::span(&test::device(), 1), small(), nullptr,
                               [&](const PreparedPhotons& prepared) { good = prepared; });
  const auto refused = [&](const PreparedPhotons& bad) {
    saved_maps::save(file, scene, "words", bad);
    CHECK_THROWS_AS(saved_maps::load(file, scene, "words"), InputError);
  };
  saved_maps::save(file, scene, "words", good);
  CHECK_NOTHROW(saved_maps::load(file, scene, "words"));
  PreparedPhotons bad = good;
  SECTION("light") { bad.photons.light[0] = 7; }
  SECTION("triangle") { bad.photons.sided_triangle[0] = 1'000'000; }
  SECTION("rows") { bad.photons.first_of[1] = 0xFFFF'FFFF; }
  SECTION("lengths") { bad.photons.flux.pop_back(); }
  SECTION("members") { bad.groups.members[0] = 1'000'000; }
  SECTION("offsets") { bad.groups.offsets[1] = ~std::uint64_t{0}; }
  SECTION("NaN") { bad.photons.position[0].x = std::nanf(""); }
  SECTION("radius") { bad.radius = 0; }
  SECTION("lights") { bad.photons.emitted_per_light.push_back(1); }
  refused(bad);
}

}  // namespace photile::test
