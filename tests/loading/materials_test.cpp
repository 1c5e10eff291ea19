// Materials and their textures.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <numbers>

#include "files/scene_files.hpp"
#include "message_of.hpp"
#include "photile/image.hpp"
#include "photile/sensors.hpp"
#include "pictures/textures.hpp"
#include "scene/surface_models.hpp"
#include "scene_files.hpp"
#include "scene_invariants.hpp"
#include "srgb_oracle.hpp"
#include "test_scenes.hpp"
#include "textured_square.hpp"
#include "trace/surface.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using scene::reflectance_of;

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

TEST_CASE("a glTF dielectric is its base colour under an F0 of 0.04 and alpha roughness^2") {
  const Material m = material(json::object());
  check_rgb(m.diffuse, {0.8, 0.6, 0.4});
  check_rgb(m.specular, {0.04, 0.04, 0.04});
  CHECK(m.roughness == Approx(0.25));
  CHECK(m.glossy());
}

TEST_CASE("a glTF metal reflects its base colour and scatters nothing") {
  const Material m = material(factors(1.0, 0.5));
  CHECK(m.interaction == Interaction::opaque);
  check_rgb(m.diffuse, {0, 0, 0});
  check_rgb(m.specular, {0.8, 0.6, 0.4});
}

TEST_CASE("a glTF half-metal is mixed linearly") {
  const Material m = material(factors(0.5, 0.5));
  check_rgb(m.diffuse, {0.4, 0.3, 0.2});
  check_rgb(m.specular, {0.42, 0.32, 0.22});
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

TEST_CASE("a white glTF dielectric stays white under its specular lobe") {
  const Material m = material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}});
  check_rgb(m.diffuse, {1, 1, 1});
  check_rgb(m.specular, {0.04, 0.04, 0.04});
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

TEST_CASE("glass that is not smooth and clear all over is named, with what it becomes") {
  const auto glass_with = [](json members) {
    members["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    json& model = members["pbrMetallicRoughness"];
    if (!model.contains("roughnessFactor")) model["roughnessFactor"] = 0.05;
    Scene scene;
    CHECK(material(members, &scene).interaction == Interaction::glass);
    return scene;
  };
  CHECK(glass_with(json::object()).report.warnings.empty());
  // A file that does not give its roughness asks for 1.
  for (const json& roughness : {json(0.06), json(0.4), json(1.0), json(nullptr)}) {
    json members;
    members["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
    CHECK(warns(glass_with(members), {"material 'glow'", "rough glass", "smooth"}));
  }
  json members;
  members["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = 0;
  members["extensions"]["KHR_materials_transmission"]["transmissionTexture"]["index"] = 0;
  members["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0.1;
  const Scene scene = glass_with(members);
  CHECK(warns(scene, {"material 'glow'", "roughness texture of glass"}));
  CHECK(warns(scene, {"material 'glow'", "transmission texture"}));
  CHECK(warns(scene, {"material 'glow'", "attenuation"}));
}

TEST_CASE("what a glTF material approximates is named") {
  Scene scene;
  material(
      {{"alphaMode", "BLEND"},
       {"normalTexture", {{"index", 0}}},
       {"occlusionTexture", {{"index", 0}}},
       {"emissiveTexture", {{"index", 0}}},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.8, 0.6, 0.4, 0.5}}, {"metallicRoughnessTexture", {{"index", 0}}}}}},
      &scene);
  for (const std::string word : {"alpha of a material that emits", "no normal map", "occlusion",
                                 "emissive", "roughness factor"}) {
    CHECK(warns(scene, {"'glow'", word}));
  }
}

TEST_CASE("an unknown extension is named when used and refused when required") {
  json document = square_document();
  document["extensionsUsed"] = {"KHR_materials_unlit", "KHR_lights_punctual"};
  const Scene scene = load_gltf(document);
  CHECK(warns(scene, {"KHR_materials_unlit"}));
  CHECK_FALSE(warns(scene, {"KHR_lights_punctual"}));
  document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  CHECK(input_error_of([&] { load_gltf(document); }).find("KHR_draco_mesh_compression") !=
        std::string::npos);
}

