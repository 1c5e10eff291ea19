// Neighbour groups, their radius and patches.
#include "photile/neighbour_groups.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <limits>

#include "meshes.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::test {
namespace {

glm::dvec3 normal_of(const Scene& scene, std::uint32_t oriented_face) {
  const Corners c = corners_of(scene, triangle_of(oriented_face));
  const glm::dvec3 normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
  return side_of(oriented_face) == 0 ? normal : -normal;
}

/// Every pair, straight from the definition.
NeighbourGroups all_pairs(const Scene& scene, const NeighbourGroupParameters& parameters) {
  const double cos_angle = std::cos(glm::radians(parameters.angle_degrees));
  NeighbourGroups groups;
  groups.offsets.push_back(0);
  const auto count = static_cast<std::uint32_t>(2 * scene.triangle_count());
  for (std::uint32_t s = 0; s < count; ++s) {
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t a = triangle_of(std::min(s, t)), b = triangle_of(std::max(s, t));
      const bool agrees =
          s == t || glm::dot(normal_of(scene, s), normal_of(scene, t)) >= cos_angle - 1e-6;
      if (agrees && triangle_triangle_distance(corners_of(scene, a), corners_of(scene, b)) <=
                        parameters.radius) {
        groups.members.push_back(t);
      }
    }
    groups.offsets.push_back(groups.members.size());
  }
  return groups;
}

void check_against_all_pairs(const Scene& scene, double radius, double angle_degrees) {
  CAPTURE(scene.triangle_count(), radius, angle_degrees);
  const NeighbourGroupParameters parameters{radius, angle_degrees};
  const NeighbourGroups expected = all_pairs(scene, parameters);
  const NeighbourGroups found = find_neighbour_groups(scene, parameters);
  CHECK(found.offsets == expected.offsets);
  CHECK(found.members == expected.members);
  CHECK(found.radius == radius);
  CHECK(found.angle_degrees == angle_degrees);
}

bool is_member(const NeighbourGroups& groups, std::uint32_t of, std::uint32_t member) {
  const auto group = groups.of(of);
  return std::binary_search(group.begin(), group.end(), member);
}

/// Two quads that share an edge; the second is folded down by `fold_degrees`. Triangles 0 and 1 are
/// the first quad, 2 and 3 the second; side 0 is the upper side of both.
Scene folded_strip(double fold_degrees) {
  const double fold = glm::radians(fold_degrees);
  const double x = std::cos(fold), z = -std::sin(fold);
  Scene scene;
  scene.vertices = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {x, 0, z}, {x, 1, z}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  return whole(std::move(scene));
}

TEST_CASE("neighbour groups equal all pairs on random soups of mixed sizes") {
  const double radius = GENERATE(1e-4, 0.02, 0.1, 0.5, 3.0);
  const double angle = GENERATE(0.0, 30.0, 60.0, 90.0, 135.0, 180.0);
  check_against_all_pairs(random_soup(11, 150, 1.0, 0.05), radius, angle);
}

TEST_CASE("neighbour groups equal all pairs far from the origin and at small and large scales") {
  check_against_all_pairs(random_soup(5, 150, 1.0, 0.05, glm::dvec3(5e4, -2e4, 1e4)), 0.1, 60);
  check_against_all_pairs(random_soup(6, 150, 1e-5, 5e-7), 1e-6, 60);
  check_against_all_pairs(random_soup(7, 150, 1e5, 5e3), 1e4, 60);
}

TEST_CASE("neighbour groups equal all pairs on a sphere with needles at its poles") {
  const double radius = GENERATE(0.01, 0.2);
  const double angle = GENERATE(20.0, 60.0);
  check_against_all_pairs(sphere(14), radius, angle);
}

TEST_CASE("neighbour groups equal all pairs on a grid whose distances equal the radius") {
  // Cells of 1/8 m: distances are exact in floating point, many of them exactly the radius.
  check_against_all_pairs(height_field(10, 1.25, [](double, double) { return 0.0; }), 0.25, 60);
}

TEST_CASE("neighbour groups equal all pairs on walls among pencils") {
  Scene scene = random_soup(9, 200, 4.0, 0.01);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 u(0), v(0);
    u[(axis + 1) % 3] = 4, v[(axis + 2) % 3] = 4;
    add_triangle(scene, {glm::dvec3(0), u, u + v});
    add_triangle(scene, {glm::dvec3(0), u + v, v});
  }
  check_against_all_pairs(scene, 0.1, 60);
}

