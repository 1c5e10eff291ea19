// Extremes of size, shape, number and power against the double-precision oracle
// (docs/reference/limits.md).
#include <bit>

#include "maps/map_store.hpp"
#include "oracle_checks.hpp"
#include "photon_sets.hpp"

namespace photile::test {
namespace {

/// A floor, a wall and a finely curved body, about 1 m wide: everything a scale is applied to.
Scene corner_with_torus(std::size_t lights = 1) {
  Scene scene = scene_of_plates(
      {{{-1, -1, -0.4f}, {2, 0, 0}, {0, 2, 0}, 2}, {{-1, -1, -0.4f}, {0, 2, 0}, {0, 0, 1}, 1}},
      lights);
  add_torus(scene, 0.5f, 0.2f, 12, 6);
  return scene;
}

void scale(std::vector<glm::vec3>& positions, float factor) {
  for (glm::vec3& position : positions) position *= factor;
}

/// Photons at the given places on triangle 0, with random flux.
Photons photons_at(const Scene& scene, const std::vector<glm::vec3>& places, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Photons photons;
  for (const glm::vec3& place : places) add_photon(photons, scene, place, 0, random);
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

PhotileGrid first_grid(const PhotonMaps& maps) {
  PhotileGrid grid{};
  device::context_of(device()).read(maps::store_of(maps).pages.use(0).grids, std::span(&grid, 1));
  return grid;
}

}  // namespace

TEST_CASE("extremes: scenes of 1e-6 to 1e6 times the size of a room", "[slow]") {
  for (const float factor : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f}) {
    Scene scene = corner_with_torus();
    scale(scene.vertices, factor);
    const Photons photons = uniform_photons(scene, 1500, 101);
    const PrimaryHits hits = uniform_hits(scene, 60, 102);
    CAPTURE(factor);
    check_against_oracle(scene, photons, hits, 0.25 * factor, {1, 8, 50}, true);
  }
}

TEST_CASE("extremes: a scale by a power of two changes no bit but the exponent") {
  const auto estimate = [](float factor) {
    Scene scene = corner_with_torus();
    Photons photons = uniform_photons(scene, 20'000, 103);
    PrimaryHits hits = uniform_hits(scene, 500, 104);
    scale(scene.vertices, factor);
    scale(photons.position, factor);
    scale(hits.position, factor);
    const double radius = 0.125 * static_cast<double>(factor);
    const PhotonMaps maps(device(), scene, photons,
                          find_map_groups(scene, photons, MapMode::automatic, {radius, 60}),
                          {radius});
    return Estimator(maps, scene, {50, 0}).estimate(hits).irradiance;
  };
  const auto expected = estimate(1.0f);
  for (const float factor : {0x1p-20f, 0x1p20f}) {
    const auto scaled = estimate(factor);
    REQUIRE(scaled.size() == expected.size());
    std::size_t differences = 0;
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      differences += scaled[i] * (factor * factor) != expected[i];
    }
    CAPTURE(factor);
    CHECK(differences == 0);
  }
}

TEST_CASE("extremes: the automatic radius follows the scale") {
  const Scene scene = corner_with_torus();
  Photons photons = uniform_photons(scene, 20'000, 105);
  const double radius = automatic_radius(photons, 50);
  for (const float factor : {0x1p-20f, 0x1p20f}) {
    Photons scaled = photons;
    scale(scaled.position, factor);
    CHECK(automatic_radius(scaled, 50) == radius * static_cast<double>(factor));
  }
}

TEST_CASE("extremes: needles a million times as long as wide, and the plates beside them",
          "[slow]") {
  Scene scene = empty_scene();
  // A strip of needles between two plates: level, where every product is exact, and askew.
  const glm::vec3 along = GENERATE(glm::vec3(1, 0, 0), glm::vec3(0.6f, 0.48f, 0.64f),
                                   glm::vec3(-0.36f, 0.48f, 0.8f), glm::vec3(0.8f, -0.36f, 0.48f));
  const glm::vec3 across = along.y == 0
                               ? glm::vec3(0, 1, 0)
                               : glm::normalize(glm::cross(along, glm::vec3(0.3f, 1, 0.2f)));
  constexpr int needles = 8;
  constexpr float width = 1e-6f;
  for (int i = 0; i < needles; ++i) {
    const float y = static_cast<float>(i) * width;
    add_triangle(scene, y * across, along + y * across, along + (y + width) * across);
    add_triangle(scene, along + y * across, 0.37f * along + (y + width) * across, y * across);
  }
  add_plate(scene, -0.5f * across, along, 0.5f * across, 1);
  add_plate(scene, needles * width * across, along, 0.5f * across, 1);
  Photons photons = uniform_photons(scene, 4000, 106, false);
  PrimaryHits hits = uniform_hits(scene, 60, 107, false);
  // By area the needles would get none.
  std::mt19937_64 random(108);
  for (std::uint32_t t = 0; t < 2 * needles; ++t) {
    for (int i = 0; i < 60; ++i) {
      add_photon(photons, scene, random_point(scene, t, random), oriented(t, 0), random);
    }
    for (int i = 0; i < 6; ++i) {
      hits.position.push_back(random_point(scene, t, random));
      hits.oriented_face.push_back(oriented(t, 0));
    }
  }
  photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
  hits.pixel.resize(hits.position.size());
  for (const double radius : {1e-7, 1e-3, 0.05}) {
    check_against_oracle(scene, photons, hits, radius, {1, 16, 200}, false);
  }
}

TEST_CASE("extremes: fans of needles with a common tip, tilted against each other", "[slow]") {
  Scene scene = empty_scene();
  // A flat cone of 1024 slivers around its tip, and a plate just above it: photons of the plate
  // project into faces, and reach them or not by their height alone.
  constexpr int slivers = 1024;
  const auto rim = [](int i) {
    const double angle = 2 * glm::pi<double>() * i / slivers;
    return glm::vec3(std::cos(angle), std::sin(angle), 0.1);
  };
  for (int i = 0; i < slivers; ++i) add_triangle(scene, {0, 0, 0}, rim(i), rim(i + 1));
  add_plate(scene, {-1, -1, 0.15f}, {2, 0, 0}, {0, 2, 0}, 1);
  const Photons photons = uniform_photons(scene, 8000, 109, false);
  const PrimaryHits hits = uniform_hits(scene, 60, 110, false);
  check_against_oracle(scene, photons, hits, 0.1, {16, 500}, true);
}

TEST_CASE("extremes: surfaces less than a float's rounding apart count as one") {
  Scene scene = empty_scene();
  const float z = 1.0f, above = std::nextafter(z, 2.0f);
  add_plate(scene, {0, 0, z}, {1, 0, 0}, {0, 1, 0}, 2);
  add_plate(scene, {0, 0, z}, {1, 0, 0}, {0, 1, 0}, 1);      // the same plane
  add_plate(scene, {0, 0, above}, {1, 0, 0}, {0, 1, 0}, 2);  // one float above
  add_plate(scene, {0, 0, z}, {0, 1, 0}, {1, 0, 0}, 1);      // and one that faces down
  const Photons photons = uniform_photons(scene, 5000, 111);
  const PrimaryHits hits = uniform_hits(scene, 100, 112);
  check_against_oracle(scene, photons, hits, 0.15, {1, 50}, true);
}

TEST_CASE("extremes: a million photons in one point", "[slow]") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  const glm::vec3 point(0.5f, 0.25f, 0);
  std::vector<glm::vec3> places(1'000'000, point);
  std::mt19937_64 random(113);
  for (int i = 0; i < 1000; ++i) places.push_back(random_point(scene, 0, random));
  const Photons photons = photons_at(scene, places, 114);
  PrimaryHits hits = uniform_hits(scene, 3, 115, false);
  hits.position[0] = point;
  hits.oriented_face.assign(hits.size(), 0);
  for (std::size_t i = 1; i < hits.size(); ++i) {
    hits.position[i] = random_point(scene, 0, random);
  }
  check_against_oracle(scene, photons, hits, 0.2, {50}, false);
}

TEST_CASE("extremes: no photon and one photon") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  const PrimaryHits hits = uniform_hits(scene, 50, 116);
  for (const std::size_t count : {0u, 1u}) {
    const Photons photons = uniform_photons(scene, count, 117);
    check_against_oracle(scene, photons, hits, 0.5, {1, 50}, true);
  }
}