TEST_CASE("primitives without a material get glTF's default, and a wrong number is refused") {
  json document = square_document();
  auto& primitives = document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1].erase("material");
  const Scene scene = load_gltf(document);
  CHECK(scene.materials[scene.triangle_material[2]].name == "default");
  CHECK(scene.triangle_light[2] == none);
  primitives[1]["material"] = 1;
  CHECK(input_error_of([&] { load_gltf(document); }).find("material 1") != std::string::npos);
}

// Reflectances of materials: read, set, and held against paths.

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
      GENERATE(diffuse(glm::vec3(0.5f)), glossy(glm::vec3(0.5f), glm::vec3(0.04f), 0.25f),
               glossy(glm::vec3(0.2f), glm::vec3(0.3f), 0.6f));
  Scene scene = wide_plate(material);
  add_environment(scene, EnvironmentMap("sky", 2, 1, std::vector<glm::vec3>(2, glm::vec3(1.0f))));
  const double claimed = reflectance_of(scene, scene.materials[0])->whole;
  // A plane that faces down receives pi L times the share reflected of light from everywhere.
  const Sensor sensor{{0, 0, 0.05}, {0, 0, -1}};
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto layers = gather_by_paths(scene, std::span(&sensor, 1), {.rays = 8192}, seed).layers;
    values.push_back(scene.lights[0].power * double{layers.dense().layers[0].illuminance[0]} /
                     glm::pi<double>());
  }
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
  options.reflectances = {ReflectanceChange::parse(fmt::format("*={}", share))};
  options.lambertian = GENERATE(false, true);
  const Scene scene = square_of(json::object(), options);
  CHECK(whole(scene) == Approx(share).epsilon(1e-4));
  const Material& material = scene.materials[scene.triangle_material[0]];
  CHECK(material.diffuse.g / material.diffuse.r == Approx(0.75));  // the file has 0.8, 0.6, 0.4
}

TEST_CASE("reflectances that cannot be are refused with the remedy") {
  const auto refused = [&](const char* text, const char* words) {
    SceneLoadOptions options;
    const auto load = [&] {
      options.reflectances = {ReflectanceChange::parse(text)};
      square_of(json::object(), options);
    };
    CHECK_THAT(message_of<UsageError>(load), Catch::Contains(words));
  };
  refused("*=0", "--set lambertian=on");  // the lobe reflects more
  refused("*=0.95", "exceeds 1");
  refused("nothing=0.5", "no such material");
  refused("wall=1.5", "0 to 1");
  refused("wall=120%", "0 to 1");
  refused("wall", "MATERIAL=REFLECTANCE");
  CHECK(ReflectanceChange::parse("wall=20%").share == Approx(0.2));
}

TEST_CASE("a black material becomes grey, and glass has no reflectance") {
  Scene scene = wide_plate(diffuse(glm::vec3(0.0f)));
  REQUIRE(scene::set_reflectance(scene, scene.materials[0], 0.3));
  CHECK(scene.materials[0].diffuse == glm::vec3(scene.materials[0].diffuse.r));
  CHECK(reflectance_of(scene, scene.materials[0])->whole == Approx(0.3));
  Scene pane = wide_plate(test::glass(1.5f));
  CHECK_FALSE(reflectance_of(pane, pane.materials[0]));
  CHECK_FALSE(scene::set_reflectance(pane, pane.materials[0], 0.3));
  Scene silver = wide_plate(test::mirror(glm::vec3(0.9f)));
  REQUIRE(scene::set_reflectance(silver, silver.materials[0], 0.6));
  CHECK(silver.materials[0].specular.r == Approx(0.6f));
}

// Textures beside the base colour: metallic-roughness, specular, alpha and normals.

void check_sampled(const glm::vec3& actual, const glm::dvec3& expected) {
  CHECK(glm::length(glm::dvec3(actual) - expected) < 1e-5);
}

