// The queue of pages to build: maps in order, then tiles; what cannot be cut is refused.
#include <catch2/catch.hpp>

#include "maps/map_page.hpp"
#include "maps/map_pages.hpp"
#include "photile/errors.hpp"

namespace photile::test {

using maps::MapRange;
using maps::MapTiling;

namespace {

/// A map of 64 x 64 bins with `photons` in each; queries reach as far as a bin is wide.
MapTiling square(std::uint32_t photons) {
  PhotileGrid grid{};
  grid.cell_height = grid.inverse_cell_height = 1;
  grid.cell_width = 1.0f / PHOTILE_CELL_ASPECT;
  grid.inverse_cell_width = PHOTILE_CELL_ASPECT;
  grid.columns = PHOTILE_CELL_ASPECT * 64;
  grid.rows = 64;
  MapTiling tiling(grid, 1);
  tiling.set_photons(std::vector<std::uint32_t>(64 * 64, photons));
  return tiling;
}

/// All of them in the middle.
MapTiling point(std::uint32_t photons) {
  MapTiling tiling = square(0);
  std::vector<std::uint32_t> counts(64 * 64, 0);
  counts[32 * 64 + 32] = photons;
  tiling.set_photons(counts);
  return tiling;
}

struct Queue {
  std::vector<std::uint32_t> counts;
  maps::MapTilings tilings;
  maps::PageQueue queue;

  Queue(std::vector<std::uint32_t> map_counts, const maps::PageLimits& limits,
        const maps::PageQueue::MakeTiling& make_tiling)
      : counts(std::move(map_counts)),
        queue(counts, limits, tilings, make_tiling,
              [](std::uint32_t map) { return "triangle " + std::to_string(map / 2); }) {}
};

}  // namespace

TEST_CASE("a map beyond the device's largest buffer comes in tiles, after all others") {
  const maps::PageLimits limits{.largest_buffer = 40'000};
  Queue queue({3, 4 * 64 * 64, 5}, limits, [](std::uint32_t) { return square(4); });
  std::vector<MapRange> pages;
  while (const auto page = queue.queue.next()) pages.push_back(*page);
  REQUIRE(pages.size() > 5);
  CHECK((pages[0].first == 0 && pages[1].first == 2));
  std::vector<int> covered(64 * 64, 0);
  for (std::size_t i = 2; i < pages.size(); ++i) {
    REQUIRE(pages[i].tile.has_value());
    CHECK(pages[i].first == 1);
    CHECK((pages[i].entries + maps::most_entry_padding) * 12 <= limits.largest_buffer);
    for (std::uint32_t row = pages[i].tile->first_row; row < pages[i].tile->last_row; ++row) {
      for (std::uint32_t c = pages[i].tile->first_column; c < pages[i].tile->last_column; ++c) {
        ++covered[row * 64 + c];
      }
    }
  }
  CHECK(std::count(covered.begin(), covered.end(), 1) == 64 * 64);
}

TEST_CASE("photons in one place beyond the device's largest buffer are refused with a remedy") {
  Queue queue({3, 0, 5000}, {.largest_buffer = 12'000}, [](std::uint32_t) { return point(5000); });
  CHECK(queue.queue.next()->first == 0);
  CHECK_THROWS_WITH(queue.queue.next(),
                    Catch::Contains("triangle 1") && Catch::Contains("fewer photons"));
}

TEST_CASE("a page beyond what pages aim at that cannot be cut is built as it is") {
  const maps::PageLimits limits{
      .largest_buffer = 100'000, .page_bytes = 1'000, .bytes_per_entry = 40, .bytes_per_map = 80};
  Queue queue({500}, limits, [](std::uint32_t) { return point(500); });
  const auto page = queue.queue.next();
  REQUIRE(page.has_value());
  CHECK((page->entries == 500 && !page->tile));
  CHECK_FALSE(queue.queue.cut(*page));
  CHECK_FALSE(queue.queue.next().has_value());
}

}  // namespace photile::test
