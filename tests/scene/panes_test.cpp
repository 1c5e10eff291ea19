// What counts as a pane, what it lets through, and what options make of it.
#include "scene/panes.hpp"

#include <catch2/catch.hpp>

#include "scene/scene_queries.hpp"
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

// Where glass encloses a volume, and where it is a sheet.

constexpr std::uint32_t pane = 1;  // material of the glass

/// A room at some distance from the world's origin, and what `add` puts into it.
template <class Add>
std::uint32_t open_edges(bool thin, const Add& add) {
  SceneBuilder builder;
  builder.add(diffuse(0.5f));
  builder.add(glass(1.5f, thin));
  builder.add(point_light("lamp", {101, 1, 2.5f}));
  builder.box({99, -1, 0}, {104, 4, 3}, 0, true);
  add(builder);
  const auto open = scene::open_edges_of_glass(builder.build());
  CHECK(open[0] == 0);
  return open[pane];
}

TEST_CASE("a box of glass has no open edge, whatever its number of quads") {
  const int cells = GENERATE(1, 3);
  CHECK(open_edges(false, [&](SceneBuilder& builder) {
          builder.box({100, 0, 1}, {101.3f, 1, 1.7f}, pane, false, cells);
        }) == 0);
}

TEST_CASE("a sheet of solid glass is open along its outline, and thin glass may be a sheet") {
  const auto sheet = [](SceneBuilder& builder) {
    builder.grid({100, 0, 1}, {1, 0, 0}, {0, 0.3f, 1}, 2, pane);
  };
  CHECK(open_edges(false, sheet) == 8);
  CHECK(open_edges(true, sheet) == 0);
}

TEST_CASE("a box of glass without a lid is open along its rim") {
  CHECK(open_edges(false, [](SceneBuilder& builder) {
          builder.grid({100, 0, 1}, {0, 1, 0}, {1, 0, 0}, 1, pane);
          builder.grid({100, 0, 1}, {1, 0, 0}, {0, 0, 1}, 1, pane);
          builder.grid({100, 1, 1}, {0, 0, 1}, {1, 0, 0}, 1, pane);
          builder.grid({100, 0, 1}, {0, 0, 1}, {0, 1, 0}, 1, pane);
          builder.grid({101, 0, 1}, {0, 1, 0}, {0, 0, 1}, 1, pane);
        }) == 4);
}

TEST_CASE("six quads that share neither corners nor their cuts are a closed box") {
  // Some 15 microns apart, and cut into 1 to 6 x 6 cells each, so that no corner meets another's.
  CHECK(open_edges(false, [](SceneBuilder& builder) {
          const float gap = 1.5e-5f;
          builder.grid({100, 0, 1 - gap}, {0, 1, 0}, {1, 0, 0}, 1, pane);
          builder.grid({100, 0, 2 + gap}, {1, 0, 0}, {0, 1, 0}, 2, pane);
          builder.grid({100, -gap, 1}, {1, 0, 0}, {0, 0, 1}, 3, pane);
          builder.grid({100, 1 + gap, 1}, {0, 0, 1}, {1, 0, 0}, 4, pane);
          builder.grid({100 - gap, 0, 1}, {0, 0, 1}, {0, 1, 0}, 5, pane);
          builder.grid({101 + gap, 0, 1}, {0, 1, 0}, {0, 0, 1}, 6, pane);
        }) == 0);
}

}  // namespace
}  // namespace photile::test