TEST_CASE("a metallic-roughness texture multiplies both factors, as they are in its bytes") {
  // Green 153 / 255 = 0.6, blue 51 / 255 = 0.2.
  const Scene scene = square_with({{255, 153, 51}}, [](json& material) {
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["metallicFactor"] = 0.5;
  });
  const auto surface = trace::reflectance(scene, middle(scene));
  const double metallic = 0.1, roughness = 0.3;
  const glm::dvec3 base(0.8, 0.6, 0.4);
  check_sampled(surface.albedo, base * (1 - metallic));
  check_sampled(surface.f0, 0.04 * (1 - metallic) + metallic * base);
  CHECK(surface.alpha == Approx(roughness * roughness));
  CHECK(needs_of(scene).textures);
}

TEST_CASE("a base-colour texture colours a metal's reflection") {
  const Scene scene = square_with({{255, 255, 0}}, [](json& material) {
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["metallicFactor"] = 1;
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0;
  });
  CHECK(scene.materials[0].interaction == Interaction::opaque);
  const auto surface = trace::reflectance(scene, middle(scene));
  check_sampled(surface.f0, {0.8, 0.6, 0});
  check_sampled(surface.albedo, {0, 0, 0});
  CHECK(surface.alpha == 0.02f);
}

TEST_CASE("specular textures multiply the factor by alpha, the colour by RGB") {
  const Scene scene = square_with({{0, 0, 0, 51}, {255, 0, 255}}, [](json& material) {
    material["extensions"]["KHR_materials_specular"] = {{"specularTexture", {{"index", 0}}},
                                                        {"specularColorTexture", {{"index", 1}}}};
  });
  const auto surface = trace::reflectance(scene, middle(scene));
  check_sampled(surface.f0, {0.04 * 0.2, 0, 0.04 * 0.2});
  CHECK(surface.f90 == Approx(0.2));
}

TEST_CASE("alpha mode MASK cuts by the texture's alpha times the factor") {
  const auto opacity = [](std::uint8_t alpha, double factor, const json& members) {
    const Scene scene = square_with({{255, 255, 255, alpha}}, [&](json& material) {
      material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
      material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, factor};
      material.merge_patch(members);
    });
    return trace::opacity(scene, middle(scene));
  };
  CHECK(opacity(100, 1, {{"alphaMode", "MASK"}}) == 0);
  CHECK(opacity(200, 1, {{"alphaMode", "MASK"}}) == 1);
  CHECK(opacity(200, 0.5, {{"alphaMode", "MASK"}}) == 0);
  CHECK(opacity(100, 1, {{"alphaMode", "MASK"}, {"alphaCutoff", 0.2}}) == 1);
  CHECK(opacity(100, 1, {{"alphaMode", "OPAQUE"}}) == 1);
  CHECK(opacity(51, 0.5, {{"alphaMode", "BLEND"}}) == Approx(0.1));
}

TEST_CASE("what has no holes is not asked for any") {
  const auto has_holes = [](const json& members) {
    return square_with({{255, 255, 255, 255}},
                       [&](json& material) {
                         material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
                         material.merge_patch(members);
                       })
        .materials[0]
        .has_holes();
  };
  CHECK_FALSE(has_holes({{"alphaMode", "MASK"}}));
  CHECK_FALSE(has_holes({{"alphaMode", "BLEND"}}));
  CHECK_FALSE(has_holes({{"alphaMode", "OPAQUE"}}));
}

TEST_CASE("alpha mode BLEND and alpha of lamps are approximations that are told") {
  const auto blend = [](json& material) {
    material["alphaMode"] = "BLEND";
    material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  };
  CHECK(warns(square_with({}, blend), {"'glow'", "BLEND", "chance"}));
  const Scene lamp = square_with({}, [&](json& material) {
    blend(material);
    material["emissiveFactor"] = {1, 1, 1};
  });
  CHECK(warns(lamp, {"'glow'", "emits"}));
  CHECK_FALSE(lamp.materials[0].has_holes());
}

