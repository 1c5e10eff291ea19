// Lights of glTF files.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "photile/layered_picture.hpp"
#include "photometric_texts.hpp"
#include "scene_files.hpp"
#include "srgb_oracle.hpp"
#include "textured_square.hpp"
#include "writing/edited_scene.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// The square without emission, lit by one punctual light at a node.
nlohmann::json lit_by(const nlohmann::json& light, const nlohmann::json& node_members = {}) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({light});
  nlohmann::json node = {{"name", "lamp"}, {"translation", {0, 0, 2}}};
  if (node_members.is_object()) node.update(node_members);
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  document["nodes"].push_back(node);
  document["scenes"][0]["nodes"] = {0, 1};
  return document;
}

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

TEST_CASE("black lights are dropped with a warning") {
  nlohmann::json document = square_document();
  document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 0}}};
  document["nodes"].push_back(
      {{"name", "dead"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  document["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load_gltf(document);
  CHECK(scene.lights.size() == 1);
  CHECK(warns(scene, {"'dead'", "dropped"}));
}

TEST_CASE("an area light that Blender's exporter lost is named") {
  nlohmann::json document = square_document();
  document["nodes"].push_back({{"name", "Area.001"}});
  document["scenes"][0]["nodes"] = {0, 1};
  CHECK(warns(load_gltf(document), {"'Area.001'", "area lights"}));
  // Without any other light it is named in the error.
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  const std::string error = input_error_of([&] { load_gltf(document); });
  CHECK(error.find("no lights") != std::string::npos);
  CHECK(error.find("'Area.001'") != std::string::npos);
}

TEST_CASE("emissive materials of a Blender export are noted unless they are scaled") {
  nlohmann::json document = square_document();
  document["asset"]["generator"] = "Khronos glTF Blender I/O v4.2.60";
  CHECK(warns(load_gltf(document), {"'glow'", "emissive scale of 683"}));
  SceneLoadOptions scaled;
  scaled.emissive_scale = 683.0f;
  const Scene scene = load_gltf(document, scaled);
  CHECK_FALSE(warns(scene, {"emissive scale"}));
  CHECK(scene.lights[0].power == Approx(68'300.0 * pi));
}

// Area lights at nodes of a glTF scene: what Blender's exporter drops, and EXT_lights_area.

/// A dark square at z = 0, and a node called Area above it.
nlohmann::json panel_document(const nlohmann::json& members) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  nlohmann::json node = {{"name", "Area"}, {"translation", {0.5, 0.5, 2}}};
  node.update(members);
  document["nodes"].push_back(node);
  document["scenes"][0]["nodes"] = {0, 1};
  return document;
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
    const glm::dvec3 front = sided_normal(scene, sided(triangle, scene.front_side[triangle]));
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
  CHECK_THROWS_WITH(
      load_gltf(panel_document(nlohmann::json::object()), panel_option("Aria=1x1,10")),
      Catch::Contains("there is no node 'Aria'; there are 'panel', 'Area'"));
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

TEST_CASE("an area light that cannot shine is named") {
  const nlohmann::json lit = square_document();  // so that there is a light
  const auto warned = [&](nlohmann::json document, const char* words) {
    document["materials"] = lit["materials"];
    return warns(load_gltf(document), {"'Area'", words});
  };
  for (const nlohmann::json& extras :
       {nlohmann::json{{"photile_area", {1, 1}}},
        nlohmann::json{{"photile_area", {1, 0}}, {"photile_lumens", 10}},
        nlohmann::json{{"photile_area", {1, 1}}, {"photile_lumens", -10}},
        nlohmann::json{{"photile_area", "wide"}, {"photile_lumens", 10}},
        nlohmann::json{{"photile_area", "1xwide"}, {"photile_lumens", 10}}}) {
    CAPTURE(extras.dump());
    CHECK(warned(with_extras(extras), "photile_area"));
  }
  CHECK(warned(with_extension({{"type", "sphere"}}), "'sphere'"));
  CHECK(warned(with_extension({{"type", "rect"}, {"size", 0}}), "no size"));
  CHECK(warned(with_extension({{"type", "rect"}, {"intensity", 0}}), "no size, no light"));
  CHECK(warned(panel_document(nlohmann::json::object()), "luminous panel"));
  nlohmann::json missing = with_extension({{"type", "rect"}});
  missing["nodes"][1]["extensions"]["EXT_lights_area"]["light"] = 3;
  CHECK_THAT(input_error_of([&] { load_gltf(missing); }), Catch::Contains("there is no light 3"));
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

TEST_CASE("texts of area lights are checked") {
  CHECK(LuminousPanel::parse("a=b=1.5x2,30").node == "a=b");
  for (const char* text : {"", "Area", "Area=", "=1x1,1", "Area=1,1", "Area=1x1", "Area=1x1,0",
                           "Area=0x1,1", "Area=1x-1,1", "Area=1x1,1,1", "Area=1x1,1lm"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(LuminousPanel::parse(text), UsageError);
  }
}

// Photometric files at the lights of a glTF scene.

/// An even lamp of 100 cd: 400 pi lm.
const std::string even_lamp = IesText().str();

/// A dark square and a node called lamp with the given members.
nlohmann::json document_with(const nlohmann::json& node) {
  nlohmann::json document = square_document();
  document["materials"][0]["emissiveFactor"] = {0, 0, 0};
  nlohmann::json lamp = {{"name", "lamp"}, {"translation", {0, 0, 2}}};
  lamp.update(node);
  document["nodes"].push_back(lamp);
  document["scenes"][0]["nodes"] = {0, 1};
  return document;
}

nlohmann::json with_profiles(nlohmann::json document, const nlohmann::json& lights) {
  document["extensionsUsed"] = {"EXT_lights_ies"};
  document["extensions"]["EXT_lights_ies"]["lights"] = lights;
  return document;
}

nlohmann::json node_of_profile(nlohmann::json members = nlohmann::json::object()) {
  members["light"] = 0;
  return {{"extensions", {{"EXT_lights_ies", members}}}};
}

nlohmann::json point_light_node(nlohmann::json& document) {
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
  Scene load(const nlohmann::json& document, const SceneLoadOptions& options = {}) const {
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
  const nlohmann::json document = document_with(node_of_profile());
  for (const char* type : {"application/x-ies-lm-63", "application/octet-stream"}) {
    const std::string uri = std::string("data:") + type + ";base64," + base64(even_lamp);
    CHECK(Folder().load(with_profiles(document, {{{"uri", uri}}})).lights.at(0).power ==
          Approx(400 * pi));
  }
  const Folder folder;
  folder.write("buffer.bin", even_lamp);
  nlohmann::json viewed =
      with_profiles(document, {{{"bufferView", 4}, {"mimeType", "application/x-ies-lm-63"}}});
  viewed["buffers"].push_back({{"uri", "buffer.bin"}, {"byteLength", even_lamp.size()}});
  viewed["bufferViews"].push_back({{"buffer", 1}, {"byteLength", even_lamp.size()}});
  CHECK(folder.load(viewed).lights.at(0).power == Approx(400 * pi));
}

TEST_CASE("multiplier and colour change the flux; nodes share a file that is read once") {
  nlohmann::json document =
      document_with(node_of_profile({{"multiplier", 0.5}, {"color", {1, 0, 0}}}));
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
  nlohmann::json node = node_of_profile();
  node["rotation"] = {-half, 0, 0, half};
  node["scale"] = {3, 2, 1};
  const Scene scene = Folder().load(with_profiles(document_with(node), {{{"uri", "lamp.ies"}}}));
  CHECK(glm::distance(scene.lights.at(0).direction, glm::vec3(0, -1, 0)) < 1e-6f);
  CHECK(glm::distance(scene.lights.at(0).x_axis, glm::vec3(1, 0, 0)) < 1e-6f);
}

TEST_CASE("photile_ies gives a light its file, with the light's colour") {
  nlohmann::json document = document_with(nlohmann::json::object());
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
  nlohmann::json document = document_with(nlohmann::json::object());
  document["nodes"][1]["extensions"] = point_light_node(document);
  document["nodes"][1]["extras"]["photile_lumens"] = 800;
  CHECK(Folder().load(document).lights.at(0).power == 800);
  document["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "directional";
  CHECK(warns(Folder().load(document), {"'lamp'", "photile_lumens"}));
}

TEST_CASE("a profile that is missing, outside or malformed is an error that names it") {
  const Folder folder;
  const auto error_of = [&](const nlohmann::json& lights) {
    return input_error_of(
        [&] { folder.load(with_profiles(document_with(node_of_profile()), lights)); });
  };
  CHECK_THAT(error_of({{{"uri", "gone.ies"}}}), Catch::Contains("'gone.ies'"));
  CHECK_THAT(error_of({{{"uri", "../lamp.ies"}}}), Catch::Contains("outside"));
  CHECK_THAT(error_of({{{"uri", "data:text/plain,none"}}}), Catch::Contains("base64"));
  CHECK_THAT(error_of({{{"bufferView", 99}}}), Catch::Contains("light 0 of EXT_lights_ies"));
  CHECK_THAT(error_of(nlohmann::json::array()), Catch::Contains("there is no light 0"));
  folder.write("bad.ies", even_lamp.substr(0, even_lamp.size() - 12));
  CHECK_THAT(error_of({{{"uri", "bad.ies"}}}),
             Catch::Contains("'bad.ies'") && Catch::Contains("ends before"));
}

TEST_CASE("the option --ies gives a point or spot light a file") {
  const Folder folder;
  nlohmann::json document = document_with(nlohmann::json::object());
  document["nodes"][1]["extensions"] = point_light_node(document);
  const auto option = [&](const std::string& text) {
    SceneLoadOptions options;
    options.profiles.push_back(LightProfile::parse(text));
    return options;
  };
  folder.write("lamp.ldt", EulumdatText().str());
  const std::string path = folder.path.string();
  const Scene scene = folder.load(document, option("lamp=" + path + "/lamp.ies"));
  CHECK(scene.lights.at(0).kind == LightKind::point);
  CHECK(scene.lights.at(0).power == Approx(400 * pi));
  CHECK(folder.load(document, option("lamp=" + path + "/lamp.ldt")).lights.at(0).power ==
        Approx(50 * 2 * 4 * pi));

  CHECK_THROWS_WITH(folder.load(document, option("lump=x.ies")),
                    Catch::Contains("there is no light 'lump'; there is 'lamp'"));
  CHECK_THROWS_WITH(folder.load(document, option("lamp=gone.ies")), Catch::Contains("gone.ies"));
  CHECK_THROWS_AS(folder.load(document, option("lamp=" + path)), InputError);
  CHECK_THROWS_AS(option("lamp"), UsageError);
  CHECK_THROWS_AS(option("=lamp.ies"), UsageError);
  nlohmann::json panel = square_document();
  CHECK_THROWS_WITH(folder.load(panel, option("panel=" + path + "/lamp.ies")),
                    Catch::Contains("neither a point nor a spot"));
}

// EXT_lights_image_based: cube maps in PNGs, plain and RGBD, that surround a glTF scene.

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
  for (const json& broken : {json{0, 0, 0, 0}, json{1, 2}, json("x"), json{"a", 0, 0, 1}}) {
    six.light()["rotation"] = broken;
    CHECK(radiance({1, 0, 0}) == glm::vec3(1, 0, 0));
  }
}

TEST_CASE("pictures in buffers surround the scene as well") {
  ImageBasedScene six(std::vector<Texel>(6, {255, 255, 255}));
  std::ifstream png(six.folder.path / "face0.png", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(png)), {});
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
  const auto warning_of = [&](const ImageBasedScene& six) {
    const Scene scene = six.load(options);
    CHECK(scene.lights.size() == 1);
    REQUIRE(scene.report.warnings.size() == 1);
    CHECK_THAT(scene.report.warnings[0],
               Catch::Contains("EXT_lights_image_based") && Catch::Contains("environment picture"));
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

}  // namespace
}  // namespace photile::test
