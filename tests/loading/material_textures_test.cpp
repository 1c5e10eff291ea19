// Textures beside the base colour: metallic-roughness, specular, alpha and normals.
#include <catch2/catch.hpp>

#include "textured_square.hpp"
#include "trace/surface.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

void check_sampled(const glm::vec3& actual, const glm::dvec3& expected) {
  CHECK(glm::length(glm::dvec3(actual) - expected) < 1e-5);
}

}  // namespace

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

TEST_CASE("a texture that is a WebP alone is read, as files require by EXT_texture_webp") {
  const SceneFolderOnDisk folder;
  write_texel(folder.path / "texel.webp", {255, 255, 255});
  folder.write("square.bin", square_buffer());
  json document = square_document();
  document["extensionsUsed"] = document["extensionsRequired"] = {"EXT_texture_webp"};
  document["images"] = {{{"uri", "texel.webp"}}};
  document["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  CHECK(scene.report.warnings.empty());
  CHECK(scene.textures.size() == 1);
  check_sampled(trace::reflectance(scene, middle(scene)).albedo, {0.8, 0.6, 0.4});
  document["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  CHECK(warns(load_scene(folder.write("scene.gltf", document.dump())), {"no picture"}));
}

TEST_CASE("one picture under many names is one texture") {
  const Scene scene = square_with({{9, 9, 9}, {9, 9, 9}, {8, 9, 9}}, [](json& material) {
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["extensions"]["KHR_materials_specular"] = {{"specularColorTexture", {{"index", 1}}}};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 2}};
  });
  CHECK(scene.textures.size() == 2);
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
  const auto has_cutouts = [](const json& members) {
    return square_with({{255, 255, 255, 255}},
                       [&](json& material) {
                         material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
                         material.merge_patch(members);
                       })
        .materials[0]
        .has_cutouts();
  };
  CHECK_FALSE(has_cutouts({{"alphaMode", "MASK"}}));
  CHECK_FALSE(has_cutouts({{"alphaMode", "BLEND"}}));
  CHECK_FALSE(has_cutouts({{"alphaMode", "OPAQUE"}}));
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
    CHECK(scene.materials[0].has_cutouts());
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

}  // namespace photile::test