TEST_CASE("extremes: the second photon at a distance that selection compares with") {
  Scene scene = empty_scene();
  add_triangle(scene, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const float radius = 0.5f;
  // Selection tells eighths of octaves below the radius apart: kernels/estimate/histogram.clh.
  const int octave_eighth = GENERATE(1, 3, 6);
  const int bits = std::bit_cast<int>(radius * radius) + 1 - (octave_eighth << 20);
  const float first = std::sqrt(std::bit_cast<float>(bits - (1 << 18)));
  const auto second = std::bit_cast<float>(bits);
  // Coordinates whose squares, each rounded, add up to just that.
  float x = 0, y = 0x1p-8f;
  for (int i = 0; i < 1000 && x * x + y * y != second; ++i) {
    y *= 1.001f;
    x = std::sqrt(second - y * y);
  }
  REQUIRE(x * x + y * y == second);
  const Photons photons = photons_at(scene, {{0, -first, 0}, {x, y, 0}}, 129);
  PrimaryHits hits;
  hits.position.emplace_back(0.0f);
  hits.oriented_face.push_back(0);
  hits.pixel.resize(1);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius});
  const LightTable estimates =
      Estimator(maps, scene, {.neighbours = 1, .area = AreaMode::disc}).estimate(hits);
  // The density of the nearer photon, over the disc through it.
  const double area = glm::pi<double>() * first * first;
  CHECK(estimates.irradiance.at(0).g == Approx(photons.flux[0].g / area).epsilon(1e-6));
}

