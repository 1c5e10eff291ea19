// The exact law of the estimate: of N uniform photons on a surface of area A, the part of the
// surface within the distance of the k-th from a point is A times a Beta(k, N - k + 1) variable,
// wherever the point lies: here also on edges and in corners to the last bit. So the k - 1 nearest
// over the clipped area have the mean N / A, and so do their weights by a kernel over its integral:
// given the k-th the others are independent.
#include <catch2/catch.hpp>

#include "oracle/kernel_weights.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr int k = 50;
constexpr int photons_per_plate = 250;
constexpr std::size_t plates = 20'000;
/// Where fewer than k photons lie within it the law does not hold; in the corner of a square of
/// 1 m that has a probability of 3e-9.
constexpr double radius = 0.7;

/// P(Beta(k, N - k + 1) <= u): that at least k of N uniform values are at most u.
double beta_probability(double u) {
  double below = 0;
  for (int i = 0; i < k; ++i) {
    below += std::exp(std::lgamma(photons_per_plate + 1.0) - std::lgamma(i + 1.0) -
                      std::lgamma(photons_per_plate - i + 1.0) + i * std::log(u) +
                      (photons_per_plate - i) * std::log1p(-u));
  }
  return 1 - below;
}

/// Many plates far apart, turned at random, each with its own photons: as many independent points.
struct Plates {
  Scene scene = empty_scene();
  Photons photons;
  PrimaryHits hits;
};

/// The parallelogram of two edges, or half of it: 1, 2 or 8 triangles.
void add_piece(Scene& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
               bool half, int cells) {
  if (half) {
    add_triangle(scene, corner, corner + u, corner + v);
  } else {
    add_plate(scene, corner, u, v, cells);
  }
}

/// Hits at corner + s u + t v, which lies on the first triangle of the last piece or on another.
Plates make_plates(float s, float t, bool half) {
  Plates made;
  std::mt19937_64 random(17);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform;
  std::vector<glm::vec3> corners, us, vs;
  std::vector<std::uint32_t> first;
  for (std::size_t plate = 0; plate < plates; ++plate) {
    const glm::vec3 u = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    const glm::vec3 w(normal(random), normal(random), normal(random));
    const glm::vec3 v = glm::normalize(glm::cross(u, w));
    const auto at = [&](std::size_t cells) { return 4.0f * static_cast<float>(cells); };
    const glm::vec3 corner(at(plate % 28), at(plate / 28 % 28), at(plate / 784));
    const auto triangle = static_cast<std::uint32_t>(made.scene.triangle_count());
    add_piece(made.scene, corner, u, v, half, plate % 2 == 0 ? 1 : 2);
    const auto count = static_cast<std::uint32_t>(made.scene.triangle_count()) - triangle;
    for (int i = 0; i < photons_per_plate; ++i) {
      const std::uint32_t on =
          triangle + static_cast<std::uint32_t>(uniform(random) * static_cast<float>(count));
      made.photons.position.push_back(random_point(made.scene, on, random));
      made.photons.oriented_face.push_back(oriented(on, 0));
    }
    // The triangle that holds the point, or the nearest one.
    const glm::vec3 point = corner + s * u + t * v;
    std::uint32_t nearest = triangle;
    double least = 1e30;
    for (std::uint32_t on = triangle; on < triangle + count; ++on) {
      const auto c = made.scene.corners(on);
      double outside = 0;
      for (int i = 0; i < 3; ++i) {
        const glm::dvec3 edge = c[(i + 1) % 3] - c[i];
        const glm::dvec3 inward =
            glm::normalize(glm::cross(face_normal(made.scene, oriented(on, 0)), edge));
        outside = std::max(outside, -glm::dot(inward, glm::dvec3(point - c[i])));
      }
      if (outside < least) least = outside, nearest = on;
    }
    add_grey_hit(made.hits, point, oriented(nearest, 0));
  }
  const std::size_t count = made.photons.size();
  made.photons.flux.assign(count, glm::vec3(1.0f));
  made.photons = sort_by_oriented_face(std::move(made.photons), 2 * made.scene.triangle_count());
  return made;
}

/// Moments of readings over the truth.
struct Moments {
  double mean = 0, variance = 0;

  explicit Moments(const std::vector<double>& readings) {
    for (const double reading : readings) mean += reading / plates;
    for (const double reading : readings) variance += (reading - mean) * (reading - mean) / plates;
  }

  void check_mean() const {
    const double error = std::sqrt(variance / plates);
    CAPTURE(mean, error);
    REQUIRE((4.89 + 3.1) * error < 0.01);  // else too noisy to see 1%
    CHECK(std::abs(mean - 1) < 4.89 * error);
  }
};

/// The variance over whole discs: the photons but the k-th are independent, each with a squared
/// coefficient of variation of its weight of `of_weight`.
double expected_variance(double of_weight) {
  const double of_areas = (k - 1.0) * (photons_per_plate - 1.0) / ((k - 2.0) * photons_per_plate);
  return of_areas * (1 + of_weight / (k - 1)) - 1;
}

void check_law(float s, float t, bool half) {
  const Plates data = make_plates(s, t, half);
  const double area = half ? 0.5 : 1.0;
  const NeighbourGroups groups =
      find_map_groups(data.scene, data.photons, MapMode::patch, {radius, 60});
  const PhotonMaps maps(device(), data.scene, data.photons, groups, {.radius = radius});
  const auto readings = [&](DensityKernel kernel) {
    std::vector<double> values;
    EstimateParameters parameters{.neighbours = k, .kernel = kernel};
    for (const auto& irradiance :
         Estimator(maps, data.scene, parameters).estimate(data.hits).irradiance) {
      values.push_back(irradiance.g * area / photons_per_plate);
    }
    return values;
  };
  const std::vector<double> constant = readings(DensityKernel::constant);
  std::vector<double> part;
  for (const double reading : constant) part.push_back((k - 1) / (reading * photons_per_plate));
  std::sort(part.begin(), part.end());
  double distance = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const double expected = beta_probability(std::min(part[i], 1.0));
    distance = std::max({distance, std::abs(expected - static_cast<double>(i) / plates),
                         std::abs(expected - static_cast<double>(i + 1) / plates)});
  }
  CAPTURE(s, t, half, distance);
  // Kolmogorov's distribution at 1 - 1e-6: 2 exp(-2 x^2) = 1e-6.
  CHECK(distance * std::sqrt(static_cast<double>(plates)) < 2.693);
  Moments(constant).check_mean();

  const bool whole = s > 0.3f && s < 0.7f && t > 0.3f && t < 0.7f;
  for (const DensityKernel kernel : all_density_kernels) {
    if (kernel == DensityKernel::constant) continue;
    const Moments weighted(readings(kernel));
    weighted.check_mean();
    // Four standard deviations of the variance of 20,000 are 4%.
    if (!whole) continue;
    CHECK(weighted.variance ==
          Approx(expected_variance(reference::squared_variation(kernel))).epsilon(0.05));
  }
}

}  // namespace

TEST_CASE("the exact law of the estimate in the middle of a plate", "[long]") {
  check_law(0.5f, 0.45f, false);
}

TEST_CASE("the exact law of the estimate at an edge", "[long][slow]") { check_law(0.5f, 0, false); }

TEST_CASE("the exact law of the estimate in a corner of 90 degrees", "[long]") {
  check_law(0, 0, false);
}

TEST_CASE("the exact law of the estimate in a corner of 45 degrees", "[long]") {
  check_law(1, 0, true);
}

}  // namespace photile::test
