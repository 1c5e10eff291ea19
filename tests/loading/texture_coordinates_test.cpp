// Textures whose coordinates the mesh lacks, or whose numbers name nothing: told, and replaced by
// what can be seen.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "scene_invariants.hpp"
#include "textured_square.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

/// KHR_texture_transform's texCoord is a number of any size; the parser cuts others to an int.
json texture(std::size_t index, const json& set) {
  return {{"index", index}, {"extensions", {{"KHR_texture_transform", {{"texCoord", set}}}}}};
}

}  // namespace

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
  CHECK(warns(scene, {"TEXCOORD_1", "its base-colour factor"}));
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

}  // namespace photile::test
