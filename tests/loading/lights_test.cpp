// Lights that a user adds, groups, tints and limits.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "message_of.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"
#include "photile/photons.hpp"
#include "photile/sensors.hpp"
#include "photometric_texts.hpp"
#include "scene/light_emission.hpp"
#include "scene_files.hpp"
#include "statistical_tests.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using scene::chromaticity_of_temperature;
using scene::color_of_temperature;
using std::numbers::pi;

// Lamps that a user places: where they are, and what their openings send.

/// A Lambertian lamp of 100 cd downwards, or one that shines as `candela` says.
std::string ies(const std::function<double(double, double)>& candela) {
  IesText text;
  text.vertical = angles(0, 180, 180);
  text.candela = candela;
  return text.str();
}
double lambertian(double, double gamma) {
  return gamma < 90 ? 100 * std::cos(gamma * pi / 180) : 0.0;
}

/// The dark unit square at z = 0 of square_document, under lamps that shine along -z.
Scene scene_with(const SceneFolderOnDisk& folder, const std::string& luminaires,
                 const std::function<double(double, double)>& candela = lambertian,
                 bool allow_outside = false) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  folder.write("lamp.ies", ies(candela));
  SceneLoadOptions options;
  options.luminaires = folder.write("luminaires.json", luminaires);
  options.allow_outside = allow_outside;
  return load_gltf(document, options);
}

/// lux for each lumen, of 16 seeds.
std::vector<double> lux_at(const Scene& scene, const Sensor& sensor) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto layers =
        gather_by_paths(scene, std::span(&sensor, 1), {.rays = 4096}, seed).layers.dense();
    values.push_back(double{layers.layers.at(0).illuminance.at(0)});
  }
  return values;
}

constexpr const char* one = R"({"file": "lamp.ies", "position": [0.5, 0.5, 2], "aim": [0, 0, -1],
                               "size": [1.2, 0.6], "name": "panel"})";

TEST_CASE("a placed lamp has the flux of its file, and its place, aim and size") {
  const SceneFolderOnDisk folder;
  const Scene scene = scene_with(folder, one);
  REQUIRE(scene.lights.size() == 1);
  const Light& lamp = scene.lights[0];
  CHECK(lamp.name == "panel");
  CHECK(lamp.power == Approx(100 * pi).epsilon(1e-3));
  CHECK(!lamp.two_sided);
  double area = 0;
  for (const std::uint32_t triangle : lamp.triangles) {
    area += triangle_area(scene, triangle);
    CHECK(sided_normal(scene, sided(triangle, scene.front_side[triangle])).z == Approx(-1));
    for (const glm::vec3& corner : scene.corners(triangle)) {
      const glm::dvec3 place = glm::dvec3(corner) + scene.origin;
      CHECK(place.z == Approx(2));
      CHECK(std::abs(std::max(std::abs(place.x - 0.5), std::abs(place.y - 0.5)) - 0.6) < 1e-5);
    }
  }
  CHECK(area == Approx(1.2 * 0.6));
}

TEST_CASE("an array is spaced around its middle and shares a layer") {
  const SceneFolderOnDisk folder;
  const Scene scene = scene_with(
      folder, R"({"file": "lamp.ies", "position": [1, 0, 3], "aim": [0, 0, -1], "size": [0.1, 0.1],
                  "count": [3, 2], "spacing": [1.5, 2], "lumens": 1000, "name": "row"})");
  REQUIRE(scene.lights.size() == 6);
  glm::dvec3 middle(0.0);
  for (const Light& lamp : scene.lights) {
    CHECK(lamp.group == "row");
    CHECK(lamp.power == 1000);
    const auto corners = scene.corners(lamp.triangles.front());
    middle += (glm::dvec3(corners[0]) + glm::dvec3(corners[1]) + glm::dvec3(corners[2])) / 18.0;
  }
  CHECK(glm::distance(middle + scene.origin, glm::dvec3(1, 0, 3)) < 0.1);
}

TEST_CASE("however many entries name a file, its intensities are there once") {
  const SceneFolderOnDisk folder;
  std::string list = one;
  for (int i = 0; i < 999; ++i) list += std::string(",") + one;
  const Scene scene = scene_with(folder, "[" + list + "]");
  CHECK(scene.lights.size() == 1000);
  CHECK(scene.distributions.size() == 1);
}

