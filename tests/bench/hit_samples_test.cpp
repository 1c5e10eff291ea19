// Which hits slow cases of the knn bench are asked.
#include <algorithm>
#include <catch2/catch.hpp>

#include "support/hit_sample.hpp"
#include "support/workload.hpp"

namespace photile::test {

TEST_CASE("block samples hold every n-th block, and those of every multiple of n") {
  const PrimaryHits hits = bench::plane_workload(5000).hits;
  CHECK(bench::block_sample(hits, 1).index.size() == 5000);
  const bench::HitSample half = bench::block_sample(hits, 2);
  const bench::HitSample eighth = bench::block_sample(hits, 8);
  // Blocks of 256: 0, 2, ... 18 of 19 whole ones and a last of 136; of these 0, 8, 16.
  CHECK(half.index.size() == 10 * 256);
  CHECK(eighth.index.size() == 3 * 256);
  CHECK(std::includes(half.index.begin(), half.index.end(), eighth.index.begin(),
                      eighth.index.end()));
  std::size_t different = 0;
  for (std::size_t i = 0; i < half.index.size(); ++i) {
    different += half.hits.position[i] != hits.position[half.index[i]];
    different += half.hits.sided_triangle[i] != hits.sided_triangle[half.index[i]];
  }
  CHECK(different == 0);
}

TEST_CASE("a thinned sample keeps its places in the whole") {
  const PrimaryHits hits = bench::plane_workload(5000).hits;
  const bench::HitSample sample = bench::thinned(bench::block_sample(hits, 4), 100);
  REQUIRE(sample.index.size() <= 100);
  CHECK(sample.index.size() > 50);
  CHECK(sample.hits.size() == sample.index.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < sample.index.size(); ++i) {
    different += sample.hits.position[i] != hits.position[sample.index[i]];
  }
  CHECK(different == 0);
}

}  // namespace photile::test
