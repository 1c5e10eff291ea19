// Lights of glTF files: emissive materials and KHR_lights_punctual.
#include <catch2/catch.hpp>
#include <numbers>

#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// The square without emission, lit by one punctual light at a node.
nlohmann::json lit_by(const nlohmann::json& light, const nlohmann::json& node_members = {}) {
  nlohmann::json node = {{"name", "lamp"}, {"translation", {0, 0, 2}}};
  if (node_members.is_object()) node.update(node_members);
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  nlohmann::json document = dark_square_and(node);
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({light});
  return document;
}

}  // namespace

TEST_CASE("an emissive glTF square emits pi * area * luminance lumens from its front") {
  nlohmann::json document = square_document();
  const Scene front = load_gltf(document);
  CHECK(front.unit == PowerUnit::lumen);
  REQUIRE(front.lights.size() == 1);
  CHECK(front.lights[0].name == "panel");
  CHECK(front.lights[0].power == Approx(100.0 * pi));
  CHECK_FALSE(front.lights[0].two_sided);
  document["materials"][0]["doubleSided"] = true;
  const Scene both = load_gltf(document);
  CHECK(both.lights[0].power == Approx(200.0 * pi));
  CHECK(both.lights[0].two_sided);
}

TEST_CASE("a node with two emissive materials gives two lights named after them") {
  nlohmann::json document = square_document();
  document["materials"].push_back({{"name", "neon"}, {"emissiveFactor", {0, 1, 0}}});
  auto& primitives = document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  const Scene scene = load_gltf(document);
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].name == "panel_glow");
  CHECK(scene.lights[1].name == "panel_neon");
  CHECK(scene.lights[1].power == Approx(pi * 0.7152));
}

TEST_CASE("a point light emits 4 pi lumens per candela, whatever its node's scale") {
  const Scene scene = load_gltf(
      lit_by({{"type", "point"}, {"intensity", 10}, {"range", 3}}, {{"scale", {5, 5, 5}}}));
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == LightKind::point);
  CHECK(scene.lights[0].power == Approx(40.0 * pi));
  CHECK(scene.lights[0].position == glm::vec3(0, 0, 2));
  CHECK(warns(scene, {"'lamp'", "range"}));
}

TEST_CASE("what a file makes invisible is left out, with all below it") {
  nlohmann::json document = lit_by({{"type", "point"}, {"intensity", 10}});
  document["extensionsUsed"].push_back("KHR_node_visibility");
  document["extensionsRequired"] = {"KHR_node_visibility"};
  document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  document["nodes"].push_back({{"name", "group"}, {"children", {1, 3}}});
  document["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  document["scenes"][0]["nodes"] = {0, 2};
  const auto with = [&](const nlohmann::json& visible) {
    document["nodes"][2]["extensions"]["KHR_node_visibility"] = visible;
    return load_gltf(document);
  };
  for (const auto& visible : {nlohmann::json::object(), nlohmann::json{{"visible", true}}}) {
    const Scene shown = with(visible);
    CHECK(shown.lights.size() == 1);
    CHECK(shown.cameras.at(0).name == "eye");
    CHECK_FALSE(warns(shown, {"visib"}));
  }
  document["materials"][0]["emissiveFactor"] = {1, 1, 1};
  const Scene hidden = with({{"visible", false}});
  REQUIRE(hidden.lights.size() == 1);
  CHECK(hidden.lights[0].name == "panel");
  for (const Camera& camera : hidden.cameras) CHECK(camera.name != "eye");
  CHECK(warns(hidden, {"'group'", "KHR_node_visibility", "all below"}));
}

TEST_CASE("the colour of a light multiplies its intensity by its luminance") {
  const Scene scene =
      load_gltf(lit_by({{"type", "point"}, {"intensity", 10}, {"color", {0.5, 0, 0}}}));
  CHECK(scene.lights[0].power == Approx(40.0 * pi * 0.5 * 0.2126));
  CHECK(scene.lights[0].color.g == 0.0f);
  CHECK(luminance(glm::dvec3(scene.lights[0].color)) == Approx(1.0));
}

TEST_CASE("a hard spot light emits the flux of its cap, along -z of its node") {
  const Scene scene = load_gltf(
      lit_by({{"type", "spot"},
              {"intensity", 10},
              {"spot", {{"innerConeAngle", pi / 3}, {"outerConeAngle", pi / 3 + 1e-9}}}}));
  CHECK(scene.lights[0].kind == LightKind::spot);
  CHECK(scene.lights[0].power == Approx(10.0 * 2.0 * pi * (1.0 - 0.5)).epsilon(1e-5));
  CHECK(scene.lights[0].direction == glm::vec3(0, 0, -1));
}

TEST_CASE("a directional light's flux is its lux over the disc of the bounding sphere") {
  const Scene scene = load_gltf(lit_by({{"type", "directional"}, {"intensity", 1000}}));
  CHECK(scene.lights[0].kind == LightKind::directional);
  CHECK(scene.lights[0].power == Approx(1000.0 * pi * 0.5));  // radius sqrt(2) / 2
}

}  // namespace photile::test
