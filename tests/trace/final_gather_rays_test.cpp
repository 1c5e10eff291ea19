// Rays of final gathering, hit by hit.
#include "trace/final_gather_rays.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "test_scenes.hpp"

namespace photile::test {

using namespace photile::trace;

TEST_CASE("final gather rays: those of a hit are the same alone and among any others") {
  const Scene scene = furnished_room();
  const RayScene rays(scene);
  const PrimaryHits hits =
      trace_primary_hits(rays, scene.cameras[0], {.width = 9, .height = 9, .samples_per_pixel = 1},
                         0, 9)
          .hits;
  REQUIRE(hits.size() > 60);
  std::vector<std::uint64_t> number(hits.size());
  std::iota(number.begin(), number.end(), 7u);
  const FinalGatherParameters parameters{.rays = 3, .seed = 2, .max_specular_depth = 4};
  const std::size_t first = GENERATE(0u, 5u), count = hits.size() - 2 * first;
  const FinalGatherRays all = trace_final_gather(rays, hits, first, count, number, parameters, {});
  REQUIRE(all.first.size() == count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const FinalGatherRays one =
        trace_final_gather(rays, hits, first + i, 1, number, parameters, {});
    CAPTURE(i);
    REQUIRE(all.first[i + 1] - all.first[i] == one.end.size());
    for (std::size_t ray = 0; ray < one.end.size(); ++ray) {
      const std::size_t own = all.first[i] + ray;
      CHECK(all.weight[own].irradiance == one.weight[ray].irradiance);
      CHECK(all.weight[own].radiance == one.weight[ray].radiance);
      CHECK(all.ends.position[all.end[own]] == one.ends.position[one.end[ray]]);
    }
  }
}

}  // namespace photile::test
