// Textures beside the base colour: metallic-roughness, specular, alpha and normals.
#include <limits>
#include <numbers>

#include "scene_invariants.hpp"
#include "textured_square.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

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

// Textures whose coordinates the mesh lacks, or whose numbers name nothing: told, and replaced by
// what can be seen.

/// KHR_texture_transform's texCoord is a number of any size; the parser cuts others to an int.
json texture(std::size_t index, const json& set) {
  return {{"index", index}, {"extensions", {{"KHR_texture_transform", {{"texCoord", set}}}}}};
}

glm::vec3 albedo(const Scene& scene, std::uint32_t triangle = 0) {
  const auto point = trace::surface_hit(scene, {triangle, 0.3f, 0.3f}, {0, 0, -1});
  return trace::reflectance(scene, point).albedo;
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
    CHECK(albedo(scene) == glm::vec3(0.5f));
    CHECK(scene.materials[scene.triangle_material[0]].name == "glow (without textures)");
  }
}

TEST_CASE("a fraction of a coordinate set is the set below it") {
  const Scene scene = square_with({{255, 0, 0}}, [](json& material) {
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture(0, 0.5);
  });
  CHECK(scene.report.warnings.empty());
  CHECK(albedo(scene).r == Approx(0.8));
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
  CHECK(double{albedo(scene).g} == Approx(0.6));
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
  CHECK(albedo(scene, 0).g == 0.0f);
  CHECK(albedo(scene, 2) == glm::vec3(0.5f));
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
  CHECK(albedo(scene, 0) == glm::vec3(1, 0, 0));
  CHECK(albedo(scene, 1) == glm::vec3(0.5f));
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

// TANGENT of glTF meshes: which way normal maps turn the normals where the file says it.

using Texel = std::vector<std::uint8_t>;

const Texel red_slope{204, 128, 230}, green_slope{128, 204, 230};

/// The square (facing +z, its u along +x and v along -y) under a normal map of one texel and a
/// lamp. `tangent` is that of all corners; none where it is zero.
Scene with_tangents(
    const Texel& texel, const glm::vec4& tangent, const json& node = json::object(),
    const std::function<void(json& attributes)>& change = [](json&) {}) {
  const SceneFolderOnDisk folder;
  write_texel(folder.path / "normal.png", texel);
  std::string buffer = square_buffer();
  json document = square_document();
  document["buffers"][0]["byteLength"] = buffer.size() + 64;
  document["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", 64}});
  document["accessors"].push_back(
      {{"bufferView", 4}, {"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
  for (int corner = 0; corner < 4; ++corner) {
    buffer += bytes_of<float>({tangent.x, tangent.y, tangent.z, tangent.w});
  }
  folder.write("square.bin", buffer);
  document["images"] = {{{"uri", "normal.png"}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["normalTexture"] = {{"index", 0}};
  document["nodes"][0].update(node);
  json& attributes = document["meshes"][0]["primitives"][0]["attributes"];
  attributes["TANGENT"] = 4;
  change(attributes);
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  check_invariants(scene);
  return scene;
}

/// The mapped normal of both triangles as seen along `direction`.
glm::dvec3 mapped(const Scene& scene, const glm::vec3& direction = {0, 0, -1}) {
  std::array<glm::vec3, 2> normals;
  for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
    const auto point = trace::surface_hit(scene, {triangle, 0.3f, 0.3f}, direction);
    normals[triangle] = trace::shading_normals(scene, point, direction).mapped;
  }
  CHECK(glm::distance(normals[0], normals[1]) < 1e-5f);
  return glm::dvec3(normals[0]);
}

/// A normal of the slope of both texels along `along`, on the +z side.
glm::dvec3 sloping(const glm::dvec3& along) {
  const double slope = (204 / 127.5 - 1) / (230 / 127.5 - 1);
  return glm::normalize(slope * along + glm::dvec3(0, 0, 1));
}

/// What a byte resolves: 128 is not quite the middle.
constexpr double resolution = 0.006;

TEST_CASE("the red of a normal map runs along TANGENT, green along w times normal x tangent") {
  for (const float w : {1.0f, -1.0f}) {
    const glm::vec4 along_y(0, 1, 0, w);  // 90 degrees from u
    const glm::dvec3 red = mapped(with_tangents(red_slope, along_y)),
                     green = mapped(with_tangents(green_slope, along_y));
    CHECK(glm::distance(red, sloping({0, 1, 0})) < resolution);
    CHECK(glm::distance(green, sloping({-w, 0, 0})) < resolution);
  }
}

TEST_CASE("tangents along the texture's coordinates give what the coordinates give") {
  for (const Texel& texel : {red_slope, green_slope}) {
    const Scene given = with_tangents(texel, {1, 0, 0, 1});
    const Scene derived = with_tangents(texel, {1, 0, 0, 1}, json::object(),
                                        [](json& attributes) { attributes.erase("TANGENT"); });
    CHECK(given.corner_tangent.size() == 2);
    CHECK(derived.corner_tangent.empty());
    CHECK(glm::distance(mapped(given), mapped(derived)) < 1e-6);
  }
}

TEST_CASE("a node that mirrors, scales or turns takes the frame of TANGENT along") {
  const glm::vec4 diagonal(0.6f, 0.8f, 0, 1);
  for (const Texel& texel : {red_slope, green_slope}) {
    const glm::dvec3 plain = mapped(with_tangents(texel, diagonal));
    const glm::dvec3 mirrored = mapped(with_tangents(texel, diagonal, {{"scale", {-1, 1, 1}}}));
    CHECK(glm::distance(mirrored, plain * glm::dvec3(-1, 1, 1)) < 1e-5);
    const glm::dvec3 larger = mapped(with_tangents(texel, diagonal, {{"scale", {3, 3, 3}}}));
    CHECK(glm::distance(larger, plain) < 1e-5);
    const double h = std::sqrt(0.5);
    const glm::dvec3 turned = mapped(with_tangents(texel, diagonal, {{"rotation", {0, 0, h, h}}}));
    CHECK(glm::distance(turned, glm::dvec3(-plain.y, plain.x, plain.z)) < 1e-5);
    // Turned upside down through x: seen from -z now, y and z are mirrored.
    const glm::dvec3 over =
        mapped(with_tangents(texel, diagonal, {{"scale", {1, 1, -1}}}), {0, 0, 1});
    CHECK(glm::distance(over, plain * glm::dvec3(1, 1, -1)) < 1e-5);
  }
}

TEST_CASE("from behind the bump of TANGENT is a dent") {
  const Scene scene = with_tangents(green_slope, {0, 1, 0, 1});
  CHECK(glm::distance(mapped(scene, {0, 0, 1}), -mapped(scene)) < 1e-5);
}

TEST_CASE("tangents that are no frame, or without normals, are not used") {
  const glm::dvec3 by_coordinates = sloping({1, 0, 0});
  const float infinity = std::numeric_limits<float>::infinity();
  for (const glm::vec4 broken :
       {glm::vec4(0), glm::vec4(0, NAN, 0, 1), glm::vec4(infinity, 0, 0, 1)}) {
    const Scene scene = with_tangents(red_slope, broken);
    CHECK(scene.corner_tangent.empty());
    CHECK(glm::distance(mapped(scene), by_coordinates) < resolution);
  }
  const Scene bare = with_tangents(red_slope, {0, 1, 0, 1}, json::object(),
                                   [](json& attributes) { attributes.erase("NORMAL"); });
  CHECK(bare.corner_tangent.empty());
  CHECK(glm::distance(mapped(bare), by_coordinates) < resolution);
}

TEST_CASE("tangents between corners are interpolated") {
  Scene scene = with_tangents(red_slope, {1, 0, 0, 1});
  // Half-way between along x and along y it is along the diagonal.
  scene.corner_tangent[0] = {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1), glm::vec4(1, 0, 0, 1)};
  const auto point = trace::surface_hit(scene, {0, 0.5f, 0.0f}, {0, 0, -1});
  const glm::dvec3 normal(trace::shading_normals(scene, point, {0, 0, -1}).mapped);
  CHECK(glm::distance(normal, sloping({std::sqrt(0.5), std::sqrt(0.5), 0})) < resolution);
}

TEST_CASE("scenes without normal maps carry no tangents") {
  json document = square_document();
  document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = 0;  // of the wrong type, too
  CHECK(load_gltf(document).corner_tangent.empty());
}

}  // namespace
}  // namespace photile::test