TEST_CASE("extremes: k of 1, of all photons and of more, in a radius as large as the scene",
          "[slow]") {
  const Scene scene = corner_with_torus();
  const Photons photons = uniform_photons(scene, 2000, 118);
  const PrimaryHits hits = uniform_hits(scene, 60, 119);
  for (const double radius : {1e-5, 4.0, 1e3}) {
    check_against_oracle(scene, photons, hits, radius, {1, 1999, 2000, 2001}, true);
  }
}

TEST_CASE("extremes: photons and hits on corners, edges and cell borders, and on the radius") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2}});
  // A lattice of sixty-fourths: on every edge and corner of the triangles, many pairs at exactly
  // the radius, many ties; a second set moved by a few roundings to either side.
  Photons photons;
  PrimaryHits hits;
  std::mt19937_64 random(120);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    for (int i = 0; i <= 16; ++i) {
      for (int j = 0; i + j <= 16; ++j) {
        const glm::vec3 place = a + (b - a) * (static_cast<float>(i) / 16.0f) +
                                (c - a) * (static_cast<float>(j) / 16.0f);
        add_photon(photons, scene, place, oriented(t, 0), random);
        const float jitter = static_cast<float>(static_cast<int>(random() % 9) - 4) * 0x1p-24f;
        add_photon(photons, scene, place + glm::vec3(jitter, -jitter, 0), oriented(t, 0), random);
        if ((i + j) % 4 == 0) {
          hits.position.push_back(place);
          hits.oriented_face.push_back(oriented(t, 0));
        }
      }
    }
  }
  hits.pixel.resize(hits.size());
  photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
  for (const double radius : {0x1p-5, 0.5}) {
    check_against_oracle(scene, photons, hits, radius, {1, 50}, false);
  }
}

TEST_CASE("extremes: photons within a rounding of the borders of cells") {
  Scene scene = empty_scene();
  add_triangle(scene, {0, 0, 0}, {2, 0, 0}, {1, 1, 0});  // u runs along x
  const double radius = 0.25, width = 0x1p-6;
  const auto grid_of = [&](const Photons& photons, float photons_per_cell) {
    const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                          {radius, photons_per_cell});
    return first_grid(maps);
  };
  const PhotileGrid frame = grid_of(uniform_photons(scene, 10, 124, false), 4);
  REQUIRE(std::abs(frame.u_axis_x) == 1);
  // On the corners of cells that are to be of that width, moved by some roundings.
  std::mt19937_64 random(125);
  const auto jitter = [&] {
    return static_cast<float>(static_cast<int>(random() % 65) - 32) * 0x1p-26f;
  };
  std::vector<glm::vec3> places;
  for (int i = 0; i < 160; ++i) {
    for (int j = 0; j < 40; ++j) {
      const double u = frame.minimum_u + i * width;
      const double v = frame.minimum_v + j * PHOTILE_CELL_ASPECT * width;
      const glm::vec3 place(frame.origin_x + u * frame.u_axis_x + v * frame.v_axis_x,
                            frame.origin_y + u * frame.u_axis_y + v * frame.v_axis_y, 0);
      if (place.y <= 0 || place.y >= std::min(place.x, 2 - place.x)) continue;
      for (int n = 0; n < 4; ++n) places.push_back(place + glm::vec3(jitter(), jitter(), 0));
    }
  }
  const Photons photons = photons_at(scene, places, 126);
  // The area of cells is in proportion to the photons that they are to hold.
  const double ratio = width / grid_of(photons, 4).cell_width;
  const auto photons_per_cell = static_cast<float>(4 * ratio * ratio);
  REQUIRE(grid_of(photons, photons_per_cell).cell_width == Approx(width).epsilon(1e-6));
  PrimaryHits hits;
  for (std::size_t i = 0; i < photons.size(); i += 37) hits.position.push_back(photons.position[i]);
  hits.oriented_face.assign(hits.size(), 0);
  hits.pixel.resize(hits.size());
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, photons_per_cell});
  for (const int k : {1, 4, 5, 50, 500}) {
    CAPTURE(k, hits.size());
    CHECK(count_differences(hits, Estimator(maps, scene, {k, 0}).nearest(hits), oracle, photons,
                            static_cast<float>(radius)) == 0);
  }
}

