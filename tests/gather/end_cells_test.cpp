// Cells in which rays that end share an estimate.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include "gather/end_cells.hpp"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "trace/random_stream.hpp"

namespace photile::test {

using namespace photile::gathering;

namespace {

const glm::vec3 upwards(0, 0, 1);

std::vector<CellKey> random_keys(std::size_t count, std::uint64_t seed) {
  std::vector<CellKey> keys;
  for (std::size_t i = 0; i < count; ++i) {
    const trace::RandomBlock random =
        trace::RandomStream(seed, i, 0).block(trace::Purpose::emission, 0);
    keys.push_back(cell_of({random.uniform(0), random.uniform(1), 0.5f}, upwards,
                           random.word(2) % 3, 0.05, random.uniform(3) * 2));
  }
  return keys;
}

auto tuple_of(const CellKey& key) { return std::tuple(key.voxel, key.size_and_normal, key.map); }

}  // namespace

TEST_CASE("cells are apart where voxel, normal or map differ, and shrink for near ends") {
  const auto cell = [](const glm::vec3& position, const glm::vec3& normal = upwards,
                       std::uint32_t map = 0, float distance = 2.0f) {
    return cell_of(position, normal, map, 0.05, distance);
  };
  CHECK(cell({0.01f, 0.01f, 0}) == cell({0.04f, 0.04f, 0}));
  CHECK_FALSE(cell({0.01f, 0.01f, 0}) == cell({0.06f, 0.01f, 0}));
  CHECK_FALSE(cell({0.01f, 0.01f, 0}) == cell({0.01f, 0.01f, 0}, -upwards));
  CHECK_FALSE(cell({0.01f, 0.01f, 0}) == cell({0.01f, 0.01f, 0}, {1, 0, 0}));
  CHECK_FALSE(cell({0.01f, 0.01f, 0}) == cell({0.01f, 0.01f, 0}, upwards, 1));
  // From 1 m on 5 cm, from 0.5 m on 2.5 cm, below that 1.25 cm.
  for (const auto& [distance, side] :
       {std::pair{1.1f, 0.05f}, std::pair{0.9f, 0.025f}, std::pair{0.51f, 0.025f},
        std::pair{0.49f, 0.0125f}, std::pair{0.01f, 0.0125f}}) {
    CAPTURE(distance, side);
    const CellKey first = cell({0.1f * side, 0.1f * side, 0}, upwards, 0, distance);
    CHECK(first == cell({0.9f * side, 0.9f * side, 0}, upwards, 0, distance));
    CHECK_FALSE(first == cell({1.1f * side, 0.1f * side, 0}, upwards, 0, distance));
  }
  CHECK_FALSE(cell({0, 0, 0}, upwards, 0, 0.6f) == cell({0, 0, 0}, upwards, 0, 0.4f));
  // A wall at a multiple of the side is not cut in two by rounding.
  CHECK(cell({0.01f, 0.01f, 0.1f - 1e-7f}) == cell({0.01f, 0.01f, 0.1f + 1e-7f}));
}

TEST_CASE("cells are numbered in the order in which they are met, on any number of threads") {
  const std::vector<CellKey> first = random_keys(50'000, 1), second = random_keys(50'000, 2);
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EndCells cells;
    std::vector<std::uint8_t> left_out(first.size(), 0);
    for (std::size_t i = 0; i < left_out.size(); i += 5) left_out[i] = 1;
    std::map<decltype(tuple_of(first[0])), std::uint32_t> expected;
    for (const std::vector<CellKey>* keys : {&first, &second}) {
      const EndCells::Numbers numbers = cells.number(*keys, left_out);
      std::vector<std::uint32_t> first_key;
      for (std::uint32_t i = 0; i < keys->size(); ++i) {
        if (left_out[i]) continue;
        const auto [entry, is_new] =
            expected.emplace(tuple_of((*keys)[i]), static_cast<std::uint32_t>(expected.size()));
        if (is_new) first_key.push_back(i);
        REQUIRE(numbers.cell[i] == entry->second);
      }
      CHECK(numbers.first_key == first_key);
      CHECK(cells.size() == expected.size());
    }
  }
}

}  // namespace photile::test
