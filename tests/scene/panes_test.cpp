// What counts as a pane, what it lets through, and what options make of it.
#include "scene/panes.hpp"

#include <catch2/catch.hpp>

#include "photile/scene_builder.hpp"
#include "scene/surface_models.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// As IfcOpenShell writes the glass of a window.
Material blended(float alpha) {
  Material material = diffuse({0.0f, 0.5f, 0.75f});
  material.opacity = alpha;
  return material;
}

Material thin_glass(const glm::vec3& tint = glm::vec3(1.0f)) {
  Material material = glass(1.5f, true);
  material.transmission = tint;
  return material;
}

/// Two faces of index 1.5 reflect 0.04 each.
constexpr double reflected = 2 * 0.04 / 1.04;

}  // namespace

TEST_CASE("panes are thin glass and surfaces that are partly there all over") {
  const glm::dvec3 tinted = *scene::pane_transmittance(thin_glass({0.5f, 1.0f, 0.25f}));
  CHECK(tinted.r == Approx(0.5 * (1 - reflected)).epsilon(1e-6));
  CHECK(tinted.g == Approx(1 - reflected).epsilon(1e-6));
  CHECK(tinted.b == Approx(0.25 * (1 - reflected)).epsilon(1e-6));
  // The over operator of glTF's BLEND: what is behind counts 1 - alpha, in all channels.
  CHECK(glm::distance(*scene::pane_transmittance(blended(0.1f)), glm::dvec3(0.9)) < 1e-7);
  CHECK_FALSE(scene::is_pane(glass(1.5f)));
  CHECK(scene::is_glazing(glass(1.5f)));
  CHECK_FALSE(scene::is_glazing(blended(1.0f)));
  Material leaf = blended(0.5f);
  leaf.opacity_texture = 0;
  CHECK_FALSE(scene::is_pane(leaf));
  Material masked = blended(0.5f);
  masked.opacity_cutoff = 0.4f;
  CHECK_FALSE(scene::is_pane(masked));
}

TEST_CASE("blinds make every pane let through what is asked for") {
  for (Material pane : {thin_glass(), blended(0.1f)}) {
    scene::set_transmittance(pane, 0.05);
    CHECK(glm::distance(*scene::pane_transmittance(pane), glm::dvec3(0.05)) < 1e-6);
  }
}

TEST_CASE("a pane's reflectance is told and set, and what it lets through stays") {
  Scene scene;
  Material clear = thin_glass(glm::vec3(0.8f));
  CHECK(scene::reflectance_of(scene, clear)->whole == Approx(reflected).epsilon(1e-6));
  REQUIRE(scene::set_reflectance(scene, clear, 0.15));
  CHECK(scene::reflectance_of(scene, clear)->whole == Approx(0.15).epsilon(1e-6));
  CHECK(scene::pane_transmittance(clear)->g == Approx(0.8 * (1 - reflected)).epsilon(1e-6));
  CHECK_FALSE(scene::set_reflectance(scene, clear, 0.3));  // 0.74 is let through

  Material of_ifc = blended(0.1f);
  const double own = luminance({0.0, 0.5, 0.75});
  CHECK(scene::reflectance_of(scene, of_ifc)->whole == Approx(0.1 * own).epsilon(1e-6));
  for (const double fraction : {0.03, 0.08}) {  // in its colour, and beyond what that can have
    REQUIRE(scene::set_reflectance(scene, of_ifc, fraction));
    CHECK(scene::reflectance_of(scene, of_ifc)->whole == Approx(fraction).epsilon(1e-4));
    CHECK(scene::pane_transmittance(of_ifc)->g == Approx(0.9).epsilon(1e-6));
  }
  CHECK_FALSE(scene::set_reflectance(scene, of_ifc, 0.12));

  Material solid = glass(1.5f);
  CHECK_FALSE(scene::set_reflectance(scene, solid, 0.1));
  CHECK_FALSE(scene::reflectance_of(scene, solid));
}

}  // namespace photile::test
