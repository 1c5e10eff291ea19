// Area lights at nodes of a glTF scene: what Blender's exporter drops, and EXT_lights_area.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// A dark square at z = 0, and a node called Area above it.
nlohmann::json panel_document(const nlohmann::json& members) {
  nlohmann::json node = {{"name", "Area"}, {"translation", {0.5, 0.5, 2}}};
  node.update(members);
  return dark_square_and(node);
}

nlohmann::json with_extras(const nlohmann::json& extras) {
  return panel_document({{"extras", extras}});
}

nlohmann::json with_extension(const nlohmann::json& light) {
  nlohmann::json document = panel_document({{"extensions", {{"EXT_lights_area", {{"light", 0}}}}}});
  document["extensionsUsed"] = {"EXT_lights_area"};
  document["extensions"]["EXT_lights_area"]["lights"] = nlohmann::json::array({light});
  return document;
}

double area_of(const Scene& scene, const Light& light) {
  double area = 0;
  for (const std::uint32_t triangle : light.triangles) area += triangle_area(scene, triangle);
  return area;
}

/// Every triangle of the light shines along `direction`, and its corners lie within the box.
void check_place(const Scene& scene, const Light& light, const glm::dvec3& direction,
                 const glm::vec3& low, const glm::vec3& high) {
  for (const std::uint32_t triangle : light.triangles) {
    const glm::dvec3 front = face_normal(scene, oriented(triangle, scene.front_side[triangle]));
    CHECK(glm::distance(front, direction) < 1e-6);
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

}  // namespace

TEST_CASE("photile_area and photile_lumens make an area light of a node, whatever its scale") {
  for (const nlohmann::json& size : {nlohmann::json{1.2, 0.6}, nlohmann::json("1.2x0.6")}) {
    nlohmann::json document = with_extras({{"photile_area", size},
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
  CHECK(load_gltf(panel_document(nlohmann::json::object()), panel_option("Area=1x1,10"))
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
  nlohmann::json document = square_document();
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

}  // namespace photile::test