TEST_CASE("a fold joins equal sides up to the angle and opposite sides from its supplement on") {
  const double fold = GENERATE(0.0, 59.0, 60.0, 61.0, 90.0, 119.0, 120.0, 121.0, 180.0);
  const double angle = GENERATE(0.0, 59.0, 60.0, 61.0, 90.0, 180.0);
  CAPTURE(fold, angle);
  const NeighbourGroups groups = find_neighbour_groups(folded_strip(fold), {0.5, angle});
  CHECK(is_member(groups, oriented(0, 0), oriented(3, 0)) == (fold <= angle));
  CHECK(is_member(groups, oriented(0, 1), oriented(3, 1)) == (fold <= angle));
  CHECK(is_member(groups, oriented(0, 0), oriented(3, 1)) == (180 - fold <= angle));
  CHECK(is_member(groups, oriented(0, 1), oriented(3, 0)) == (180 - fold <= angle));
  CHECK(is_member(groups, oriented(0, 0), oriented(1, 0)));
  CHECK(is_member(groups, oriented(0, 0), oriented(0, 1)) == (angle == 180));
}

TEST_CASE("plates are neighbours up to the radius, on the sides that face the same way") {
  Scene scene;
  for (const float z : {0.0f, 0.25f, 0.5f + 0x1p-20f}) {
    add_triangle(scene, {glm::dvec3(0, 0, z), glm::dvec3(1, 0, z), glm::dvec3(0, 1, z)});
  }
  const NeighbourGroups groups = find_neighbour_groups(scene, {0.25, 60});
  const std::vector<std::uint32_t> members(groups.of(oriented(0, 0)).begin(),
                                           groups.of(oriented(0, 0)).end());
  CHECK(members == std::vector<std::uint32_t>{oriented(0, 0), oriented(1, 0)});
  CHECK(is_member(groups, oriented(1, 1), oriented(0, 1)));
  CHECK_FALSE(is_member(groups, oriented(1, 0), oriented(2, 0)));
}

TEST_CASE("neighbour groups are symmetric, ascending and hold their owner") {
  const Scene scene = random_soup(21, 400, 1.0, 0.04);
  const NeighbourGroups groups = find_neighbour_groups(scene, {0.1, 75});
  bool symmetric = true, ascending = true, own = true;
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    const auto group = groups.of(s);
    own = own && is_member(groups, s, s);
    ascending = ascending && std::is_sorted(group.begin(), group.end(), std::less_equal<>());
    for (const std::uint32_t member : group) symmetric = symmetric && is_member(groups, member, s);
  }
  CHECK(symmetric);
  CHECK(ascending);
  CHECK(own);
}

TEST_CASE("neighbour groups do not depend on the number of threads") {
  const Scene scene = height_field(
      60, 3.0, [](double x, double y) { return 0.2 * std::sin(3 * x) * std::cos(4 * y); });
  NeighbourGroups first;
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const NeighbourGroups groups = find_neighbour_groups(scene, {0.2, 60});
    if (threads == 1) first = groups;
    CHECK(groups.offsets == first.offsets);
    CHECK(groups.members == first.members);
  }
}

TEST_CASE("a triangle without area is in its own groups and joins no other below 90 degrees") {
  Scene scene;
  add_triangle(scene, {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)});
  add_triangle(scene, {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(2, 0, 0)});
  const NeighbourGroups groups = find_neighbour_groups(scene, {1, 60});
  CHECK(groups.offsets == std::vector<std::uint64_t>{0, 1, 2, 3, 4});
  CHECK(groups.members == std::vector<std::uint32_t>{0, 1, 2, 3});
}

TEST_CASE("naive groups hold their owner alone") {
  const Scene scene = random_soup(3, 7, 1, 0.1);
  const NeighbourGroups groups = naive_groups(scene);
  REQUIRE(groups.offsets.size() == 15);
  for (std::uint32_t s = 0; s < 14; ++s) {
    REQUIRE(groups.of(s).size() == 1);
    CHECK(groups.of(s)[0] == s);
  }
}

TEST_CASE("a scene without triangles has no groups") {
  CHECK(find_neighbour_groups(Scene{}, {1, 60}).offsets == std::vector<std::uint64_t>{0});
  CHECK(naive_groups(Scene{}).offsets == std::vector<std::uint64_t>{0});
}

TEST_CASE("neighbour groups refuse radii and angles out of range") {
  const Scene scene = random_soup(1, 3, 1, 0.1);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double radius : {0.0, -1.0, infinity, std::nan("")}) {
    CHECK_THROWS_AS(find_neighbour_groups(scene, {radius, 60}), UsageError);
  }
  for (const double angle : {-1e-9, 180.0001, infinity, std::nan("")}) {
    CHECK_THROWS_AS(find_neighbour_groups(scene, {1, angle}), UsageError);
  }
}

