#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <tuple>
#include <vector>

#include "photile/scene.hpp"
#include "trace/hit_batch.hpp"

namespace photile::test {

// A sort by more bits than a number has is no sort: the map `none`, above all others, asked for it.
TEST_CASE("Hits are sorted by map and cell, those on triangles without a map last") {
  const std::vector<std::uint32_t> map_of{5, none, 0, 2, none, 1'000'000, 5};
  const geometry::Box box{glm::vec3(0.0f), glm::vec3(1.0f)};
  const trace::HitCells cells(box);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform;
  std::vector<trace::EyeRecord> records(50);
  for (trace::EyeRecord& record : records) {
    for (int i = 0; i < 40; ++i) {
      trace::EyeHit hit{};
      hit.position = {uniform(random), uniform(random), uniform(random)};
      hit.sided_triangle = static_cast<std::uint32_t>(random() % map_of.size());
      record.hits.push_back(hit);
    }
  }
  const std::vector<trace::HitPlace> places = trace::sorted_places(records, box, map_of);
  REQUIRE(places.size() == 2'000);
  const auto order_of = [&](const trace::HitPlace& place) {
    const trace::EyeHit& hit = records[place.record].hits[place.index];
    return std::tuple(map_of[hit.sided_triangle], cells.morton_code(hit.position), place.record,
                      place.index);
  };
  CHECK(std::is_sorted(places.begin(), places.end(),
                       [&](const auto& a, const auto& b) { return order_of(a) < order_of(b); }));
}

}  // namespace photile::test
