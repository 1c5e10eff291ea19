// The k nearest photons of every hit against brute force in double precision.

#include "neighbour_comparison.hpp"
#include "photile/errors.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

void check_neighbours(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                      double radius, std::initializer_list<int> neighbour_counts,
                      float photons_per_cell = 4) {
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  for (const structures::Structure& structure : structures::all()) {
    const PhotonMaps maps =
        structures::build(structure, device(), scene, photons, groups, {radius, photons_per_cell});
    for (const int k : neighbour_counts) {
      Estimator estimator(maps, scene, {k, 0});
      CAPTURE(structure.name, k, radius, photons_per_cell, photons.size());
      CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons,
                              static_cast<float>(radius)) == 0);
    }
  }
}

Scene plate(int cells) { return scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells}}); }

}  // namespace

void check_on_plate(std::initializer_list<int> neighbour_counts) {
  const Scene scene = plate(2);
  for (const std::size_t count : {0u, 1u, 7u, 93u, 4096u}) {
    const Photons photons = uniform_photons(scene, count, 21 + count);
    check_neighbours(scene, photons, uniform_hits(scene, 200, 22), 0.25, neighbour_counts);
  }
}

TEST_CASE("neighbours equal the oracle's on a plate, for few and many photons") {
  check_on_plate({1, 50, 5000});
}
TEST_CASE("neighbours equal the oracle's on a plate, for any k", "[slow]") {
  check_on_plate({2, 7, 16, 200});
}

TEST_CASE("neighbours equal the oracle's on a torus with triangles smaller than the radius") {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 48, 24);
  const Photons photons = uniform_photons(scene, 20'000, 23);
  check_neighbours(scene, photons, uniform_hits(scene, 300, 24), 0.2, {1, 16, 50, 200});
}

TEST_CASE("regions that meet at just the angle count alike in every structure") {
  // Hexagonal prisms a few metres off, so small that rounding their vertices tilts the regions by
  // 1e-5: the cosines of their angles fall to either side of the bound.
  Scene scene = empty_scene();
  std::mt19937 random(44);
  std::uniform_real_distribution<float> uniform(2.0f, 5.0f);
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 centre(uniform(random), uniform(random), uniform(random));
    const auto corner = [&](int j) {
      const float angle = glm::pi<float>() / 3 * static_cast<float>(j) + static_cast<float>(i);
      return centre + 0.02f * glm::vec3(std::cos(angle), std::sin(angle), 0);
    };
    for (int j = 0; j < 6; ++j) {
      add_plate(scene, corner(j), corner(j + 1) - corner(j), {0, 0, 0.02f}, 1);
    }
  }
  const Photons photons = uniform_photons(scene, 20'000, 42);
  check_neighbours(scene, photons, uniform_hits(scene, 2000, 43), 0.02, {16});
}

TEST_CASE("neighbours equal the oracle's where three plates meet and two lie back to back") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3},
                                 {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2},
                                 {{0, 0, 0}, {0.7f, 0.7f, 0.5f}, {0, 0, 1}, 2},
                                 {{0, 0, -0.01f}, {0, 1, 0}, {1, 0, 0}, 1}});
  const Photons photons = uniform_photons(scene, 15'000, 25);
  check_neighbours(scene, photons, uniform_hits(scene, 400, 26), 0.3, {1, 16, 50, 300});
}

TEST_CASE("the cell size changes no neighbour") {
  const Scene scene = plate(3);
  const Photons photons = uniform_photons(scene, 5000, 27);
  const PrimaryHits hits = uniform_hits(scene, 200, 28);
  for (const float photons_per_cell : {0.1f, 1.0f, 16.0f, 1e6f}) {
    check_neighbours(scene, photons, hits, 0.2, {1, 50}, photons_per_cell);
  }
}

TEST_CASE("a radius as large as the scene and a tiny one find what the oracle finds") {
  const Scene scene = plate(3);
  const Photons photons = uniform_photons(scene, 3000, 29);
  const PrimaryHits hits = uniform_hits(scene, 200, 30);
  check_neighbours(scene, photons, hits, 3.0, {1, 50, 2000});
  check_neighbours(scene, photons, hits, 1e-4, {1, 50});
}