TEST_CASE("a glTF normal map is read with its scale and turns normals") {
  // (204, 128, 230): slope 0.6 / 0.8 along u, which runs along y on this square.
  const Scene scene = square_with({{204, 128, 230}}, [](json& material) {
    material["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  });
  CHECK(needs_of(scene).normal_maps);
  CHECK(needs_of(scene).glossy);
  const auto normals = trace::shading_normals(scene, middle(scene), {0, 0, -1});
  CHECK(glm::distance(normals.smooth, glm::vec3(0, 0, 1)) < 1e-6f);
  const auto& uv = scene.corner_uv[0];
  const auto corners = scene.corners(0);
  // The direction in which u grows, from two corners of the same v, or the third.
  const glm::vec2 du = uv[1] - uv[0], dv = uv[2] - uv[0];
  const glm::vec3 along_u =
      glm::normalize((dv.y * (corners[1] - corners[0]) - du.y * (corners[2] - corners[0])) /
                     (du.x * dv.y - du.y * dv.x));
  const double slope = 0.5 * (204 / 127.5 - 1) / (230 / 127.5 - 1);
  CHECK(double{glm::dot(normals.mapped, along_u)} ==
        Approx(slope / std::sqrt(1 + slope * slope)).margin(0.003));
}

TEST_CASE("textures with other coordinates than the first are named and left out") {
  const Scene scene = square_with({{255, 255, 255}, {255, 153, 51}}, [](json& material) {
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 1}, {"texCoord", 1}};
  });
  CHECK(warns(scene, {"'glow'", "other coordinates"}));
  CHECK(scene.materials[0].metallic_roughness == none);
  CHECK(scene.materials[0].roughness == Approx(0.25));
}

TEST_CASE("MTL map_d cuts by alpha, or by grey where there is none") {
  const auto opacity = [](const std::vector<std::uint8_t>& texel, const std::string& statements) {
    const SceneFolderOnDisk folder;
    write_texel(folder.path / "d.png", texel);
    folder.write("materials.mtl",
                 "newmtl lamp\nKe 1 1 1\nnewmtl leaf\nKd 0.5 0.5 0.5\n" + statements);
    const Scene scene = load_scene(
        folder.write("scene.obj", "mtllib materials.mtl\n" + unit_square +
                                      "usemtl leaf\nf 1/1 2/2 3/3\nusemtl lamp\nf 1/1 3/3 4/4\n"));
    CHECK(scene.materials[0].has_holes());
    return trace::opacity(scene, middle(scene));
  };
  CHECK(opacity({51}, "map_d d.png\n") == Approx(0.2));
  CHECK(opacity({10, 20, 30, 102}, "map_d d.png\n") == Approx(0.4));
  CHECK(opacity({102}, "d 0.5\nNi 1.45\nmap_d d.png\n") == Approx(0.2));
}

TEST_CASE("MTL norm is a normal map") {
  const SceneFolderOnDisk folder;
  write_texel(folder.path / "n.png", {204, 128, 230});
  folder.write("materials.mtl",
               "newmtl lamp\nKe 1 1 1\nnewmtl brick\nKd 0.5 0.5 0.5\n"
               "norm -bm 0.5 n.png\n");
  const Scene scene = load_scene(
      folder.write("scene.obj", "mtllib materials.mtl\n" + unit_square +
                                    "usemtl brick\nf 1/1 2/2 3/3\nusemtl lamp\nf 1/1 3/3 4/4\n"));
  REQUIRE(scene.materials[0].name == "brick");
  CHECK(scene.materials[0].normal_texture == 0);
  CHECK(scene.materials[0].normal_scale == 0.5f);
  CHECK(needs_of(scene).normal_maps);
}

/// Two by two texels: red, green / blue, white.
Texture four_texels() {
  return Texture("four", 2, 2,
                 {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}});
}

