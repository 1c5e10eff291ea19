// Lamps that a user places: where they are, and what their openings send.
#include "loading/luminaires.hpp"

#include <numbers>

#include "message_of.hpp"
#include "photile/photons.hpp"
#include "photile/sensors.hpp"
#include "photometric_texts.hpp"
#include "scene_files.hpp"
#include "statistical_tests.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using std::numbers::pi;

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
  return of_seeds([&](std::uint64_t seed) {
    const auto layers =
        gather_by_paths(scene, std::span(&sensor, 1), {.rays = 4096}, seed).layers.dense();
    return double{layers.layers.at(0).illuminance.at(0)};
  });
}

constexpr const char* one = R"({"file": "lamp.ies", "position": [0.5, 0.5, 2], "aim": [0, 0, -1],
                               "size": [1.2, 0.6], "name": "panel"})";

}  // namespace

TEST_CASE("a lamp below the ceiling hangs beside a hole in its middle") {
  const SceneFolderOnDisk folder;
  // A room of 4 m, 3 m high, whose ceiling leaves out 10 cm around the middle.
  folder.write("room.obj",
               "v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -2 3 -2\nv 2 3 -2\nv 2 3 2\nv -2 3 2\n"
               "v -.05 3 -2\nv -.05 3 2\nv .05 3 -2\nv .05 3 2\n"
               "v -.05 3 -.05\nv .05 3 -.05\nv -.05 3 .05\nv .05 3 .05\n"
               "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
               "f 5 9 10 8\nf 11 6 7 12\nf 9 11 14 13\nf 15 16 12 10\n");
  folder.write("lamp.ies", ies(lambertian));
  SceneLoadOptions options;
  options.luminaires = folder.write(
      "luminaires.json", R"([{"file": "lamp.ies", "position": "ceiling", "size": [0.1, 0.1]}])");
  const Scene scene = load_scene(folder.path / "room.obj", options);
  REQUIRE(scene.lights.size() == 1);
  const glm::dvec3 lamp =
      glm::dvec3(scene.corners(scene.lights[0].triangles.at(0))[0]) + scene.origin;
  CHECK(lamp.y == Approx(3).margin(0.01));
  CHECK(std::max(std::abs(lamp.x), std::abs(lamp.z)) < 0.3);
}

TEST_CASE("lamps below a ceiling are in the middle of the room of a point, else of the largest") {
  const SceneFolderOnDisk folder;
  folder.write("lamp.ies", ies(lambertian));
  std::string rooms;
  for (const auto& [low, high, height] : {std::tuple(0, 6, 3.0), std::tuple(7, 10, 2.6)}) {
    for (const double y : {0.0, height}) {
      rooms += fmt::format("v {0} {2} 0\nv {1} {2} 0\nv {1} {2} 4\nv {0} {2} 4\n", low, high, y);
    }
    rooms += "f -8 -5 -6 -7\nf -4 -3 -2 -1\nf -8 -7 -3 -4\n";
    rooms += "f -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n";
  }
  SceneLoadOptions options;
  options.sun = Sun::parse("180,60,80000");
  Scene scene = load_scene(folder.write("rooms.obj", rooms), options);
  scene.cameras = {Camera::look_at({-5, 1, -5}, {-9, 1, -5}, {0, 1, 0}, 1)};  // that sees neither
  files::Warnings unheard;
  const auto list = loading::LuminaireList::parse(
      R"([{"file": "lamp.ies", "size": [1, 1], "position": "ceiling"},
          {"file": "lamp.ies", "size": [1, 1], "position": "ceiling", "inside": [9, 1, 1]}])",
      "lamps.json");
  const auto placed =
      loading::add_luminaires(list, folder.path / "lamps.json", false, 1, scene, unheard);
  CHECK(glm::distance(placed[0].position + scene.origin, {3, 2.995, 2}) < 1e-3);
  CHECK(glm::distance(placed[1].position + scene.origin, {8.5, 2.595, 2}) < 1e-3);
}

TEST_CASE("a placed lamp has the flux of its file, and its place, aim and size") {
  const SceneFolderOnDisk folder;
  const Scene scene = scene_with(folder, one);
  REQUIRE(scene.lights.size() == 1);
  const Light& lamp = scene.lights[0];
  CHECK(lamp.name == "panel");
  CHECK(lamp.power == Approx(100 * pi).epsilon(1e-3));
  CHECK(!lamp.two_sided);
  for (const std::uint32_t triangle : lamp.triangles) {
    CHECK(front_of(scene, triangle).z == Approx(-1));
    for (const glm::vec3& corner : scene.corners(triangle)) {
      const glm::dvec3 place = glm::dvec3(corner) + scene.origin;
      CHECK(place.z == Approx(2));
      CHECK(std::abs(std::max(std::abs(place.x - 0.5), std::abs(place.y - 0.5)) - 0.6) < 1e-5);
    }
  }
  CHECK(area_of(scene, lamp) == Approx(1.2 * 0.6));
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

TEST_CASE("entries of one circuit share a layer, and a colour temperature tints their light") {
  const SceneFolderOnDisk folder;
  const Scene scene = scene_with(
      folder, R"([{"file": "lamp.ies", "position": [0, 0, 2], "size": [1, 1], "circuit": "C1"},
                  {"file": "lamp.ies", "position": [2, 0, 2], "size": [1, 1], "circuit": "C1",
                   "name": "warm", "kelvin": 2700, "maintenance": 0.7}])");
  const LightGroups layers = light_groups_of(scene);
  REQUIRE(layers.groups.size() == 1);
  CHECK(layers.groups[0].name == "C1");
  CHECK(scene.lights[0].color == glm::vec3(1.0f));
  const glm::vec3 warm = scene.lights[1].color;
  CHECK(luminance(glm::dvec3(warm)) == Approx(1));
  CHECK((warm.r > warm.g && warm.g > warm.b));
  REQUIRE(scene.distributions.size() == 2);
  CHECK(scene.distributions[0].data().maintenance == 0);
  CHECK(scene.distributions[1].data().kelvin == 2700);
  CHECK(scene.distributions[1].data().maintenance == 0.7);
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

TEST_CASE("without a size the opening is the file's, a square of its area where that is round") {
  const SceneFolderOnDisk folder;
  IesText text;
  text.vertical = angles(0, 180, 180);
  text.candela = lambertian;
  const auto [opening, area] = GENERATE(table<const char*, double>(
      {{"0.1 0.1 0", 0.01}, {"-0.4 -0.4 0", pi * 0.04}, {"-0.4 0 0", pi * 0.04}}));
  text.opening = opening;
  folder.write("other.ies", text.str());
  const Scene scene =
      scene_with(folder, R"({"file": "other.ies", "position": [0.5, 0.5, 2], "aim": [0, 0, -1]})");
  CHECK(area_of(scene, scene.lights[0]) == Approx(area));
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
    const std::uint32_t triangle = triangle_of(result.photons.oriented_face[i]);
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
    CHECK_THAT(message_of<InputError>([&] { scene_with(folder, list); }), Contains("outside"));
    CHECK(scene_with(folder, list, lambertian, true).lights.size() == 1);
  }
}

}  // namespace photile::test
