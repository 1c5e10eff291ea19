// Materials of glTF files, and reflectances of any.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <tuple>

#include "photile/sensors.hpp"
#include "scene/surface_models.hpp"
#include "scene_files.hpp"
#include "srgb_oracle.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

/// The square's material with `members` merged in, and what the import warned about.
Material material(const json& members, Scene* report = nullptr) {
  json document = square_document();
  document["materials"][0].merge_patch(members);
  Scene scene = load_gltf(document);
  const Material result = scene.materials[scene.triangle_material[0]];
  if (report != nullptr) *report = std::move(scene);
  return result;
}

json factors(double metallic, double roughness) {
  return {{"pbrMetallicRoughness", {{"metallicFactor", metallic}, {"roughnessFactor", roughness}}}};
}

void check_rgb(const glm::vec3& actual, const glm::dvec3& expected) {
  CHECK(glm::length(glm::dvec3(actual) - expected) < 1e-6);
}

TEST_CASE("a glTF dielectric is its base colour under an F0 of 0.04, a metal reflects its own") {
  const json white{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}};
  using Row = std::tuple<json, glm::dvec3, glm::dvec3>;
  for (const auto& [members, diffuse, specular] :
       {Row{json::object(), {0.8, 0.6, 0.4}, {0.04, 0.04, 0.04}},
        Row{white, {1, 1, 1}, {0.04, 0.04, 0.04}},
        Row{factors(1.0, 0.5), {0, 0, 0}, {0.8, 0.6, 0.4}},
        Row{factors(0.5, 0.5), {0.4, 0.3, 0.2}, {0.42, 0.32, 0.22}}}) {  // mixed linearly
    const Material m = material(members);
    CAPTURE(members);
    CHECK(m.interaction == Interaction::opaque);
    check_rgb(m.diffuse, diffuse);
    check_rgb(m.specular, specular);
    CHECK(m.roughness == Approx(0.25));  // alpha is roughness^2
    CHECK(m.glossy());
  }
}

TEST_CASE("a smooth glTF metal is a mirror, a smooth dielectric keeps the smallest alpha") {
  const Material mirror = material(factors(1.0, 0.05));
  CHECK(mirror.interaction == Interaction::mirror);
  check_rgb(mirror.specular, {0.8, 0.6, 0.4});
  const Material plastic = material(factors(0.0, 0.0));
  CHECK(plastic.interaction == Interaction::opaque);
  CHECK(plastic.roughness == 0.02f);
}

TEST_CASE("KHR_materials_specular's factor scales F0 and F90 of a dielectric, not of a metal") {
  const auto with_factor = [](double metallic) {
    json members = factors(metallic, 0.5);
    members["extensions"]["KHR_materials_specular"]["specularFactor"] = 0.25;
    return material(members);
  };
  check_rgb(with_factor(0).specular, {0.01, 0.01, 0.01});
  CHECK(with_factor(0).f90 == 0.25f);
  CHECK(with_factor(1).f90 == 1.0f);
  check_rgb(with_factor(1).specular, {0.8, 0.6, 0.4});
  CHECK(with_factor(0.5).f90 == 0.625f);
}