template <typename T>
void write_picture(const std::filesystem::path& file, int width, int height, int channels,
                   const std::vector<T>& pixels, OIIO::TypeDesc type) {
  const auto output = OIIO::ImageOutput::create(file.string());
  REQUIRE(output);
  OIIO::ImageSpec spec(width, height, channels, type);
  spec["oiio:UnassociatedAlpha"] = 1;
  REQUIRE(output->open(file.string(), spec));
  REQUIRE(output->write_image(type, pixels.data()));
  REQUIRE(output->close());
}

std::vector<unsigned char> read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST_CASE("texture lookup puts (0,0) at the top left, texel centres at half texels") {
  const Texture texture = four_texels();
  CHECK(texture.sample({0.25f, 0.25f}) == glm::vec3(1, 0, 0));
  CHECK(texture.sample({0.75f, 0.25f}) == glm::vec3(0, 1, 0));
  CHECK(texture.sample({0.25f, 0.75f}) == glm::vec3(0, 0, 1));
  CHECK(texture.sample({0.5f, 0.25f}) == glm::vec3(0.5f, 0.5f, 0));
  CHECK(texture.sample({0.5f, 0.5f}) == glm::vec3(0.5f));
}

TEST_CASE("textures repeat, and coordinates that are not finite do no harm") {
  const Texture texture = four_texels();
  CHECK(texture.sample({-0.75f, 3.25f}) == glm::vec3(1, 0, 0));
  CHECK(texture.sample({0.0f, 0.25f}) == glm::vec3(0.5f, 0.5f, 0));  // across the seam
  CHECK(std::isfinite(texture.sample({std::nanf(""), 1e30f}).r));
}

TEST_CASE("texels are decoded from sRGB before they are mixed") {
  const Texture texture("grey", 1, 1, {{188, 100, 5, 255}});
  const glm::vec3 value = texture.sample({0.5f, 0.5f});
  CHECK(value.r == Approx(linear(188)));
  CHECK(value.g == Approx(linear(100)));
  CHECK(value.b == Approx(linear(5)));
}

TEST_CASE("pictures of 1 to 4 channels decode to the colours written, alpha left alone") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.png";
  for (int channels = 1; channels <= 4; ++channels) {
    std::vector<std::uint8_t> pixel{200, 100, 50, 0};
    pixel.resize(static_cast<std::size_t>(channels));
    write_picture(file, 1, 1, channels, pixel, OIIO::TypeDesc::UINT8);
    const glm::vec3 value =
        pictures::decode_texture("t.png", read_bytes(file)).sample({0.5f, 0.5f});
    CHECK(value.r == Approx(linear(200)));
    CHECK(value.g == Approx(linear(channels < 3 ? 200 : 100)));
    CHECK(value.b == Approx(linear(channels < 3 ? 200 : 50)));
  }
}

TEST_CASE("linear pictures are clamped and come back within half an 8-bit step") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.exr";
  write_picture<float>(file, 2, 1, 3, {0.5f, 0.1f, 0.9f, std::nanf(""), -1.0f, 7.0f},
                       OIIO::TypeDesc::FLOAT);
  const Texture texture = pictures::decode_texture("t.exr", read_bytes(file));
  const glm::vec3 first = texture.sample({0.25f, 0.5f}), second = texture.sample({0.75f, 0.5f});
  CHECK(first.r == Approx(0.5).margin(0.005));
  CHECK(first.g == Approx(0.1).margin(0.005));
  CHECK(first.b == Approx(0.9).margin(0.005));
  CHECK(second == glm::vec3(0, 0, 1));
}

TEST_CASE("channels of an EXR behind its picture are no alpha") {
  const SceneFolderOnDisk folder;
  Image picture;
  picture.width = picture.height = 1;
  for (const auto& [channel, value] :
       {std::pair{"R", 1.0f}, {"G", 0.5f}, {"B", 0.0f}, {"Z", 0.0f}}) {
    picture.add(channel).assign(1, value);
  }
  write_exr(folder.path / "t.exr", picture);
  const auto alpha = [&] {
    return pictures::decode_texture("t.exr", read_bytes(folder.path / "t.exr"))
        .sample_data({0.5f, 0.5f})
        .a;
  };
  CHECK(alpha() == 1.0f);
  picture.add("A").assign(1, 0.25f);
  write_exr(folder.path / "t.exr", picture);
  CHECK(alpha() == Approx(0.25).margin(0.005));
}

