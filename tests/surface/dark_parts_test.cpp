// Parts of lit triangles that no photon reaches.
#include <catch2/catch.hpp>

#include "photon_sets.hpp"
#include "surface/dark_sides.hpp"

namespace photile::test {
namespace {

/// In the plane z = 0; the right angle comes first.
using Isosceles = std::array<glm::vec3, 3>;

glm::vec3 middle_of(const Isosceles& t) { return (t[0] + t[1] + t[2]) / 3.0f; }

std::array<Isosceles, 2> halves_of(const Isosceles& t) {
  const glm::vec3 foot = 0.5f * (t[1] + t[2]);
  return {{{foot, t[0], t[1]}, {foot, t[2], t[0]}}};
}

/// One photon in each of 2^depth equal parts.
void spread(const Isosceles& t, int depth, Photons& photons) {
  if (depth == 0) {
    photons.position.push_back(middle_of(t));
    return;
  }
  for (const Isosceles& half : halves_of(t)) spread(half, depth - 1, photons);
}

}  // namespace

TEST_CASE("ten photons on a half tell that a half of it is dark, by chance one time in 500") {
  const Isosceles whole{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  const auto [bright, dim] = halves_of(whole);
  const auto [lit, dark] = halves_of(dim);
  Scene scene = test::empty_scene();
  test::add_triangle(scene, whole[0], whole[1], whole[2]);
  const glm::vec3 above(0, 0, 1);
  test::add_triangle(scene, whole[0] + above, whole[1] + above, whole[2] + above);
  const surface::SurfaceMesh mesh(scene);
  for (const std::uint32_t on_lit : {9u, 10u}) {
    Photons photons;
    spread(bright, 6, photons);
    photons.position.insert(photons.position.end(), on_lit, middle_of(lit));
    // The next photon lies over the dark part, on the other triangle.
    const std::uint32_t own = 64 + on_lit;
    photons.position.push_back(middle_of(dark) + above);
    photons.first_of = {0, own, own, own + 1, own + 1};
    const auto parts =
        surface::find_dark_parts(mesh, photons, std::vector<std::uint8_t>(4, 0), 0.05);
    CAPTURE(on_lit);
    REQUIRE(parts.size() == (on_lit == 10 ? 1 : 0));
    for (const DarkPart& part : parts) {
      CHECK(part.sided_triangle == 0);
      CHECK(glm::distance(middle_of(part.corner), middle_of(dark)) < 1e-6f);
    }
  }
}

}  // namespace photile::test