TEST_CASE("KHR_materials_specular 0 without metal is purely diffuse") {
  const Material m =
      material({{"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  CHECK(m.specular == glm::vec3(0.0f));
  CHECK_FALSE(m.glossy());
}

TEST_CASE("KHR_materials_ior and the specular colour set F0") {
  const Material m =
      material({{"extensions",
                 {{"KHR_materials_ior", {{"ior", 2.0}}},
                  {"KHR_materials_specular",
                   {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0}}}}}}});
  check_rgb(m.specular, {0.5 / 9.0, 0.25 / 9.0, 0.0});
}

TEST_CASE("transmission from one half on is glass, thin without a volume, and less is opaque") {
  const auto transmission = [](double factor) {
    return json{{"extensions",
                 {{"KHR_materials_transmission", {{"transmissionFactor", factor}}},
                  {"KHR_materials_ior", {{"ior", 1.33}}}}}};
  };
  const Material thin = material(transmission(0.5));
  CHECK(thin.interaction == Interaction::glass);
  CHECK(thin.thin);
  CHECK(thin.index_of_refraction == 1.33f);
  check_rgb(thin.transmission, {0.8, 0.6, 0.4});
  json solid = transmission(1.0);
  solid["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0.1;
  CHECK_FALSE(material(solid).thin);
  Scene scene;
  CHECK(material(transmission(0.4), &scene).interaction == Interaction::opaque);
  CHECK(warns(scene, {"'glow'", "opaque"}));
}

// Reflectances of materials: read, set, and held against paths.

using scene::reflectance_of;

/// A plate so wide that nothing else is seen from just above it.
Scene wide_plate(const Material& material) { return plate(material, 1000); }

Scene square_of(const json& members, const SceneLoadOptions& options = {}) {
  json document = square_document();
  document["materials"][0].merge_patch(members);
  return load_gltf(document, options);
}

double whole(const Scene& scene) {
  return reflectance_of(scene, scene.materials[scene.triangle_material[0]])->whole;
}

TEST_CASE("a reflectance is what paths find under an even sky") {
  const Material material =
      GENERATE(diffuse(0.5f), glossy(0.5f, 0.04f, 0.25f), glossy(0.2f, 0.3f, 0.6f));
  Scene scene = wide_plate(material);
  add_environment(scene, EnvironmentMap("sky", 2, 1, std::vector<glm::vec3>(2, glm::vec3(1.0f))));
  const double claimed = reflectance_of(scene, scene.materials[0])->whole;
  // A plane that faces down receives pi L times the share reflected of light from everywhere.
  const Sensor sensor{{0, 0, 0.05}, {0, 0, -1}};
  const std::vector<double> values = of_seeds([&](std::uint64_t seed) {
    const auto layers = gather_by_paths(scene, std::span(&sensor, 1), {.rays = 8192}, seed).layers;
    return scene.lights[0].power * double{layers.dense().layers[0].illuminance[0]} /
           glm::pi<double>();
  });
  double mean = 0;
  for (const double value : values) mean += value / 16;
  CHECK(claimed == Approx(mean).epsilon(0.02));
}

TEST_CASE("glTF's specular adds to what the file enters, and lambertian takes it away") {
  const json grey{
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
  const Scene file = square_of(grey);
  const auto read = reflectance_of(file, file.materials[file.triangle_material[0]]);
  CHECK(read->matt == Approx(0.5));
  CHECK(read->whole > 0.505);
  SceneLoadOptions options;
  options.lambertian = true;
  CHECK(whole(square_of(grey, options)) == Approx(0.5));
  // A metal stays one.
  const json metal{{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.5}}}};
  CHECK(whole(square_of(metal, options)) == Approx(whole(square_of(metal))));
}

TEST_CASE("a material reflects the share that is asked for, and keeps its hue") {
  SceneLoadOptions options;
  const double share = GENERATE(0.1, 0.5);
  options.reflectances = {MaterialShare::parse(fmt::format("*={}", share))};
  options.lambertian = GENERATE(false, true);
  const Scene scene = square_of(json::object(), options);
  CHECK(whole(scene) == Approx(share).epsilon(1e-4));
  const Material& material = scene.materials[scene.triangle_material[0]];
  CHECK(material.diffuse.g / material.diffuse.r == Approx(0.75));  // the file has 0.8, 0.6, 0.4
}

TEST_CASE("a metal reflects the share that is asked for, keeps its hue and stays one") {
  const json metal{
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {0.8, 0.6, 0.4, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 1}}}};
  SceneLoadOptions options;
  options.reflectances = {MaterialShare::parse("*=0.5")};
  const Scene scene = square_of(metal, options);
  const Material& material = scene.materials[scene.triangle_material[0]];
  CHECK(whole(scene) == Approx(0.5).epsilon(1e-4));
  CHECK(material.diffuse == glm::vec3(0.0f));
  CHECK(material.specular.g / material.specular.r == Approx(0.75));
}