TEST_CASE("a PNG header that promises too many pixels is refused before decoding") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.png";
  write_picture<std::uint8_t>(file, 1, 1, 3, {1, 2, 3}, OIIO::TypeDesc::UINT8);
  std::vector<unsigned char> bytes = read_bytes(file);
  // Width 20,000 in the IHDR chunk, and the checksum that makes it a valid header.
  bytes[18] = 0x4E;
  bytes[19] = 0x20;
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  }
  for (int i = 0; i < 4; ++i)
    bytes[29 + static_cast<std::size_t>(i)] = static_cast<unsigned char>(~crc >> (24 - 8 * i));
  CHECK_THROWS_WITH(pictures::decode_texture("t.png", bytes),
                    Catch::Contains("20000 x 1") && Catch::Contains("limit"));
}

TEST_CASE("truncated and unknown pictures are refused by name") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.png";
  write_picture<std::uint8_t>(file, 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 7),
                              OIIO::TypeDesc::UINT8);
  std::vector<unsigned char> bytes = read_bytes(file);
  bytes.resize(20);
  CHECK_THROWS_AS(pictures::decode_texture("t.png", bytes), files::ResourceError);
  const std::vector<unsigned char> text{'h', 'e', 'l', 'l', 'o'};
  CHECK_THROWS_WITH(pictures::decode_texture("note.png", text), Catch::Contains("note.png"));
}

/// A textured square; its picture is red in the left half and green in the right one.
Scene textured(const std::function<void(json&)>& change, bool with_picture = true) {
  const SceneFolderOnDisk folder;
  if (with_picture) {
    write_picture<std::uint8_t>(folder.path / "my picture.png", 2, 1, 3, {255, 0, 0, 0, 255, 0},
                                OIIO::TypeDesc::UINT8);
  }
  json document = square_document();
  document["images"] = {{{"uri", "my%20picture.png"}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  change(document);
  folder.write("square.bin", square_buffer());
  return load_scene(folder.write("scene.gltf", document.dump()));
}

/// Texture colour at the corner with this position.
glm::vec3 colour_at(const Scene& scene, const glm::vec3& position, const glm::vec2& shift) {
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (scene.corners(t)[c] == position) {
        return scene.textures.at(0).sample(scene.corner_uv.at(t)[c] + shift);
      }
    }
  }
  FAIL("no such corner");
  return {};
}

TEST_CASE("a glTF base-colour texture arrives at the right corners") {
  const Scene scene = textured([](json&) {});
  REQUIRE(scene.textures.size() == 1);
  CHECK(needs_of(scene).textures);
  CHECK(colour_at(scene, {0, 0, 0}, {0.25f, -0.5f}) == glm::vec3(1, 0, 0));
  CHECK(colour_at(scene, {1, 0, 0}, {-0.25f, -0.5f}) == glm::vec3(0, 1, 0));
}

TEST_CASE("KHR_texture_transform scales, turns and moves texture coordinates in that order") {
  const Scene scene = textured([](json& document) {
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform",
         {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", std::acos(0.0)}}}};
  });
  // Corner (1,0,0) has uv (1,1): scaled (2,3); a quarter turn counter-clockwise, v pointing down,
  // maps (u,v) to (v,-u): (3,-2); moved (3.5,-1.75).
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (scene.corners(t)[c] != glm::vec3(1, 0, 0)) continue;
      CHECK(scene.corner_uv[t][c].x == Approx(3.5));
      CHECK(scene.corner_uv[t][c].y == Approx(-1.75));
    }
  }
}

TEST_CASE("a missing glTF texture is named and becomes mid grey") {
  const Scene scene = textured([](json&) {}, false);
  CHECK(warns(scene, {"'glow'", "my picture.png", "grey"}));
  CHECK(scene.materials[0].diffuse_texture == none);
  CHECK(scene.materials[0].diffuse.r == Approx(0.5));
  CHECK(scene.corner_uv.empty());
}