TEST_CASE("extremes: photons within the radius by less than rounding moves them across cells") {
  // Single precision places points of a triangle of a kilometre to a tenth of a millimetre. Pairs
  // of a photon on a border of cells and a hit just within the radius from it: the cells that the
  // hit looks at have to reach across the border.
  const glm::dvec3 x = glm::normalize(glm::dvec3(0.6, 0.48, 0.64));
  const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(0.3, 1, 0.2)));
  const double length = 1000, height = 60, radius = 1;
  Scene scene = empty_scene();
  add_triangle(scene, {0, 0, 0}, glm::vec3(length * x), glm::vec3(0.5 * length * x + height * y));
  const auto maps_of = [&](const Photons& photons) {
    // So few photons for a cell that the bound on cells decides their size.
    return PhotonMaps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                      {radius, 1e-8f});
  };
  const PhotileGrid grid =
      first_grid(maps_of(photons_at(scene, {glm::vec3(0.5 * length * x)}, 127)));
  const glm::dvec3 origin(grid.origin_x, grid.origin_y, grid.origin_z);
  const glm::dvec3 u(grid.u_axis_x, grid.u_axis_y, grid.u_axis_z);
  const glm::dvec3 v(grid.v_axis_x, grid.v_axis_y, grid.v_axis_z);
  std::vector<glm::vec3> places;
  PrimaryHits hits;
  for (double along = 50; along < length - 50; along += 3) {
    for (double up = 2; up < 0.8 * height * (1 - std::abs(2 * along / length - 1)); up += 3) {
      const double column = std::round((along - grid.minimum_u) / grid.cell_width);
      const double border = grid.minimum_u + column * grid.cell_width;
      const glm::vec3 photon(origin + border * u + up * v);
      const double side = places.size() % 2 == 0 ? 1 : -1;
      const glm::vec3 hit(glm::dvec3(photon) + side * (radius - 1e-5) * u);
      if (!(glm::distance(glm::dvec3(photon), glm::dvec3(hit)) < radius * (1 - 1e-6))) continue;
      places.push_back(photon);
      hits.position.push_back(hit);
    }
  }
  REQUIRE(hits.size() > 1000);
  hits.oriented_face.assign(hits.size(), 0);
  hits.pixel.resize(hits.size());
  const Photons photons = photons_at(scene, places, 128);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const PhotonMaps maps = maps_of(photons);
  REQUIRE(first_grid(maps).cell_width == grid.cell_width);
  CHECK(count_differences(hits, Estimator(maps, scene, {4, 0}).nearest(hits), oracle, photons,
                          radius) == 0);
}

TEST_CASE("extremes: photons of 1e-12 to 1e12 units of flux in one map") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  Photons photons = uniform_photons(scene, 3000, 121);
  std::mt19937_64 random(122);
  std::uniform_real_distribution<float> exponent(-12, 12);
  for (glm::vec3& flux : photons.flux) flux *= std::pow(10.0f, exponent(random));
  const PrimaryHits hits = uniform_hits(scene, 100, 123);
  check_against_oracle(scene, photons, hits, 0.2, {1, 50}, true);
}

}  // namespace photile::test