/// A texture of 16 x 16 texels: white for nothing, with a bright square at its top left and a
/// darker one beside it; three square metres show the bright one, one the darker.
Scene atlas() {
  std::vector<std::array<std::uint8_t, 4>> texels(256, {255, 255, 255, 255});
  for (std::size_t y = 0; y < 4; ++y) {
    for (std::size_t x = 0; x < 4; ++x) texels[16 * y + x] = {188, 188, 188, 255};
    for (std::size_t x = 4; x < 8; ++x) texels[16 * y + x] = {90, 90, 90, 255};
  }
  SceneBuilder builder("atlas");
  Material material = diffuse(1.0f);
  material.diffuse_texture = builder.add(Texture("atlas", 16, 16, texels));
  const std::uint32_t number = builder.add(material);
  const auto square = [&](const glm::vec3& origin, float width, float u) {
    const std::array<glm::vec3, 4> corners{origin, origin + glm::vec3(width, 0, 0),
                                           origin + glm::vec3(width, 1, 0),
                                           origin + glm::vec3(0, 1, 0)};
    const std::array<glm::vec2, 4> uv{glm::vec2(u, 0.1f), glm::vec2(u + 0.05f, 0.1f),
                                      glm::vec2(u + 0.05f, 0.15f), glm::vec2(u, 0.15f)};
    const std::array<glm::uvec3, 2> triangles{glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)};
    MeshArrays mesh;
    mesh.vertices = corners;
    mesh.triangles = triangles;
    mesh.uv = uv;
    mesh.material = number;
    builder.add(mesh);
  };
  square({0, 0, 0}, 3, 0.1f);
  square({0, 0, 1}, 1, 0.35f);
  builder.add(point_light("lamp", {0, 0, 3}));
  return builder.build();
}

TEST_CASE("a texture reflects what its surface shows of it, by area") {
  Scene scene = atlas();
  const double mean = (3 * linear(188) + linear(90)) / 4;
  CHECK(reflectance_of(scene, scene.materials[0])->whole == Approx(mean).epsilon(1e-3));
  CHECK_FALSE(scene::set_reflectance(scene, scene.materials[0], 1.01 * mean));
  REQUIRE(scene::set_reflectance(scene, scene.materials[0], 0.2));
  CHECK(scene.materials[0].diffuse.r == Approx(0.2 / mean).epsilon(1e-3));
}

TEST_CASE("a black material becomes grey, and glass has no reflectance") {
  Scene scene = wide_plate(diffuse(0.0f));
  REQUIRE(scene::set_reflectance(scene, scene.materials[0], 0.3));
  CHECK(scene.materials[0].diffuse == glm::vec3(scene.materials[0].diffuse.r));
  CHECK(reflectance_of(scene, scene.materials[0])->whole == Approx(0.3));
  Scene pane = wide_plate(glass(1.5f));
  CHECK_FALSE(reflectance_of(pane, pane.materials[0]));
  CHECK_FALSE(scene::set_reflectance(pane, pane.materials[0], 0.3));
  Scene silver = wide_plate(mirror(0.9f));
  REQUIRE(scene::set_reflectance(silver, silver.materials[0], 0.6));
  CHECK(silver.materials[0].specular.r == Approx(0.6f));
}

TEST_CASE("glass lets through what is asked for, of one sheet, of two, and of a body") {
  const std::string corners = "v -50 {0} -50\nv 50 {0} -50\nv 50 {0} 50\nv -50 {0} 50\n";
  const auto sheet = [&](double y) { return fmt::format(fmt::runtime(corners), y); };
  const auto [of_the_file, faces] = GENERATE_COPY(table<std::string, std::string>(
      {{sheet(1), "f 1 2 3 4\n"},
       {sheet(1) + sheet(1.016), "f 4 3 2 1\nf 5 6 7 8\n"},
       {sheet(1) + sheet(1.016), "f 1 2 3 4\nf 5 6 7 8\n"},
       {sheet(1) + sheet(1.004),
        "f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"}}));
  const double share = GENERATE(0.35, 0.78, 0.97);
  CAPTURE(faces, share);
  SceneLoadOptions options;
  options.glasses = {MaterialShare::parse(fmt::format("pan*={}", share))};
  options.sun = Sun::parse("0,90,1000,0");
  options.ground = 0;
  const Scene scene =
      load_obj(of_the_file + "usemtl pane\n" + faces + sheet(0) + "usemtl floor\nf -1 -2 -3 -4\n",
               "newmtl pane\nKd 0.3 0.4 0.5\nd 0.5\nNi 1.5\nnewmtl floor\nKd 0 0 0\n", options);
  const Sensor below{{0, 0, 0}, {0, 1, 0}};
  const auto layers = measure_by_paths(scene, std::span(&below, 1), 4, 1).layers.dense();
  // Without what bounces between two sheets and goes on: a square of 0.04 at most.
  CHECK(scene.lights[0].power * double{layers.layers[0].illuminance[0]} ==
        Approx(1000 * share / defaults::lumen_per_watt).epsilon(0.002));
}

}  // namespace
}  // namespace photile::test
