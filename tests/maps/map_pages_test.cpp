#include "maps/map_pages.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "maps/map_store.hpp"
#include "maps/photon_pages.hpp"
#include "photon_sets.hpp"

namespace photile::test {

TEST_CASE("map pages cover every map with photons once, in order, within the limit") {
  std::mt19937 random(7);
  std::vector<std::uint32_t> counts(10'000);
  std::uint64_t total = 0;
  for (auto& count : counts) {
    count = random() % 3 == 0 ? 0 : random() % 200;
    total += count;
  }
  const std::uint64_t max_bytes = 40'000;
  const auto pages = maps::plan_map_pages(counts, {.largest_buffer = max_bytes});
  REQUIRE(pages.size() > 1);
  std::uint64_t paged = 0;
  std::uint32_t previous = 0;
  for (const maps::MapRange& page : pages) {
    CHECK(page.first >= previous);
    previous = page.last;
    std::uint64_t entries = 0;
    for (std::uint32_t map = page.first; map < page.last; ++map) entries += counts[map];
    CHECK(entries == page.entries);
    CHECK((entries + maps::most_entry_padding) * 12 <= max_bytes);
    CHECK((page.last - page.first) * sizeof(PhotileGrid) <= max_bytes);
    paged += entries;
  }
  CHECK(paged == total);
}

TEST_CASE("pages aim at a size of all their buffers together; a larger map has one of its own") {
  const std::vector<std::uint32_t> counts = {10, 10, 0, 10, 500, 10};
  const auto pages = maps::plan_map_pages(
      counts,
      {.largest_buffer = 100'000, .page_bytes = 1'000, .bytes_per_entry = 40, .bytes_per_map = 80});
  // Two maps take 20 x 40 + 2 x 80 = 960 bytes.
  REQUIRE(pages.size() == 4);
  CHECK((pages[0].first == 0 && pages[0].last == 2 && pages[0].entries == 20));
  CHECK((pages[1].first == 3 && pages[1].last == 4 && pages[1].entries == 10));
  CHECK((pages[2].first == 4 && pages[2].last == 5 && pages[2].entries == 500));
  CHECK((pages[3].first == 5 && pages[3].last == 6 && pages[3].entries == 10));
}

TEST_CASE("no index into a page passes 32 bits, however large the device's buffers") {
  constexpr std::uint64_t huge = std::uint64_t{1} << 40;
  // 24 maps of 2^28 photons: three planes of one are 2^29.6 floats.
  const std::vector<std::uint32_t> counts(24, 1u << 28);
  const auto pages = maps::plan_map_pages(counts, {.largest_buffer = huge});
  std::uint64_t paged = 0;
  for (const maps::MapRange& page : pages) {
    CHECK(3 * (page.entries + maps::most_entry_padding) <= 0xFFFF'FFFFull);
    CHECK(page.entries < maps::max_items);
    paged += page.entries;
  }
  CHECK(paged == 24ull << 28);
  // There are as many pages as fit, not fewer: five times 2^28 photons are 3.75 x 2^30 floats.
  CHECK(pages.size() == 5);
  CHECK_FALSE(maps::PageLimits{.largest_buffer = huge}.fit(0xFFFF'FFFEu, 1));
}

TEST_CASE("buffers smaller than the padding hold no photons") {
  CHECK_FALSE(maps::PageLimits{.largest_buffer = 100}.fit(1, 1));
}

TEST_CASE("a page is halved where its entries are, between maps") {
  const std::vector<std::uint32_t> counts = {9, 0, 4, 4, 0, 0, 8, 0};
  const auto halves = maps::halves_of({2, 7, 16}, counts);
  REQUIRE(halves.has_value());
  CHECK((halves->first.first == 2 && halves->first.last == 4 && halves->first.entries == 8));
  CHECK((halves->second.first == 6 && halves->second.last == 7 && halves->second.entries == 8));
  const auto uneven = maps::halves_of({0, 3, 13}, counts);
  REQUIRE(uneven.has_value());
  CHECK((uneven->first.last == 1 && uneven->second.first == 2 && uneven->second.entries == 4));
  CHECK_FALSE(maps::halves_of({0, 2, 9}, counts).has_value());
}

TEST_CASE("no photons need no pages") {
  CHECK(maps::plan_map_pages(std::vector<std::uint32_t>(10, 0), {.largest_buffer = 1000}).empty());
}

TEST_CASE("photon pages cover every photon once, in order, within the limit") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
  const Photons photons = test::uniform_photons(scene, 5000, 3);
  const maps::CandidateMaps candidates =
      maps::find_candidate_maps(scene, photons, find_neighbour_groups(scene, {0.2, 60}), 0.2f);
  const std::uint64_t max_bytes = 9'000;
  const auto pages = maps::plan_photon_pages(photons, candidates, max_bytes);
  REQUIRE(pages.size() > 1);
  std::uint32_t next = 0;
  for (const maps::PhotonRange& page : pages) {
    CHECK(page.first == next);
    CHECK(page.last > page.first);
    next = page.last;
    CHECK((page.last - page.first) * 12 <= max_bytes);
    const std::uint32_t first_map = photons.sided_triangle[page.first];
    const std::uint32_t last_map = photons.sided_triangle[page.last - 1];
    const auto first_member = [&](std::uint32_t map) {
      return candidates.offsets[candidates.first_list_of[map]];
    };
    CHECK((first_member(last_map + 1) - first_member(first_map)) * 4 <= max_bytes);
  }
  CHECK(next == photons.size());
}

}  // namespace photile::test
