// Where the noise of photon estimates is not seen in what lobes reflect.
#include <algorithm>
#include <catch2/catch.hpp>
#include <glm/glm.hpp>

#include "cache/surface_cache.hpp"

namespace photile::test {
namespace {

/// Hits of pixel 5 that weigh so much together, each so far from the one before, metres.
PrimaryHits hits_in_a_row(std::size_t count, double apart, double weight) {
  PrimaryHits hits;
  for (std::size_t i = 0; i < count; ++i) {
    hits.position.emplace_back(static_cast<double>(i) * apart, 0.0, 0.0);
    hits.sided_triangle.push_back(0);
    hits.pixel.push_back(5);
    hits.throughput.emplace_back(weight / static_cast<double>(count));
    hits.diffuse_albedo.emplace_back(1.0f);
  }
  return hits;
}

bool all_suit(const PrimaryHits& seen, const PrimaryHits& reflected, double noise) {
  const std::vector<std::uint8_t> suits =
      cache::suits_photons(seen, reflected, 1, {.width = 0.1, .noise = noise});
  REQUIRE(suits.size() == reflected.size());
  CHECK(std::all_of(suits.begin(), suits.end(), [&](auto one) { return one == suits.front(); }));
  return suits.front() != 0;
}

}  // namespace

TEST_CASE("photons suit reflections that count little beside the surface that shows them") {
  // A share of 1 / (1 + 9) of the pixel's light: noise of 39% is 3.9% there, of 41% is 4.1%.
  const PrimaryHits base = hits_in_a_row(16, 0.0, 0.45), faint = hits_in_a_row(16, 0.0, 0.05);
  CHECK(all_suit(base, faint, 0.39));
  CHECK_FALSE(all_suit(base, faint, 0.41));
  // On black it is all that the pixel shows.
  CHECK_FALSE(all_suit(hits_in_a_row(16, 0.0, 0.0), faint, 0.041));
  CHECK_FALSE(all_suit({}, faint, 0.041));
  CHECK(all_suit({}, faint, 0.039));
}

TEST_CASE("photons suit reflections of many blotches, whose noise averages out") {
  // 16 blotches have a quarter of the noise of one.
  CHECK(all_suit({}, hits_in_a_row(16, 0.1, 0.7), 4 * 0.039));
  CHECK_FALSE(all_suit({}, hits_in_a_row(16, 0.1, 0.7), 4 * 0.041));
  // Hits within one blotch are of no use.
  CHECK_FALSE(all_suit({}, hits_in_a_row(16, 0.0001, 0.7), 0.041));
  // Four pairs, far from each other: as four.
  PrimaryHits pairs = hits_in_a_row(8, 0.0, 0.7);
  for (std::size_t i = 0; i < 8; ++i) pairs.position[i].x = static_cast<float>(i / 2);
  CHECK(all_suit({}, pairs, 2 * 0.039));
  CHECK_FALSE(all_suit({}, pairs, 2 * 0.041));
}

TEST_CASE("photons suit reflections pixel by pixel") {
  PrimaryHits reflected = hits_in_a_row(2, 0.0, 1.0);
  PrimaryHits seen = hits_in_a_row(1, 0.0, 99.0);
  reflected.pixel[0] = 4;  // where nothing else is seen
  const std::vector<std::uint8_t> suits =
      cache::suits_photons(seen, reflected, 1, {.width = 0.1, .noise = 0.1});
  CHECK(suits == std::vector<std::uint8_t>{0, 1});
  CHECK(cache::suits_photons(seen, {}, 1, {.width = 0.1, .noise = 0.1}).empty());
}

}  // namespace photile::test
