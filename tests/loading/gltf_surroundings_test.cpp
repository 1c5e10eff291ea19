// EXT_lights_image_based: cube maps in PNGs, plain and RGBD, that surround a glTF scene.
#include <catch2/catch.hpp>
#include <numbers>

#include "file_bytes.hpp"
#include "photile/layered_picture.hpp"
#include "srgb_oracle.hpp"
#include "textured_square.hpp"
#include "writing/edited_scene.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

constexpr double disc = pi * 0.5;  // of the square's bounding sphere, radius sqrt(2) / 2

using Texel = std::vector<std::uint8_t>;

/// The dark square under a cube of faces of one colour each.
struct ImageBasedScene {
  explicit ImageBasedScene(const std::vector<Texel>& faces, int side = 2) {
    folder.write("square.bin", square_buffer());
    document["materials"][0]["emissiveFactor"] = {0, 0, 0};
    document["extensionsUsed"] = {"EXT_lights_image_based"};
    json images = json::array();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const std::string name = "face" + std::to_string(i) + ".png";
      write_texel(folder.path / name, faces[i], side);
      document["images"].push_back({{"uri", name}});
      images.push_back(i);
    }
    document["extensions"]["EXT_lights_image_based"]["lights"] = {
        {{"specularImages", json::array({images})}, {"specularImageSize", side}}};
    document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  }
  json& light() { return document["extensions"]["EXT_lights_image_based"]["lights"][0]; }
  std::filesystem::path file() const { return folder.write("scene.gltf", document.dump()); }
  Scene load(const SceneLoadOptions& options = {}) const { return load_scene(file(), options); }

  SceneFolderOnDisk folder;
  json document = square_document();
};

}  // namespace

TEST_CASE("six plain faces of L give the flux 4 pi L times the disc, times the intensity") {
  ImageBasedScene six(std::vector<Texel>(6, {188, 188, 188}));
  six.light()["name"] = "studio";
  six.light()["intensity"] = 500;
  const Scene scene = six.load();
  CHECK(scene.report.warnings.empty());
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].name == "studio");
  CHECK(scene.lights[0].kind == LightKind::environment);
  CHECK(scene.lights[0].power == Approx(500 * linear(188) * 4 * pi * disc));
  CHECK(scene.environments[scene.lights[0].environment].name() == "EXT_lights_image_based");
}

TEST_CASE("PNGs with alpha are RGBD: linear colour over alpha") {
  // 51 / 255 = 0.2; an alpha of 0 is the least there is, 1 / 255.
  CHECK(ImageBasedScene(std::vector<Texel>(6, {255, 255, 255, 51})).load().lights.at(0).power ==
        Approx(5 * 4 * pi * disc));
  CHECK(ImageBasedScene(std::vector<Texel>(6, {255, 255, 255, 0})).load().lights.at(0).power ==
        Approx(255 * 4 * pi * disc));
}