TEST_CASE("a picture in a buffer view beyond its buffer is refused") {
  const std::string error = input_error_of([] {
    textured([](json& document) {
      document["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", 4'000'000'000u}, {"byteLength", 100}});
      document["images"] = {{{"bufferView", 4}, {"mimeType", "image/png"}}};
    });
  });
  CHECK(error.find("beyond its buffer") != std::string::npos);
}

// Textures whose coordinates the mesh lacks, or whose numbers name nothing: told, and replaced by
// what can be seen.

/// KHR_texture_transform's texCoord is a number of any size; the parser cuts others to an int.
json texture(std::size_t index, const json& set) {
  return {{"index", index}, {"extensions", {{"KHR_texture_transform", {{"texCoord", set}}}}}};
}

TEST_CASE("a texture by coordinates that the mesh lacks gives mid grey and a warning") {
  for (const json& set : {json(1), json(-3), json(7.9), json(1e300), json(-1e300),
                          json(4'294'967'295ull), json(2'147'483'647)}) {
    CAPTURE(set);
    const Scene scene = square_with({{255, 0, 0}}, [&](json& material) {
      material["pbrMetallicRoughness"]["baseColorTexture"] = texture(0, set);
    });
    check_invariants(scene);
    CHECK(warns(scene, {"mesh 'square'", "has no TEXCOORD_", "'glow'", "mid grey"}));
    CHECK(trace::reflectance(scene, middle(scene)).albedo == glm::vec3(0.5f));
    CHECK(scene.materials[scene.triangle_material[0]].name == "glow (without textures)");
  }
}

TEST_CASE("a fraction of a coordinate set is the set below it") {
  const Scene scene = square_with({{255, 0, 0}}, [](json& material) {
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture(0, 0.5);
  });
  CHECK(scene.report.warnings.empty());
  CHECK(trace::reflectance(scene, middle(scene)).albedo.r == Approx(0.8));
}

TEST_CASE("without coordinates the factors count where textures would vary them") {
  const Scene scene = square_with({{255, 153, 51, 51}}, [](json& material) {
    json& model = material["pbrMetallicRoughness"];
    model["metallicRoughnessTexture"] = texture(0, 1);
    model["baseColorTexture"] = texture(0, 1);
    model["metallicFactor"] = 0.5;
    material["normalTexture"] = texture(0, 1);
    material["alphaMode"] = "BLEND";
  });
  CHECK(warns(scene, {"TEXCOORD_1", "mid grey"}));
  const auto surface = trace::reflectance(scene, middle(scene));
  CHECK(surface.albedo == glm::vec3(0.25f));  // mid grey, half a metal
  CHECK(double{surface.f0.r} == Approx(0.5 * 0.04 + 0.5 * 0.5));
  CHECK(surface.alpha == 0.25f);
  CHECK(trace::opacity(scene, middle(scene)) == 1.0f);
  const auto normals = trace::shading_normals(scene, middle(scene), {0, 0, -1});
  CHECK(normals.mapped == normals.smooth);
}

TEST_CASE("a normal map alone without coordinates leaves the colour as it is") {
  const Scene scene = square_with(
      {{204, 128, 230}}, [](json& material) { material["normalTexture"] = texture(0, 1); });
  CHECK(warns(scene, {"TEXCOORD_1", "what its factors say"}));
  CHECK(double{trace::reflectance(scene, middle(scene)).albedo.g} == Approx(0.6));
}

TEST_CASE("of two primitives of a material the one with coordinates keeps the texture") {
  const SceneFolderOnDisk folder;
  write_texel(folder.path / "red.png", {255, 0, 0});
  folder.write("square.bin", square_buffer());
  json document = square_document();
  document["images"] = {{{"uri", "red.png"}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  document["meshes"].push_back(document["meshes"][0]);
  document["meshes"][1]["name"] = "bare";
  document["meshes"][1]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  document["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, 5}}});
  document["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  check_invariants(scene);
  REQUIRE(scene.triangle_count() == 4);
  CHECK(warns(scene, {"mesh 'bare'", "TEXCOORD_0"}));
  const auto albedo = [&](std::uint32_t triangle) {
    return trace::reflectance(scene, trace::surface_hit(scene, {triangle, 0.3f, 0.3f}, {0, 0, -1}))
        .albedo;
  };
  CHECK(albedo(0).g == 0.0f);
  CHECK(albedo(2) == glm::vec3(0.5f));
}

TEST_CASE("an emission without coordinates has its factor alone") {
  const Scene scene = square_with({{255, 0, 0}}, [](json& material) {
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = texture(0, 1);
  });
  CHECK(warns(scene, {"'square'", "TEXCOORD_1", "emission", "factor"}));
  REQUIRE(scene.lights.size() == 2);
  const Light& light = scene.lights[1];
  CHECK(light.kind == LightKind::area);
  CHECK(light.emission_texture == none);
  CHECK(light.power == Approx(std::numbers::pi * 100));
  CHECK(light.color == glm::vec3(1.0f));
}

TEST_CASE("OBJ faces without texture coordinates are mid grey, and told") {
  const SceneFolderOnDisk folder;
  write_texel(folder.path / "red.png", {255, 0, 0});
  folder.write("materials.mtl",
               "newmtl lamp\nKe 2 2 2\nmap_Ke red.png\nnewmtl brick\nKd 1 1 1\nmap_Kd red.png\n");
  const Scene scene = load_scene(folder.write(
      "scene.obj", "mtllib materials.mtl\n" + unit_square +
                       "usemtl brick\nf 1/1 2/2 3/3\nf 1/1 3 4/4\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
                       "o lamp\nusemtl lamp\nf 5 6 7\n"));
  check_invariants(scene);
  REQUIRE(scene.triangle_count() == 3);
  CHECK(warns(scene, {"material 'brick', 'lamp'", "without texture coordinates", "mid grey"}));
  const auto albedo = [&](std::uint32_t triangle) {
    return trace::reflectance(scene, trace::surface_hit(scene, {triangle, 0.3f, 0.3f}, {0, 0, -1}))
        .albedo;
  };
  CHECK(albedo(0) == glm::vec3(1, 0, 0));
  CHECK(albedo(1) == glm::vec3(0.5f));
  CHECK(scene.lights.at(0).power == Approx(std::numbers::pi * 0.5 * 2));  // all of Ke, all colours
}

TEST_CASE("numbers of textures and views that no file can hold name nothing") {
  for (const json& index : {json(1e300), json(-1e300), json(-7), json(5)}) {
    CAPTURE(index);
    const Scene scene = square_with({}, [&](json& material) {
      material["extensions"]["KHR_materials_specular"]["specularTexture"] = {{"index", index}};
    });
    CHECK(warns(scene, {"'glow'", "there is no texture", "specular factor"}));
  }
  json document = square_document();
  document["extensionsUsed"] = {"EXT_lights_ies"};
  document["extensions"]["EXT_lights_ies"]["lights"] = {{{"bufferView", 1e300}}};
  document["nodes"][0]["extensions"]["EXT_lights_ies"]["light"] = 0;
  CHECK_THAT(input_error_of([&] { load_gltf(document); }), Catch::Contains("no buffer view"));
}

TEST_CASE("huge scales and indices of refraction leave normals and Fresnel's terms finite") {
  const Scene scene = square_with({{204, 128, 230}}, [](json& material) {
    material["normalTexture"] = {{"index", 0}, {"scale", 1e300}};
    material["extensions"]["KHR_materials_ior"]["ior"] = 1e300;
  });
  const auto normals = trace::shading_normals(scene, middle(scene), {0, 0, -1});
  CHECK(std::isfinite(glm::length(normals.mapped)));
  CHECK(glm::length(normals.mapped) == Approx(1));
  CHECK(trace::reflectance(scene, middle(scene)).f0.r == Approx(1));
}

}  // namespace
}  // namespace photile::test