TEST_CASE("an opening of cosine intensities is a Lambertian rectangle") {
  const SceneFolderOnDisk folder;
  const Scene scene = scene_with(folder, one);
  const glm::dvec3 at(0.1, 0.4, 1.5), normal = glm::normalize(glm::dvec3(0.2, 0.1, 1));
  // 1 lm over A and pi: E = pi L F = F / A.
  const glm::dvec3 x(scene.lights[0].x_axis), y = glm::cross(glm::dvec3(0, 0, 1), x);
  const glm::dvec3 corner = glm::dvec3(0.5, 0.5, 2) - 0.6 * x - 0.3 * y;
  const double truth =
      validation::rectangle_factor(at, normal, corner, 1.2 * x, 0.6 * y) / (1.2 * 0.6);
  CHECK_VERDICT(mean_is(lux_at(scene, {at - scene.origin, normal}), truth, 0.03 * truth));
}

TEST_CASE("without a size the opening is the file's") {
  const SceneFolderOnDisk folder;
  const Scene scene =
      scene_with(folder, R"({"file": "lamp.ies", "position": [0.5, 0.5, 2], "aim": [0, 0, -1]})");
  double area = 0;
  for (const std::uint32_t triangle : scene.lights[0].triangles) {
    const auto corners = scene.corners(triangle);
    area +=
        0.5 * glm::length(glm::dvec3(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
  }
  CHECK(area == Approx(0.1 * 0.1));  // IesText's
}

TEST_CASE("a round opening without a size is a square of its area") {
  const SceneFolderOnDisk folder;
  IesText text;
  text.vertical = angles(0, 180, 180);
  text.candela = lambertian;
  text.opening = GENERATE("-0.4 -0.4 0", "-0.4 0 0");
  folder.write("round.ies", text.str());
  const Scene scene =
      scene_with(folder, R"({"file": "round.ies", "position": [0.5, 0.5, 2], "aim": [0, 0, -1]})");
  double area = 0;
  for (const std::uint32_t triangle : scene.lights[0].triangles) {
    area += triangle_area(scene, triangle);
  }
  CHECK(area == Approx(pi * 0.2 * 0.2));
}

TEST_CASE("a small opening is the point of its intensities") {
  const SceneFolderOnDisk folder;
  const auto narrow = [](double, double gamma) {
    return gamma < 90 ? std::pow(std::cos(gamma * pi / 180), 4) : 0.0;
  };
  const Scene scene = scene_with(folder, R"({"file": "lamp.ies", "position": [0.5, 0.5, 3],
                                            "aim": [0, 0, -1], "size": [0.02, 0.02]})",
                                 narrow);
  const glm::dvec3 at(1.5, 0.5, 1);
  const double d2 = 1 + 4, cosine = 2 / std::sqrt(d2);
  const double flux = 2 * pi / 5;  // of cos^4
  const double truth = std::pow(cosine, 4) / flux * cosine / d2;
  CHECK_VERDICT(mean_is(lux_at(scene, {at - scene.origin, {0, 0, 1}}), truth, 0.02 * truth));
}

