#include <catch2/catch.hpp>
#include <cmath>

#include "scene_files.hpp"

namespace photile::test {
namespace {

/// Material m of an MTL text, beside a lamp. Warnings go to `report` where given.
Material mtl_material(const std::string& statements, Scene* report = nullptr) {
  Scene scene = load_obj(unit_square + "usemtl lamp\nf 1 2 3\nusemtl m\nf 1 3 4\n",
                         "newmtl lamp\nKe 1 1 1\nnewmtl m\n" + statements);
  const Material result = scene.materials[scene.triangle_material[1]];
  if (report != nullptr) *report = std::move(scene);
  return result;
}

TEST_CASE("MTL Ks without a specular illumination model is diffuse only") {
  const Material m = mtl_material("Kd 0.5 0.25 0.125\nKs 0.3 0.3 0.3\nNs 50\nillum 1\n");
  CHECK(m.interaction == Interaction::opaque);
  CHECK(m.diffuse == glm::vec3(0.5f, 0.25f, 0.125f));
  CHECK_FALSE(m.glossy());
}

TEST_CASE("MTL illum 2 is glossy with GGX alpha sqrt(2 / (Ns + 2))") {
  const Material m = mtl_material("Kd 0.5 0.5 0.5\nKs 0.2 0.3 0.4\nNs 30\nillum 2\n");
  CHECK(m.glossy());
  CHECK(m.specular == glm::vec3(0.2f, 0.3f, 0.4f));
  CHECK(m.roughness == Approx(0.25));
}

TEST_CASE("MTL Kd + Ks above 1 is scaled to 1 with a warning") {
  Scene scene;
  const Material m = mtl_material("Kd 0.9 0.2 0.1\nKs 0.6 0.1 0.1\nNs 30\nillum 2\n", &scene);
  CHECK(m.diffuse.r == Approx(0.6));
  CHECK(m.specular.r == Approx(0.4));
  CHECK(m.diffuse.g == Approx(0.2 / 1.5));
  CHECK(warns(scene, {"'m'", "exceeds 1"}));
}

TEST_CASE("MTL illum 3 with a sharp lobe or without a diffuse part is a mirror") {
  CHECK(mtl_material("Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nNs 1000\nillum 3\n").interaction ==
        Interaction::mirror);
  const Material black = mtl_material("Kd 0 0 0\nKs 0.8 0.7 0.6\nNs 10\nillum 5\n");
  CHECK(black.interaction == Interaction::mirror);
  CHECK(black.specular == glm::vec3(0.8f, 0.7f, 0.6f));
  CHECK(black.diffuse == glm::vec3(0.0f));
  CHECK(mtl_material("Kd 0.4 0.4 0.4\nKs 0.3 0.3 0.3\nNs 10\nillum 3\n").interaction ==
        Interaction::opaque);
}

TEST_CASE("MTL glass models and transparency with Ni are glass of that index") {
  for (const std::string model :
       {"illum 4\n", "illum 6\n", "illum 7\n", "illum 9\n", "d 0.2\n", "Tr 0.8\n"}) {
    const Material m = mtl_material("Kd 1 1 1\nNi 1.33\nTf 0.9 0.8 0.7\n" + model);
    CHECK(m.interaction == Interaction::glass);
    CHECK(m.index_of_refraction == 1.33f);
    CHECK(m.transmission == glm::vec3(0.9f, 0.8f, 0.7f));
  }
  CHECK(mtl_material("illum 7\n").index_of_refraction == 1.5f);
}

TEST_CASE("MTL glass of a Phong exponent that is no mirror's is named as rough") {
  Scene scene;
  mtl_material("illum 7\nNs 250\n", &scene);
  CHECK(warns(scene, {"'m'", "rough glass (Ns 250)", "smooth"}));
  for (const std::string exponent : {"", "Ns 0\n", "Ns 1\n", "Ns 1000\n"}) {
    mtl_material("illum 7\n" + exponent, &scene);
    CHECK_FALSE(warns(scene, {"rough"}));
  }
}

TEST_CASE("MTL transparency without Ni lets light through by chance, with a warning") {
  Scene scene;
  const Material m = mtl_material("Kd 1 1 1\nd 0.5\n", &scene);
  CHECK(m.interaction == Interaction::opaque);
  CHECK(m.opacity == 0.5f);
  CHECK(warns(scene, {"'m'", "chance"}));
  CHECK_FALSE(mtl_material("Kd 1 1 1\nd 0\n", &scene).has_holes());
  CHECK(warns(scene, {"'m'", "opaque"}));
}

TEST_CASE("MTL roughness and metallic factors are used where present") {
  const Material m = mtl_material("Kd 0.5 0.5 0.5\nPr 0.5\nPm 1\n");
  CHECK(m.diffuse == glm::vec3(0.0f));
  CHECK(m.specular == glm::vec3(0.5f));
  CHECK(m.roughness == Approx(0.25));
}

TEST_CASE("a missing MTL texture is named and becomes mid grey") {
  Scene scene;
  const Material m = mtl_material("Kd 1 1 1\nmap_Kd absent.png\n", &scene);
  CHECK(m.diffuse == glm::vec3(0.5f));
  CHECK(m.diffuse_texture == none);
  CHECK(warns(scene, {"'m'", "absent.png", "grey"}));
}

TEST_CASE("MTL textures other than map_Kd are named in a warning") {
  Scene scene;
  mtl_material("Kd 1 1 1\nmap_Ks s.png\nbump b.png\n", &scene);
  CHECK(warns(scene, {"map_Ks"}));
  CHECK(warns(scene, {"bump"}));
}

TEST_CASE("materials that scatter in one way cost nothing elsewhere") {
  Scene scene;
  mtl_material("Kd 1 1 1\n", &scene);
  CHECK_FALSE(needs_of(scene).glossy);
  CHECK_FALSE(needs_of(scene).textures);
  CHECK_FALSE(needs_of(scene).specular_paths);
  CHECK(needs_of(scene).light_count == 1);
  CHECK(scene.corner_uv.empty());
  CHECK(scene.corner_normal.empty());
  mtl_material("illum 7\n", &scene);
  CHECK(needs_of(scene).specular_paths);
}

}  // namespace
}  // namespace photile::test
