// Photons uniform on the unit sphere: the cap within the chord r has the area pi r^2 exactly
// (Archimedes) and there is no border, so r_k^2 / 4 has the distribution Beta(k, N - k) and the
// median (k - 1/3) / (N - 2/3) (Kerman 2011).
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "meshes.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::test {
namespace {

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

}  // namespace

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

TEST_CASE("automatic radius of two photons is twice their distance") {
  Photons photons;
  photons.position = {{0, 0, 0}, {3, 4, 0}};
  CHECK(automatic_radius(photons, 1) == Approx(10).epsilon(1e-6));
}

TEST_CASE("automatic radius extrapolates when k exceeds the number of photons") {
  Photons photons;
  photons.position = {{0, 0, 0}, {3, 4, 0}};
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

}  // namespace photile::test
