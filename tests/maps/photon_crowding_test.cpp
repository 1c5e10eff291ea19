// The crowding of photons against densities with a closed form.
#include <catch2/catch.hpp>

#include "maps/map_shapes.hpp"
#include "photon_sets.hpp"

namespace photile::test {
namespace {

/// Photons on the front of a unit plate of two triangles (or of more), only where x < lit.
Photons photons_on_part(const Scene& scene, float lit, std::size_t count) {
  std::mt19937_64 random(61);
  auto pick = test::by_area(scene);
  Photons photons;
  while (photons.size() < count) {
    const std::uint32_t triangle = pick(random);
    const glm::vec3 point = test::random_point(scene, triangle, random);
    if (point.x < lit) test::add_photon(photons, scene, point, sided(triangle, 0), random);
  }
  return sort_by_sided_triangle(std::move(photons), 2 * scene.triangle_count());
}

}  // namespace

TEST_CASE("crowding is one over the part of a surface that is lit evenly") {
  const int cells = GENERATE(1, 32);  // large triangles are divided, small ones are bins themselves
  const float lit = GENERATE(1.0f, 0.5f, 0.25f);
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells);
  const Photons photons = photons_on_part(scene, lit, 60'000);
  Patches patch;  // one for all
  patch.first_of = {0, static_cast<std::uint32_t>(scene.triangle_count())};
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    patch.members.push_back(sided(t, 0));
    patch.map_of.insert(patch.map_of.end(), {0u, 1u});
  }
  const std::vector<float> crowding = maps::photon_crowding(scene, photons, patch);
  REQUIRE(crowding.size() == 2);
  // The squared density integrates to (1 / lit)^2 lit = 1 / lit of that of photons spread evenly.
  // Bins of 16 photons and more estimate it to within a percent; those that the border of the lit
  // part cuts, one column of at least 32, blur it by at most a thirtieth.
  CAPTURE(cells, lit);
  CHECK(crowding[0] == Approx(1.0 / lit).epsilon(0.04));
  CHECK(crowding[1] == 1.0f);  // no photons on the back
}

TEST_CASE("photons one by one crowd nothing") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  for (const std::size_t count : {0u, 1u}) {
    const Photons photons = photons_on_part(scene, 1.0f, count);
    for (const float value : maps::photon_crowding(scene, photons, {})) CHECK(value == 1.0f);
  }
}

}  // namespace photile::test
