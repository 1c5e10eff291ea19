// Lights of glTF files: emissive materials and KHR_lights_punctual.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// The square without emission, lit by one punctual light at a node.
json lit_by(const json& light, const json& node_members = {}) {
  json node = {{"name", "lamp"}, {"translation", {0, 0, 2}}};
  if (node_members.is_object()) node.update(node_members);
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  json document = dark_square_and(node);
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
  return document;
}

TEST_CASE("an emissive glTF square emits pi * area * luminance lumens from its front") {
  json document = square_document();
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
  json document = square_document();
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
  json document = lit_by({{"type", "point"}, {"intensity", 10}});
  document["extensionsUsed"].push_back("KHR_node_visibility");
  document["extensionsRequired"] = {"KHR_node_visibility"};
  document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  document["nodes"].push_back({{"name", "group"}, {"children", {1, 3}}});
  document["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  document["scenes"][0]["nodes"] = {0, 2};
  const auto with = [&](const json& visible) {
    document["nodes"][2]["extensions"]["KHR_node_visibility"] = visible;
    return load_gltf(document);
  };
  for (const auto& visible : {json::object(), json{{"visible", true}}}) {
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

// Area lights at nodes: what Blender's exporter drops, and EXT_lights_area.

/// A dark square at z = 0, and a node called Area above it.
json panel_document(const json& members) {
  json node = {{"name", "Area"}, {"translation", {0.5, 0.5, 2}}};
  node.update(members);
  return dark_square_and(node);
}

json with_extras(const json& extras) { return panel_document({{"extras", extras}}); }

json with_extension(const json& light) {
  json document = panel_document({{"extensions", {{"EXT_lights_area", {{"light", 0}}}}}});
  document["extensionsUsed"] = {"EXT_lights_area"};
  document["extensions"]["EXT_lights_area"]["lights"] = json::array({light});
  return document;
}

/// Every triangle of the light shines along `direction`, and its corners lie within the box.
void check_place(const Scene& scene, const Light& light, const glm::dvec3& direction,
                 const glm::vec3& low, const glm::vec3& high) {
  for (const std::uint32_t triangle : light.triangles) {
    CHECK(glm::distance(front_of(scene, triangle), direction) < 1e-6);
    for (const glm::vec3& corner : scene.corners(triangle)) {
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(corner[axis] > low[axis] - 1e-5f);
        CHECK(corner[axis] < high[axis] + 1e-5f);
      }
    }
  }
}

SceneLoadOptions panel_option(const std::string& text) {
  SceneLoadOptions options;
  options.panels.push_back(LuminousPanel::parse(text));
  return options;
}

TEST_CASE("photile_area and photile_lumens make an area light of a node, whatever its scale") {
  for (const json& size : {json{1.2, 0.6}, json("1.2x0.6")}) {
    json document = with_extras({{"photile_area", size},
                                 {"photile_lumens", 3000},
                                 {"photile_kelvin", 4000},
                                 {"photile_group", "task"}});
    document["nodes"][1]["scale"] = {7, 8, 9};
    const Scene scene = load_gltf(document);
    REQUIRE(scene.lights.size() == 1);
    const Light& light = scene.lights[0];
    CHECK(light.name == "Area");
    CHECK(light.group == "task");
    CHECK(light.kind == LightKind::area);
    CHECK(light.power == Approx(3000));
    CHECK(light.color.r > 1.2f * light.color.b);
    CHECK_FALSE(light.two_sided);
    CHECK(area_of(scene, light) == Approx(0.72));
    check_place(scene, light, {0, 0, -1}, {-0.1f, 0.2f, 2}, {1.1f, 0.8f, 2});
    CHECK(scene.report.warnings.empty());
  }
}

TEST_CASE("the option --area-light makes one of any node, before its extras") {
  const Scene scene = load_gltf(with_extras({{"photile_area", {3, 3}}, {"photile_lumens", 1}}),
                                panel_option("Area=0.5x0.25,800"));
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].power == Approx(800));
  CHECK(area_of(scene, scene.lights[0]) == Approx(0.125));
  CHECK(scene.report.warnings.empty());
  CHECK(load_gltf(panel_document(json::object()), panel_option("Area=1x1,10"))
            .report.warnings.empty());
}

TEST_CASE("an area light turns with its node") {
  const double half = std::sqrt(0.5);  // a quarter turn about x takes -z to y
  const Scene scene =
      load_gltf(panel_document({{"rotation", {half, 0, 0, half}}}), panel_option("Area=1x2,10"));
  check_place(scene, scene.lights.at(0), {0, 1, 0}, {0, 0.5f, 1}, {1, 0.5f, 3});
}

TEST_CASE("EXT_lights_area gives rectangles and discs their luminance") {
  const Scene rectangle = load_gltf(with_extension(
      {{"type", "rect"}, {"intensity", 500}, {"size", 0.5}, {"rect", {{"aspect", 2}}}}));
  REQUIRE(rectangle.lights.size() == 1);
  CHECK(rectangle.lights[0].power == Approx(500 * pi * 0.5));
  check_place(rectangle, rectangle.lights[0], {0, 0, -1}, {0, 0.25f, 2}, {1, 0.75f, 2});
  CHECK(rectangle.report.warnings.empty());

  const Scene disc = load_gltf(
      with_extension({{"type", "disk"}, {"intensity", 500}, {"size", 2}, {"color", {0, 1, 0}}}));
  CHECK(area_of(disc, disc.lights.at(0)) == Approx(pi));
  CHECK(disc.lights[0].power == Approx(500 * 0.7152 * pi * pi));
  check_place(disc, disc.lights[0], {0, 0, -1}, {-0.502f, -0.502f, 2}, {1.502f, 1.502f, 2});
  CHECK(load_gltf(with_extension({{"type", "rect"}})).lights.at(0).power == Approx(pi));
}

TEST_CASE("photile_lumens of an emissive mesh sets the flux of its lights together") {
  json document = square_document();
  document["nodes"][0]["extras"]["photile_lumens"] = 900;
  CHECK(load_gltf(document).lights.at(0).power == Approx(900));
  document["materials"].push_back(
      {{"name", "neon"},
       {"emissiveFactor", {1, 1, 1}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 50}}}}}});
  auto& primitives = document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  const Scene scene = load_gltf(document);
  CHECK(scene.lights.at(0).power == Approx(600));
  CHECK(scene.lights.at(1).power == Approx(300));
}

}  // namespace
}  // namespace photile::test
