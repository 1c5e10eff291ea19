// Sides that no photon reaches, by what their sheet lets expect.
#include "surface/dark_sides.hpp"

#include <catch2/catch.hpp>

#include "photon_sets.hpp"

namespace photile::test {
namespace {

/// The dark sides of a plate of 200 equal triangles, where so many photons landed on the front of
/// each triangle, and none on the first ones.
std::vector<std::uint32_t> dark_sides(std::uint32_t on_each, std::uint32_t empty) {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 10);
  const surface::SurfaceMesh mesh(scene);
  std::vector<std::uint32_t> landed(2 * scene.triangle_count(), 0);
  for (std::uint32_t t = empty; t < scene.triangle_count(); ++t) landed[sided(t, 0)] = on_each;
  const auto connections = surface::find_connections(mesh, 0.1, 60);
  const auto dark =
      surface::find_dark_sides(mesh, connections, surface::join_sheets(mesh, connections), landed);
  std::vector<std::uint32_t> found;
  for (std::uint32_t s = 0; s < dark.size(); ++s) {
    if (dark[s] != 0) found.push_back(s);
  }
  return found;
}

}  // namespace

TEST_CASE("sides are dark together where 40 photons are expected and none landed") {
  std::vector<std::uint32_t> first_row;
  for (std::uint32_t t = 0; t < 20; ++t) first_row.push_back(sided(t, 0));
  CHECK(dark_sides(20, 20) == first_row);  // 18 expected on each
  CHECK(dark_sides(5, 20).empty());        // 4.5 on each: too few to tell
  CHECK(dark_sides(50, 1) == std::vector<std::uint32_t>{0});
  CHECK(dark_sides(20, 1).empty());  // 19.9, and no neighbour that is dark as well
}

}  // namespace photile::test