TEST_CASE("photons of an opening follow its intensities, uplight leaves its back") {
  const SceneFolderOnDisk folder;
  const auto both = [](double, double gamma) {
    const double cosine = std::cos(gamma * pi / 180);
    return cosine > 0 ? 3 * cosine : -cosine;  // three quarters downwards
  };
  Scene scene = scene_with(folder, R"({"file": "lamp.ies", "position": [0.5, 0.5, 0.01],
                                      "aim": [0, 0, -1], "size": [0.2, 0.2]})",
                           both);
  CHECK(scene.lights[0].two_sided);
  const auto result = trace_photons(RayScene(scene), {.emitted_photons = 100'000, .seed = 3});
  double down = 0;
  for (std::size_t i = 0; i < result.photons.size(); ++i) {
    const std::uint32_t triangle = triangle_of(result.photons.sided_triangle[i]);
    if (scene.triangle_light[triangle] == none)
      down += luminance(glm::dvec3(result.photons.flux[i]));
  }
  // The square is large and near: all that goes down falls on it.
  CHECK(down == Approx(0.75).margin(0.01));
}

TEST_CASE("photometric files outside the list's folder are read where that is allowed") {
  const SceneFolderOnDisk folder, elsewhere;
  const std::string lamp = elsewhere.write("lamp.ies", ies(lambertian));
  for (const std::string& name :
       {lamp,
        "../" + std::filesystem::path(lamp).parent_path().filename().string() + "/lamp.ies"}) {
    const std::string list =
        R"([{"file": ")" + name + R"(", "position": [0.5, 0.5, 2], "size": [1, 1]}])";
    CHECK_THAT(message_of<InputError>([&] { scene_with(folder, list); }),
               Catch::Contains("outside"));
    CHECK(scene_with(folder, list, lambertian, true).lights.size() == 1);
  }
}

TEST_CASE("what is wrong with a placed lamp is told in a line") {
  const SceneFolderOnDisk folder;
  const auto error_of = [&](const std::string& text) {
    std::string message = message_of<InputError>([&] { scene_with(folder, text); });
    CHECK_THAT(message, Catch::Contains("luminaires.json"));
    return message;
  };
  using Catch::Contains;
  CHECK_THAT(error_of("{"), Contains("JSON"));
  CHECK_THAT(error_of("[]"), Contains("no luminaire"));
  CHECK_THAT(error_of(R"({"file": "gone.ies", "position": [0,0,1], "size": [1,1]})"),
             Contains("gone.ies"));
  CHECK_THAT(error_of(R"({"file": "lamp.ies", "size": [1,1]})"), Contains("position"));
  CHECK_THAT(error_of(R"({"file": "lamp.ies", "position": [0,0,1], "size": [1]})"),
             Contains("size"));
  CHECK_THAT(
      error_of(R"({"file": "lamp.ies", "position": [0,0,1], "size": [1,1], "aim": [0,0,0]})"),
      Contains("aim"));
  CHECK_THAT(
      error_of(R"({"file": "lamp.ies", "position": [0,0,1], "size": [1,1], "count": [2,2]})"),
      Contains("spacing"));
  CHECK_THAT(
      error_of(
          R"({"file": "lamp.ies", "position": [0,0,1], "size": [1,1], "count": [2.5,2], "spacing": [1,1]})"),
      Contains("count"));
  CHECK_THAT(error_of(R"({"file": "lamp.ies", "position": [0,0,1], "size": [1,1], "colour": 1})"),
             Contains("colour"));
}

// Which lights share a layer: the file's groups and those that the user asks for.

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

std::string usage_error_of(const std::vector<std::string>& texts) {
  return message_of<UsageError>([&] { grouped(texts, three_lamps()); });
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
  CHECK(groups.share[2] == Approx(4 * groups.share[0]));  // by area
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

TEST_CASE("a glob that matches no light is an error that lists the lights") {
  const std::string message = usage_error_of({"lamp*=lamps"});
  for (const char* part : {"lamp*", "'hall_1'", "'hall_2'", "'desk'"}) {
    CHECK(message.find(part) != std::string::npos);
  }
}

TEST_CASE("a group does not take the name of a light outside it") {
  CHECK(usage_error_of({"hall_*=desk"}).find("'desk'") != std::string::npos);
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

TEST_CASE("a grouping that is no GLOB=NAME is refused") {
  for (const char* text : {"", "hall", "=hall", "hall="}) {
    CHECK_THROWS_AS(LightGrouping::parse(text), UsageError);
  }
  CHECK(LightGrouping::parse("a=b=c").glob == "a=b");
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
  CHECK(layers.share[0] == Approx(0.25));
  CHECK(layers.share[1] == Approx(0.75));
  CHECK(layers.share[2] == 1.0);
  CHECK(needs_of(scene).light_count == 2);
}

TEST_CASE("lights of a group that is off share it equally") {
  Scene scene = grouped({"*=all"}, three_lamps());
  for (Light& light : scene.lights) light.power = 0;
  for (const double share : light_groups_of(scene).share) CHECK(share == Approx(1.0 / 3));
}

// Colours of light by temperature, against published chromaticities.

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
  CHECK_THROWS_WITH(load_gltf(document, options), Catch::Contains("there is 'panel'"));
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

}  // namespace
}  // namespace photile::test
