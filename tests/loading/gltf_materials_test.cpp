// Materials of glTF files.
#include <catch2/catch.hpp>

#include "scene_files.hpp"

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

}  // namespace

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

}  // namespace photile::test