TEST_CASE("faces come in the order +x -x +y -y +z -z, and the rotation turns them") {
  const std::vector<Texel> colors{{255, 0, 0},   {0, 255, 255}, {0, 255, 0},
                                  {255, 0, 255}, {0, 0, 255},   {255, 255, 0}};
  const std::vector<glm::vec3> axes{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  ImageBasedScene six(colors, 16);  // the map's texels span 6 degrees
  const auto radiance = [&](const glm::vec3& towards) {
    return six.load().environments.at(0).radiance(towards);
  };
  for (std::size_t i = 0; i < 6; ++i) {
    const Texel& c = colors[i];
    CHECK(radiance(axes[i]) == glm::vec3(c[0], c[1], c[2]) / 255.0f);
  }
  // A quarter turn around y takes +z to +x, and +x to -z.
  six.light()["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
  CHECK(radiance({1, 0, 0}) == glm::vec3(0, 0, 1));
  CHECK(radiance({0, 0, -1}) == glm::vec3(1, 0, 0));
  CHECK(radiance({0, 1, 0}) == glm::vec3(0, 1, 0));
  six.light()["rotation"] = {0, 0, 0, 0};  // none
  CHECK(radiance({1, 0, 0}) == glm::vec3(1, 0, 0));
  for (const json& broken : {json{1, 2}, json("x"), json{"a", 0, 0, 1}}) {
    six.light()["rotation"] = broken;
    CHECK_THROWS_WITH(six.load(), Catch::Contains("lights[0].rotation"));
  }
}

TEST_CASE("pictures in buffers surround the scene as well") {
  ImageBasedScene six(std::vector<Texel>(6, {255, 255, 255}));
  const std::string bytes = bytes_of(six.folder.path / "face0.png");
  six.folder.write("faces.bin", bytes);
  six.document["buffers"].push_back({{"uri", "faces.bin"}, {"byteLength", bytes.size()}});
  six.document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", bytes.size()}});
  six.document["images"][3] = {{"bufferView", 4}, {"mimeType", "image/png"}};
  CHECK(six.load().lights.at(0).power == Approx(4 * pi * disc));
}

TEST_CASE("surroundings that cannot be read are named, with the remedy") {
  const std::vector<Texel> white(6, {255, 255, 255});
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::uniform, 1000};  // a light that stays
  options.ground = 0;
  const auto warning_of = [&](const ImageBasedScene& six) {
    const Scene scene = six.load(options);
    CHECK(scene.lights.size() == 1);
    REQUIRE(scene.report.warnings.size() == 1);
    CHECK_THAT(scene.report.warnings[0],
               Catch::Contains("EXT_lights_image_based") && Catch::Contains("--environment"));
    return scene.report.warnings[0];
  };
  using Catch::Contains;
  ImageBasedScene six(white);
  std::filesystem::remove(six.folder.path / "face4.png");
  CHECK_THAT(warning_of(six), Contains("face4.png"));
  write_texel(six.folder.path / "face4.png", white[0], 4);
  CHECK_THAT(warning_of(six), Contains("squares of one size"));
  write_texel(six.folder.path / "face4.png", white[0], 2);
  six.light()["specularImages"] = {{0, 1, 2}};
  CHECK_THAT(warning_of(six), Contains("six"));
  for (const json& broken : {json(), json::array(), json(3), json{{{"a", 1}}}}) {
    six.light()["specularImages"] = broken;
    CHECK_THAT(warning_of(six), Contains("six"));
  }
  for (const json& image : {json(6), json(-1), json(1e300), json("x")}) {
    six.light()["specularImages"] = {{0, 1, 2, 3, 4, image}};
    CHECK_THAT(warning_of(six), Contains("no image"));
  }
  six.light()["specularImages"] = {{0, 1, 2, 3, 4, 5}};
  for (const double intensity : {0.0, -1.0, 1e300}) {
    six.light()["intensity"] = intensity;
    CHECK_THAT(warning_of(six), Contains("intensity"));
  }
  CHECK_THAT(warning_of(ImageBasedScene(std::vector<Texel>(6, {0, 0, 0}))), Contains("black"));
}

TEST_CASE(
    "a light of the extension that is not there is refused, of the scene that is loaded alone") {
  ImageBasedScene six(std::vector<Texel>(6, {255, 255, 255}));
  for (const json& light : {json(1), json(-1), json(1e300), json("x")}) {
    six.document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = light;
    CHECK_THAT(input_error_of([&] { six.load(); }), Catch::Contains("there is no light"));
  }
  six.document["scenes"].push_back(six.document["scenes"][0]);
  six.document["scenes"][1]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  SceneLoadOptions options;
  options.scene = "1";
  CHECK(six.load(options).lights.size() == 1);
}

TEST_CASE("an edited copy keeps the pictures of surroundings and says so") {
  ImageBasedScene six(std::vector<Texel>(6, {255, 255, 255}));
  six.document["materials"][0]["emissiveFactor"] = {1, 1, 1};
  const std::filesystem::path file = six.file();
  LightMix mix = LightMix::of(load_scene(file), 683);
  REQUIRE(mix.lights.size() == 2);
  for (MixedLight& light : mix.lights) light.power *= 0.5;
  const auto copy = writing::write_edited_scene(file, {}, mix, "dim");
  REQUIRE(copy.left_out.size() == 1);
  CHECK_THAT(copy.left_out[0], Catch::Contains("environment") && Catch::Contains("pictures"));
  const Scene before = load_scene(file), after = load_scene(copy.file);
  REQUIRE(after.lights.size() == 2);
  CHECK(after.lights[0].power == Approx(before.lights[0].power));
  CHECK(after.lights[1].power == Approx(0.5 * before.lights[1].power));
}

}  // namespace photile::test