TEST_CASE("neighbour groups report every triangle as progress and stop when asked to") {
  struct Counter : Progress {
    std::atomic<std::uint64_t> done{0};
    std::uint64_t total = 0;
    bool stop = false;
    void begin(std::string_view, std::uint64_t count, std::string_view) override { total = count; }
    void advance(std::uint64_t count) override { done += count; }
    bool cancelled() const override { return stop; }
  } counter;
  const Scene scene = random_soup(2, 1000, 10, 0.1);
  find_neighbour_groups(scene, {0.1, 60}, counter);
  CHECK(counter.total == 1000);
  CHECK(counter.done == 1000);
  counter.stop = true;
  CHECK_THROWS_AS(find_neighbour_groups(scene, {0.1, 60}, counter), Interrupted);
}

TEST_CASE("a radius that joins everything is refused before memory runs out", "[slow]") {
  // 2 x 2 x n^2 members at 180 degrees.
  const auto count = static_cast<int>(1.02 * std::sqrt(limits::max_group_members / 4.0));
  CHECK_THROWS_AS(find_neighbour_groups(random_soup(4, count, 1, 0.01), {10, 180}), UsageError);
}

// Photons uniform on the unit sphere: the cap within the chord r has the area pi r^2 exactly
// (Archimedes) and there is no border, so r_k^2 / 4 has the distribution Beta(k, N - k) and the
// median (k - 1/3) / (N - 2/3) (Kerman 2011).

Photons photons_on_sphere(std::size_t count, double radius = 1) {
  Uniform uniform(count);
  Photons photons;
  for (std::size_t i = 0; i < count; ++i) {
    photons.position.emplace_back(radius * uniform.direction());
  }
  return photons;
}

double expected_radius(double count, double k) {
  return defaults::radius_over_median_kth_distance *
         std::sqrt(4 * (k - 1.0 / 3) / (count - 2.0 / 3));
}

/// Relative standard deviation of the root of the median of `queries` values of Gamma(rank):
/// sqrt(pi / 2) / sqrt(queries) for the median of a normal law, half of 1 / sqrt(rank) for the
/// root.
double deviation(double rank, double queries = 1024) {
  return 0.5 * std::sqrt(M_PI / 2) / std::sqrt(rank * queries);
}

TEST_CASE("automatic radius is the median distance to the k-th photon by the Beta law") {
  const int k = GENERATE(5, 16, 50, 200);
  CAPTURE(k);
  const double found = automatic_radius(photons_on_sphere(100'000), k);
  CHECK(found == Approx(expected_radius(100'000, k)).epsilon(4 * deviation(k)));
}

TEST_CASE("automatic radius of many photons follows the Beta law through the subsample") {
  // A quarter to an eighth of the photons are kept, so about the 6th stands for the 50th.
  const double found = automatic_radius(photons_on_sphere(2'000'000), 50);
  CHECK(found == Approx(expected_radius(2'000'000, 50)).epsilon(4 * deviation(6)));
}

TEST_CASE("automatic radius scales with the scene") {
  const double unit = automatic_radius(photons_on_sphere(20'000), 50);
  CHECK(automatic_radius(photons_on_sphere(20'000, 1024), 50) == Approx(1024 * unit).epsilon(1e-6));
}

TEST_CASE("automatic radius of two photons is twice their distance, extrapolated for greater k") {
  Photons photons;
  photons.position = {{0, 0, 0}, {3, 4, 0}};
  CHECK(automatic_radius(photons, 1) == Approx(10).epsilon(1e-6));
  // Median of Gamma(1) is ln 2; of Gamma(50) 49.667.
  const double expected = 10 * std::sqrt(49.667 / std::log(2));
  CHECK(automatic_radius(photons, 50) == Approx(expected).epsilon(0.01));
}

TEST_CASE("automatic radius needs two photons apart and a k within its limits") {
  Photons photons;
  CHECK_THROWS_AS(automatic_radius(photons, 50), UsageError);
  photons.position = {{1, 2, 3}};
  CHECK_THROWS_AS(automatic_radius(photons, 50), UsageError);
  photons.position.assign(100, glm::vec3(1, 2, 3));
  CHECK_THROWS_AS(automatic_radius(photons, 50), UsageError);
  photons = photons_on_sphere(100);
  CHECK_THROWS_AS(automatic_radius(photons, 0), UsageError);
  CHECK_THROWS_AS(automatic_radius(photons, limits::max_neighbours + 1), UsageError);
}

}  // namespace
}  // namespace photile::test
