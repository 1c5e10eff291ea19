// Which lights share a layer: the file's groups and those that the user asks for.
#include <catch2/catch.hpp>
#include <tuple>

#include "flat_picture.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"
#include "scene/light_emission.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

/// Point lights of 10, 30 and 60 lm at nodes of the given names, in the square without emission.
nlohmann::json three_lamps(const std::vector<std::string>& names = {"hall_1", "hall_2", "desk"}) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  auto& lights = document["extensions"]["KHR_lights_punctual"]["lights"];
  const std::vector<double> lumens{10, 30, 60};
  for (std::size_t i = 0; i < 3; ++i) {
    lights.push_back({{"type", "point"}, {"intensity", lumens[i] / (4 * 3.14159265358979)}});
    document["nodes"].push_back(
        {{"name", names[i]}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    document["scenes"][0]["nodes"].push_back(i + 1);
  }
  return document;
}

Scene grouped(const std::vector<std::string>& texts, const nlohmann::json& document) {
  SceneLoadOptions options;
  for (const std::string& text : texts) {
    options.light_groups.push_back(LightGrouping::parse(text));
  }
  return load_gltf(document, options);
}

std::vector<std::string> groups_of(const Scene& scene) {
  std::vector<std::string> groups;
  for (const Light& light : scene.lights) groups.push_back(light.group);
  return groups;
}

using Names = std::vector<std::string>;

TEST_CASE("photile_group among the extras of a node or of a light puts the light into a group") {
  nlohmann::json document = three_lamps();
  document["nodes"][1]["extras"]["photile_group"] = "hall";
  document["extensions"]["KHR_lights_punctual"]["lights"][1]["extras"]["photile_group"] = "hall";
  CHECK(groups_of(load_gltf(document)) == Names{"hall", "hall", ""});
  // The node speaks of this lamp, the light of all like it.
  document["nodes"][2]["extras"]["photile_group"] = "stairs";
  CHECK(groups_of(load_gltf(document)) == Names{"hall", "stairs", ""});
  document["nodes"][3]["extras"]["photile_group"] = 5;  // no name
  CHECK(groups_of(load_gltf(document)) == Names{"hall", "stairs", ""});
}

TEST_CASE("photile_group of a node with an emissive mesh is that of its area lights") {
  nlohmann::json document = square_document();
  document["nodes"][0]["extras"]["photile_group"] = "ceiling.1";
  CHECK(groups_of(load_gltf(document)) == Names{"ceiling_1"});  // cleaned as names are
}

TEST_CASE("nodes that place one lamp of the file share a layer") {
  nlohmann::json document = three_lamps();
  document["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Scene scene = load_gltf(document);
  CHECK(groups_of(scene) == Names{"hall_1", "hall_1", ""});
  const LightGroups groups = light_groups_of(scene);
  REQUIRE(groups.groups.size() == 2);
  CHECK(groups.groups[0].power == Approx(20.0));
  // Who says otherwise is believed.
  CHECK(groups_of(grouped({"hall_2=other"}, document)) == Names{"hall_1", "other", ""});
  document["nodes"][2]["extras"]["photile_group"] = "stairs";
  CHECK(groups_of(load_gltf(document)) == Names{"", "stairs", ""});
}

TEST_CASE("layers of two lamps that are placed several times keep apart, whatever their names") {
  nlohmann::json document = three_lamps({"lamp", "lamp", "lamp"});
  document["nodes"].push_back(document["nodes"][3]);
  document["scenes"][0]["nodes"].push_back(4);
  document["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  CHECK(groups_of(load_gltf(document)) == Names{"lamp", "lamp", "lamp_2", "lamp_2"});
}

TEST_CASE("instances of an emissive mesh share a layer, its materials do not") {
  nlohmann::json document = square_document();
  document["materials"].push_back({{"name", "neon"}, {"emissiveFactor", {0, 1, 0}}});
  auto& primitives = document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  document["nodes"].push_back(
      {{"name", "second"}, {"mesh", 0}, {"translation", {0, 0, 3}}, {"scale", {2, 2, 2}}});
  document["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load_gltf(document);
  REQUIRE(scene.lights.size() == 4);
  CHECK(groups_of(scene) == Names{"panel_glow", "panel_neon", "panel_glow", "panel_neon"});
  const LightGroups groups = light_groups_of(scene);
  CHECK(groups.fraction[2] == Approx(4 * groups.fraction[0]));  // by area
}

TEST_CASE("a glob of light names makes a group, and a later one takes from an earlier one") {
  const auto document = three_lamps();
  CHECK(groups_of(grouped({"hall_*=hall"}, document)) == Names{"hall", "hall", ""});
  CHECK(groups_of(grouped({"*=all", "desk=task"}, document)) == Names{"all", "all", "task"});
  CHECK(groups_of(grouped({"?all_[12]=a b"}, document)) == Names{"a_b", "a_b", ""});
  auto with_extras = document;
  with_extras["nodes"][1]["extras"]["photile_group"] = "file";
  CHECK(groups_of(grouped({"desk=task"}, with_extras)) == Names{"file", "", "task"});
  CHECK(groups_of(grouped({"hall_1=task"}, with_extras)) == Names{"task", "", ""});
}

TEST_CASE("a group does not take the name of a light outside it") {
  CHECK_NOTHROW(grouped({"*=desk"}, three_lamps()));
  CHECK_NOTHROW(
      grouped({"hall_1=desk", "desk=hall_1"}, three_lamps()));  // no light has a layer of its own
  // In a file, the light gives way.
  nlohmann::json document = three_lamps();
  document["nodes"][1]["extras"]["photile_group"] = "desk";
  const Scene scene = load_gltf(document);
  CHECK(scene.lights[0].group == "desk");
  CHECK(scene.lights[2].name == "desk_2");
}

TEST_CASE("a layer has the power and the mean colour of its lights, and each its share") {
  Scene scene = grouped({"hall_*=hall"}, three_lamps());
  scene.lights[0].color = {4, 0, 0};
  scene.lights[1].color = {0, 4, 8};
  const LightGroups layers = light_groups_of(scene);
  REQUIRE(layers.groups.size() == 2);
  CHECK(layers.groups[0].name == "hall");
  CHECK(layers.groups[0].lights == std::vector<std::uint32_t>{0, 1});
  CHECK(layers.groups[0].power == Approx(40));
  CHECK(layers.groups[0].color.r == Approx(1));
  CHECK(layers.groups[0].color.g == Approx(3));
  CHECK(layers.groups[0].color.b == Approx(6));
  CHECK(layers.groups[1].name == "desk");
  CHECK(layers.groups[1].power == scene.lights[2].power);
  CHECK(layers.groups[1].color == scene.lights[2].color);
  CHECK(layers.group_of == std::vector<std::uint32_t>{0, 0, 1});
  CHECK(layers.fraction[0] == Approx(0.25));
  CHECK(layers.fraction[1] == Approx(0.75));
  CHECK(layers.fraction[2] == 1.0);
  CHECK(needs_of(scene).light_count == 2);
}

TEST_CASE("lights of a group that is off share it equally") {
  Scene scene = grouped({"*=all"}, three_lamps());
  for (Light& light : scene.lights) light.power = 0;
  for (const double fraction : light_groups_of(scene).fraction) CHECK(fraction == Approx(1.0 / 3));
}

// Colours of light by temperature, against published chromaticities, and the greatest power.

using Catch::Contains;
using scene::chromaticity_of_temperature;
using scene::color_of_temperature;

TEST_CASE("chromaticities are those that are published") {
  // CIE standard illuminants A, D55, D65 and D75; the Planckian locus of Wyszecki and Stiles.
  for (const auto& [kelvin, x, y] :
       {std::tuple{2855.5, 0.44758, 0.40745}, std::tuple{5503.0, 0.33243, 0.34744},
        std::tuple{6504.0, 0.31272, 0.32903}, std::tuple{7504.0, 0.29903, 0.31488},
        std::tuple{2000.0, 0.52669, 0.41331}, std::tuple{3000.0, 0.43693, 0.40407},
        std::tuple{4000.0, 0.38045, 0.37675}}) {
    const glm::dvec2 found = chromaticity_of_temperature(kelvin);
    CAPTURE(kelvin);
    CHECK(found.x == Approx(x).margin(4e-4));
    CHECK(found.y == Approx(y).margin(4e-4));
  }
}

TEST_CASE("6504 K is white, 2700 K is warm, and luminances are 1") {
  const glm::dvec3 white = color_of_temperature(6504);
  CHECK(white.r == Approx(1).margin(0.005));
  CHECK(white.g == Approx(1).margin(0.005));
  CHECK(white.b == Approx(1).margin(0.005));
  double before = 1e9;
  for (double kelvin = 1000; kelvin <= 40'000; kelvin *= 1.05) {
    const glm::dvec3 color = color_of_temperature(kelvin);
    CHECK(luminance(color) == Approx(1));
    CHECK(color.b >= 0);
    CHECK(color.r < before);  // bluer and bluer
    before = color.r;
  }
}

TEST_CASE("photile_kelvin and the option of the library colour a light and keep its flux") {
  nlohmann::json document = square_document();
  document["nodes"][0]["extras"]["photile_kelvin"] = 2700;
  const Scene warm = load_gltf(document);
  const Scene plain = load_gltf(square_document());
  CHECK(glm::distance(warm.lights.at(0).color, glm::vec3(color_of_temperature(2700))) < 1e-6f);
  CHECK(warm.lights[0].power == plain.lights.at(0).power);
  SceneLoadOptions options;
  options.temperatures.push_back(LightTemperature::parse("panel=4000K"));
  const Scene changed = load_gltf(document, options);
  CHECK(glm::distance(changed.lights.at(0).color, glm::vec3(color_of_temperature(4000))) < 1e-6f);

  options.temperatures = {LightTemperature::parse("lamp=4000")};
  CHECK_THROWS_WITH(load_gltf(document, options), Contains("there is 'panel'"));
  document["nodes"][0]["extras"]["photile_kelvin"] = 5;
  CHECK(warns(load_gltf(document), {"'panel'", "photile_kelvin"}));
}

TEST_CASE("texts of temperatures are checked") {
  CHECK(LightTemperature::parse("a=b=2700K").light == "a=b");
  CHECK(LightTemperature::parse("lamp=2700").kelvin == 2700);
  for (const char* text : {"", "lamp", "lamp=", "=2700", "lamp=warm", "lamp=999", "lamp=40001",
                           "lamp=2700KK", "lamp=nan"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(LightTemperature::parse(text), UsageError);
  }
}

// Lights of more power than floats can carry are refused by name, when they are loaded or changed.

const std::string lit_square = unit_square + "o panel\nusemtl lamp\nf 1 2 3 4\n";

std::string mtl_with(const std::string& emission) {
  return "newmtl lamp\nKd 0 0 0\nKe " + emission + "\n";
}

std::string refusal_of(const std::string& emission, const SceneLoadOptions& options = {}) {
  return input_error_of([&] { load_obj(lit_square, mtl_with(emission), options); });
}

TEST_CASE(
    "an environment beyond floats is refused by its file, one of too much power by its light") {
  const SceneFolderOnDisk folder;
  write_exr(folder.path / "sky.exr", flat_picture(4, 2, 3e38f));
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

}  // namespace
}  // namespace photile::test
