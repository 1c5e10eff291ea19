#include "maps/map_pages.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "maps/photon_pages.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photon_sets.hpp"

using namespace photile;

TEST_CASE("map pages cover every map with photons once, in order, within the limit") {
  std::mt19937 random(7);
  std::vector<std::uint32_t> counts(10'000);
  std::uint64_t total = 0;
  for (auto& count : counts) {
    count = random() % 3 == 0 ? 0 : random() % 200;
    total += count;
  }
  const std::uint64_t max_bytes = 40'000;
  const auto pages = maps::plan_map_pages(counts, max_bytes);
  REQUIRE(pages.size() > 1);
  std::uint64_t paged = 0;
  std::uint32_t previous = 0;
  for (const maps::MapRange& page : pages) {
    CHECK(page.first >= previous);
    previous = page.last;
    std::uint64_t entries = 0;
    for (std::uint32_t map = page.first; map < page.last; ++map) entries += counts[map];
    CHECK(entries == page.entries);
    CHECK((entries + maps::entry_padding) * 12 <= max_bytes);
    CHECK((page.last - page.first) * sizeof(PhotileGrid) <= max_bytes);
    paged += entries;
  }
  CHECK(paged == total);
}

TEST_CASE("a single map beyond the device's largest buffer is refused with a remedy") {
  const std::vector<std::uint32_t> counts = {3, 5000};
  CHECK_THROWS_WITH(maps::plan_map_pages(counts, 12'000),
                    Catch::Contains("triangle 0") && Catch::Contains("fewer photons"));
}

TEST_CASE("no photons need no pages") {
  CHECK(maps::plan_map_pages(std::vector<std::uint32_t>(10, 0), 1000).empty());
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
