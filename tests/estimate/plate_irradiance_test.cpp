// A uniformly lit plate reads the same irradiance however it is cut into triangles.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {

TEST_CASE("a uniformly lit plate reads its irradiance away from borders for any triangulation",
          "[long]") {
  // N photons of flux 1 on 1 m2: irradiance N. By the law of the estimate, (k - 1) / (pi r_k^2) has
  // mean N and a standard deviation of N / sqrt(k - 2) for each independent point.
  constexpr std::size_t count = 200'000;
  constexpr int k = 50;
  constexpr double radius = 0.03;
  // 3 x 0.03 from the border lie 0.82^2 m2, in which about 0.67 N / k = 2680 points are
  // independent. The mean of all hits then has a deviation of 1 / sqrt(48 x 2680) = 0.28%; the bar
  // of 1% is 3.6 deviations wide.
  for (const int cells : {1, 2, 7, 22, 70}) {
    Scene scene = test::empty_scene();
    test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells);
    Photons photons = test::uniform_photons(scene, count, 71, false);
    photons.flux.assign(count, glm::vec3(1.0f));
    const PhotonMaps maps(test::device(), scene, photons,
                          find_neighbour_groups(scene, {radius, 60}), {radius, 4});
    const PrimaryHits all = test::uniform_hits(scene, 40'000, 72, false);
    const Estimates estimates = Estimator(maps, scene, {k, 0}).estimate(all);
    double sum = 0;
    std::size_t inner = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const glm::vec3 p = all.position[i];
      const float border = std::min({p.x, p.y, 1 - p.x, 1 - p.y});
      if (border < 0.09f) continue;
      sum += estimates.irradiance[i].g;
      ++inner;
    }
    CAPTURE(cells, 2 * cells * cells, inner);
    REQUIRE(inner > 20'000);
    CHECK(sum / static_cast<double>(inner) / count == Approx(1.0).margin(0.01));
  }
}

}  // namespace photile::test
