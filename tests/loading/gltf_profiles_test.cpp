// Photometric files at the lights of a glTF scene.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "photometric_texts.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// An even lamp of 100 cd: 400 pi lm.
const std::string even_lamp = IesText().str();

/// A dark square and a node called lamp with the given members.
json document_with(const json& node = json::object()) {
  json lamp = {{"name", "lamp"}, {"translation", {0, 0, 2}}};
  lamp.update(node);
  return dark_square_and(lamp);
}

json with_profiles(json document, const json& lights) {
  document["extensionsUsed"] = {"EXT_lights_ies"};
  document["extensions"]["EXT_lights_ies"]["lights"] = lights;
  return document;
}

json node_of_profile(json members = json::object()) {
  members["light"] = 0;
  return {{"extensions", {{"EXT_lights_ies", members}}}};
}

json point_light_node(json& document) {
  document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"},
                                                              {"intensity", 7},
                                                              {"color", {1, 0.5, 0}},
                                                              {"spot", {{"outerConeAngle", 0.5}}}}};
  return {{"KHR_lights_punctual", {{"light", 0}}}};
}

struct Folder : SceneFolderOnDisk {
  Folder() {
    write("square.bin", square_buffer());
    write("lamp.ies", even_lamp);
  }
  Scene load(const json& document, const SceneLoadOptions& options = {}) const {
    return load_scene(write("scene.gltf", document.dump()), options);
  }
};

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

}  // namespace

TEST_CASE("a node of EXT_lights_ies is a point light with the file's flux") {
  const Scene scene =
      Folder().load(with_profiles(document_with(node_of_profile()), {{{"uri", "lamp.ies"}}}));
  REQUIRE(scene.lights.size() == 1);
  const Light& lamp = scene.lights[0];
  CHECK(lamp.kind == LightKind::point);
  CHECK(lamp.name == "lamp");
  CHECK(lamp.power == Approx(400 * pi));
  REQUIRE(lamp.distribution < scene.distributions.size());
  CHECK(lamp.position == glm::vec3(0, 0, 2));
  CHECK(lamp.direction == glm::vec3(0, 0, -1));
  CHECK(lamp.x_axis == glm::vec3(1, 0, 0));
  CHECK(scene.report.warnings.empty());
}

TEST_CASE("profiles may lie in data URIs and buffer views") {
  const json document = document_with(node_of_profile());
  for (const char* type : {"application/x-ies-lm-63", "application/octet-stream"}) {
    const std::string uri = std::string("data:") + type + ";base64," + base64(even_lamp);
    CHECK(Folder().load(with_profiles(document, {{{"uri", uri}}})).lights.at(0).power ==
          Approx(400 * pi));
  }
  const Folder folder;
  folder.write("buffer.bin", even_lamp);
  json viewed =
      with_profiles(document, {{{"bufferView", 4}, {"mimeType", "application/x-ies-lm-63"}}});
  viewed["buffers"].push_back({{"uri", "buffer.bin"}, {"byteLength", even_lamp.size()}});
  viewed["bufferViews"].push_back({{"buffer", 1}, {"byteLength", even_lamp.size()}});
  CHECK(folder.load(viewed).lights.at(0).power == Approx(400 * pi));
}

TEST_CASE("multiplier and colour change the flux; nodes share a file that is read once") {
  json document = document_with(node_of_profile({{"multiplier", 0.5}, {"color", {1, 0, 0}}}));
  document["nodes"].push_back(document["nodes"][1]);
  document["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = Folder().load(with_profiles(document, {{{"uri", "lamp.ies"}}}));
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.distributions.size() == 1);
  CHECK(scene.lights[1].power == Approx(0.5 * 0.2126 * 400 * pi));
  CHECK(scene.lights[1].color.g == 0.0f);
}

TEST_CASE("a lamp turns with its node") {
  // A quarter turn about x takes -z to -y... +y to +z.
  const double half = std::sqrt(0.5);
  json node = node_of_profile();
  node["rotation"] = {-half, 0, 0, half};
  node["scale"] = {3, 2, 1};
  const Scene scene = Folder().load(with_profiles(document_with(node), {{{"uri", "lamp.ies"}}}));
  CHECK(glm::distance(scene.lights.at(0).direction, glm::vec3(0, -1, 0)) < 1e-6f);
  CHECK(glm::distance(scene.lights.at(0).x_axis, glm::vec3(1, 0, 0)) < 1e-6f);
}

TEST_CASE("photile_ies gives a light its file, with the light's colour") {
  json document = document_with();
  document["nodes"][1]["extensions"] = point_light_node(document);
  document["nodes"][1]["extras"]["photile_ies"] = "lamp.ies";
  const Scene scene = Folder().load(document);
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == LightKind::point);
  CHECK(scene.lights[0].power == Approx(400 * pi));
  CHECK(scene.lights[0].color.r == Approx(2 * scene.lights[0].color.g));
  document["nodes"][1]["extras"]["photile_lumens"] = 800;
  CHECK(Folder().load(document).lights.at(0).power == 800);
}

TEST_CASE("photile_ies makes a light of an empty node") {
  const Scene scene = Folder().load(document_with({{"extras", {{"photile_ies", "lamp.ies"}}}}));
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].power == Approx(400 * pi));
  CHECK(scene.report.warnings.empty());
}

TEST_CASE("photile_lumens sets the flux of any lamp without size, but no sun's") {
  json document = document_with();
  document["nodes"][1]["extensions"] = point_light_node(document);
  document["nodes"][1]["extras"]["photile_lumens"] = 800;
  CHECK(Folder().load(document).lights.at(0).power == 800);
  document["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "directional";
  CHECK(warns(Folder().load(document), {"'lamp'", "photile_lumens"}));
}

TEST_CASE("the option --ies gives a point or spot light a file") {
  const Folder folder;
  json document = document_with();
  document["nodes"][1]["extensions"] = point_light_node(document);
  folder.write("lamp.ldt", EulumdatText().str());
  for (const auto& [file, power] :
       {std::pair{"lamp.ies", 400 * pi}, {"lamp.ldt", 50 * 2 * 4 * pi}}) {
    SceneLoadOptions options;
    options.profiles.push_back(LightProfile::parse("lamp=" + (folder.path / file).string()));
    const Scene scene = folder.load(document, options);
    CHECK(scene.lights.at(0).kind == LightKind::point);
    CHECK(scene.lights.at(0).power == Approx(power));
  }
}

}  // namespace photile::test