TEST_CASE("crowded photons: all in one point, all on a line, one crowd and many loners") {
  const Scene scene = plate(2);
  std::mt19937_64 random(31);
  Photons point, line, crowd;
  for (int i = 0; i < 3000; ++i) {
    add_photon(point, scene, {0.4f, 0.2f, 0}, 0, random);
    add_photon(line, scene, {0.2f + static_cast<float>(i) / 10'000.0f, 0.125f, 0}, 0, random);
    const bool loner = i % 10 == 0;
    add_photon(crowd, scene, loner ? random_point(scene, 0, random) : glm::vec3(0.3f, 0.1f, 0), 0,
               random);
  }
  PrimaryHits hits = uniform_hits(scene, 100, 32, false);
  // Hits on the crowds themselves, on triangle 0.
  for (int i = 0; i < 10; ++i) hits.position[static_cast<std::size_t>(i)] = {0.3f, 0.1f, 0};
  for (Photons* photons : {&point, &line, &crowd}) {
    const Photons sorted = sort_by_oriented_face(std::move(*photons), 2 * scene.triangle_count());
    check_neighbours(scene, sorted, hits, 0.4, {1, 16, 50, 2999, 3000, 3001});
  }
}

TEST_CASE("the radius is that of the k-th photon, however close behind it the next one lies") {
  const Scene scene = plate(1);
  // Squares that are neighbouring floats, seen from the origin.
  float near = 0.1f, far = std::nextafter(near, 1.0f);
  while (far * far != std::nextafter(near * near, 1.0f)) {
    near = far;
    far = std::nextafter(near, 1.0f);
  }
  std::mt19937_64 random(45);
  Photons photons;
  add_photon(photons, scene, {near, 0, 0}, 0, random);
  add_photon(photons, scene, {far, 0, 0}, 0, random);
  photons = sort_by_oriented_face(std::move(photons), 4);
  PrimaryHits hits = uniform_hits(scene, 1, 46, false);
  hits.position[0] = {0, 0, 0};
  hits.oriented_face[0] = 0;
  for (const structures::Structure& structure : structures::all()) {
    const PhotonMaps maps = structures::build(structure, device(), scene, photons,
                                              find_neighbour_groups(scene, {0.2, 60}), {0.2, 4});
    CAPTURE(structure.name);
    CHECK(Estimator(maps, scene, {1, 0}).nearest(hits).squared_radius[0] == near * near);
    CHECK(Estimator(maps, scene, {2, 0}).nearest(hits).squared_radius[0] == far * far);
  }
}

TEST_CASE("ties at the border of the neighbourhood go to the smallest photon indices") {
  const Scene scene = plate(1);
  std::mt19937_64 random(33);
  Photons photons;
  // A ring of equal distances: exact in binary.
  const glm::vec3 centre(0.5f, 0.25f, 0);
  for (int i = 0; i < 40; ++i) {
    const float dx = (i & 1) != 0 ? 0.0625f : -0.0625f;
    const float dy = (i & 2) != 0 ? 0.03125f : -0.03125f;
    add_photon(photons, scene, centre + glm::vec3(dx, dy, 0), 0, random);
  }
  photons = sort_by_oriented_face(std::move(photons), 4);
  PrimaryHits hits = uniform_hits(scene, 1, 34, false);
  hits.position[0] = centre;
  hits.oriented_face[0] = 0;
  for (const structures::Structure& structure : structures::all()) {
    const PhotonMaps maps = structures::build(structure, device(), scene, photons,
                                              find_neighbour_groups(scene, {0.2, 60}), {0.2, 4});
    for (const int k : {1, 7, 39, 40}) {
      Estimator estimator(maps, scene, {k, 0});
      const NeighbourLists lists = estimator.nearest(hits);
      CAPTURE(structure.name, k);
      for (int i = 0; i < k; ++i) {
        CHECK(lists.photons[static_cast<std::size_t>(i)] == static_cast<std::uint32_t>(i));
      }
    }
  }
}

TEST_CASE("naive maps find the oracle's neighbours on the hit's own oriented face") {
  const Scene scene = plate(3);
  const Photons photons = uniform_photons(scene, 5000, 35);
  const PrimaryHits hits = uniform_hits(scene, 200, 36);
  const PhotonMaps maps(device(), scene, photons, naive_groups(scene), {0.2, 4});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::naive, 60);
  Estimator estimator(maps, scene, {50, 0});
  CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons, 0.2f) == 0);
}

TEST_CASE("photons at the back and beyond the angle never count") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  add_plate(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1);  // perpendicular
  const Photons photons = uniform_photons(scene, 4000, 37);
  const PrimaryHits hits = uniform_hits(scene, 200, 38);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {0.3, 60}),
                        {0.3, 4});
  Estimator estimator(maps, scene, {50, 0});
  const NeighbourLists lists = estimator.nearest(hits);
  std::size_t neighbours = 0;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const std::uint32_t own = hits.oriented_face[hit];
    for (std::size_t i = 0; i < 50; ++i) {
      const std::uint32_t photon = lists.photons[hit * 50 + i];
      if (photon == none) continue;
      ++neighbours;
      const std::uint32_t other = photons.oriented_face[photon];
      CHECK(side_of(other) == side_of(own));
      CHECK(triangle_of(other) / 2 == triangle_of(own) / 2);  // the same plate
    }
  }
  CHECK(neighbours > 10 * hits.size());
}

TEST_CASE("far from the origin, neighbours equal the oracle's on the stored positions") {
  Scene scene = scene_of_plates({{{148376, 1234, -223423}, {40, 0, 10}, {0, 40, 10}, 3}});
  const Photons photons = uniform_photons(scene, 5000, 39);
  check_neighbours(scene, photons, uniform_hits(scene, 200, 40), 6, {1, 16, 50});
}

TEST_CASE("k and radius out of range are refused") {
  const Scene scene = plate(1);
  const Photons photons = uniform_photons(scene, 10, 41);
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {0.1, 60}),
                        {0.1, 4});
  CHECK_THROWS_AS(Estimator(maps, scene, {0, 0}), UsageError);
  CHECK_THROWS_AS(Estimator(maps, scene, {-3, 0}), UsageError);
  CHECK_THROWS_AS(Estimator(maps, scene, {50, 0.2}), UsageError);
  CHECK_THROWS_AS(Estimator(maps, scene, {50, -0.1}), UsageError);
}

}  // namespace photile::test
