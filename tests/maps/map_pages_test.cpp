// Maps in parts of the device's memory.
#include "maps/map_pages.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "maps/candidate_maps.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "maps/map_tiling.hpp"
#include "maps/photon_pages.hpp"
#include "maps/resident_maps.hpp"
#include "photile/device.hpp"
#include "photile/errors.hpp"
#include "photile/photon_maps.hpp"
#include "photile/scene.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

using maps::MapRange;
using maps::MapTiling;
using maps::Rectangle;

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

// Tiles of a grid: whoever looks up a place finds the page that holds all cells within the radius.

/// Metres. The border of a tile would be one bin narrower with less than 0.16.
constexpr double radius = 0.165;

/// A grid of cells 5 mm wide and 2 cm high around a rectangle of 4 x 1.5 m in the plane z = 0.
PhotileGrid grid() {
  PhotileGrid grid{};
  grid.u_axis_x = 1;
  grid.v_axis_y = 1;
  grid.minimum_u = grid.minimum_v = -static_cast<float>(radius);
  grid.cell_width = 0.005f;
  grid.cell_height = 0.02f;
  grid.inverse_cell_width = 200;
  grid.inverse_cell_height = 50;
  grid.slack = 1e-5f;
  grid.columns = 866;
  grid.rows = 92;
  return grid;
}

/// A photon in every cell.
MapTiling even_tiling() {
  MapTiling tiling(grid(), radius);
  std::vector<std::uint32_t> counts;
  for (std::uint32_t row = 0; row < tiling.rows(); ++row) {
    for (std::uint32_t column = 0; column < tiling.columns(); ++column) {
      const std::uint32_t width = tiling.bin_width(), height = tiling.bin_height();
      counts.push_back(std::min(width, grid().columns - column * width) *
                       std::min(height, grid().rows - row * height));
    }
  }
  tiling.set_photons(counts);
  return tiling;
}

/// Tiles of at most `most` entries, as far as they can be cut.
std::vector<Rectangle> cut(const MapTiling& tiling, std::uint64_t most) {
  std::vector<Rectangle> todo{tiling.whole()}, tiles;
  while (!todo.empty()) {
    const Rectangle tile = todo.back();
    todo.pop_back();
    const auto halves = tiling.entries(tile) > most ? tiling.halves(tile) : std::nullopt;
    if (halves) {
      todo.insert(todo.end(), {halves->first, halves->second});
    } else {
      tiles.push_back(tile);
    }
  }
  return tiles;
}

TEST_CASE("a tile counts the photons of its cells, the whole all photons") {
  const MapTiling tiling = even_tiling();
  CHECK(tiling.photons(tiling.whole()) == 866u * 92u);
  CHECK(tiling.entries(tiling.whole()) == 866u * 92u);  // no gaps
  const Rectangle tile{10, 3, 12, 9};
  const Rectangle cells = tiling.cells(tile);
  CHECK(tiling.photons(tile) == std::uint64_t{cells.width()} * cells.height());
}

TEST_CASE("the page of a place has all cells within the radius of it") {
  MapTiling tiling = even_tiling();
  const std::vector<Rectangle> tiles = cut(tiling, 12'000);
  REQUIRE(tiles.size() > 4);
  for (std::uint32_t i = 0; i < tiles.size(); ++i) tiling.assign(tiles[i], i);
  const auto reach = static_cast<float>(radius) + grid().slack;
  const auto column_of = [](float u) {
    return static_cast<std::uint32_t>(std::clamp((u + 0.165f) * 200, 0.f, 865.f));
  };
  const auto row_of = [](float v) {
    return static_cast<std::uint32_t>(std::clamp((v + 0.165f) * 50, 0.f, 91.f));
  };
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> u(0, 4), v(0, 1.5f);
  for (int i = 0; i < 20'000; ++i) {
    const glm::vec3 place(u(random), v(random), 0.05f);
    const std::uint32_t map = tiling.map_at(place);
    REQUIRE(map < tiles.size());
    const Rectangle cells = tiling.cells(tiles[map]);
    REQUIRE(column_of(place.x - reach) >= cells.first_column);
    REQUIRE(column_of(place.x + reach) < cells.last_column);
    REQUIRE(row_of(place.y - reach) >= cells.first_row);
    REQUIRE(row_of(place.y + reach) < cells.last_row);
  }
}

TEST_CASE("indices of a tile's cells begin with 0, though those of its grid do not") {
  const MapTiling tiling = even_tiling();
  const Rectangle tile{10, 10, 12, 12};
  const std::uint32_t first_row = tiling.cells(tile).first_row;
  REQUIRE(first_row > 0);
  CHECK(tiling.page_grid(tile).first_cell + first_row * grid().columns == 0u);
}

TEST_CASE("photons in one point cannot be cut apart") {
  MapTiling tiling(grid(), radius);
  std::vector<std::uint32_t> counts(std::size_t{tiling.columns()} * tiling.rows(), 0);
  counts[5 * tiling.columns() + 7] = 1'000'000;
  tiling.set_photons(counts);
  CHECK_FALSE(tiling.halves(tiling.whole()).has_value());
}

TEST_CASE("places that no tile was assigned to have no map") {
  CHECK(even_tiling().map_at({1, 1, 0}) == none);
}

// Only maps that photons come near are numbered, and take memory.

/// Plates of 4 x 4 squares, 1 m wide, side by side 3 m apart.
Scene plates(int count) {
  Scene scene = test::empty_scene();
  for (int i = 0; i < count; ++i) {
    test::add_plate(scene, {3.0f * static_cast<float>(i), 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  }
  return scene;
}

/// Photons on the first `lit` plates of `count`.
Photons photons_on(int lit, int count, const Scene& scene) {
  std::mt19937_64 random(9);
  Photons photons;
  const auto per_plate =
      static_cast<std::uint32_t>(scene.triangle_count()) / static_cast<std::uint32_t>(count);
  for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(lit) * per_plate; ++t) {
    for (int i = 0; i < 4; ++i) {
      test::add_photon(photons, scene, test::random_point(scene, t, random), sided(t, 0), random);
    }
  }
  return sort_by_sided_triangle(std::move(photons), 2 * scene.triangle_count());
}

struct Built {
  std::uint64_t map_bytes, peak_bytes;
};

Built build(int lit, int count, MapMode mode) {
  const Scene scene = plates(count);
  const Photons photons = photons_on(lit, count, scene);
  Device device;
  const NeighbourGroups groups =
      find_patch_groups(scene, find_patches(scene, 0.2, mode), {0.2, 60});
  const PhotonMaps maps(device, scene, photons, groups, {0.2, 4});
  return {maps.statistics().device_bytes, device.peak_allocated_bytes()};
}

TEST_CASE("numbers ascend without gaps; what no photon comes near has none") {
  maps::CandidateMaps candidates;
  candidates.members = {3, 8, 9, 3, 12};
  const maps::MapNumbers numbers = maps::number_maps(candidates, {}, 16);
  CHECK(numbers.pairs == std::vector<std::uint32_t>{1, 4, 6});
  CHECK(candidates.members == std::vector<std::uint32_t>{1, 2, 3, 1, 4});
  CHECK(numbers.map_of == std::vector<std::uint32_t>{none, none, 0, 1, none, none, none, none,  //
                                                     2, 3, none, none, 4, 5, none, none});
  const std::vector<float> values = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  CHECK(maps::of_numbered(numbers, values) == std::vector<float>{2, 3, 8, 9, 12, 13});
}

TEST_CASE("device memory is that of the places with light, not of the 1,000 places there are") {
  for (const MapMode mode : {MapMode::triangle, MapMode::patch}) {
    CAPTURE(mode == MapMode::patch);
    const Built alone = build(10, 10, mode), among = build(10, 1000, mode);
    // Maps reach 3 mm farther in a scene 3 km long, since its positions are rounded more.
    CHECK(static_cast<double>(among.map_bytes) ==
          Approx(static_cast<double>(alone.map_bytes)).epsilon(0.03));
    // Other devices than CPUs hold copies of the host's arrays of triangles while they build.
    if (test::device().info().type == DeviceType::cpu) {
      CHECK(static_cast<double>(among.peak_bytes) ==
            Approx(static_cast<double>(alone.peak_bytes)).epsilon(0.03));
    }
    CHECK(static_cast<double>(build(20, 1000, mode).map_bytes) ==
          Approx(2.0 * static_cast<double>(among.map_bytes)).epsilon(0.05));
  }
}

// The queue of pages to build: maps in order, then tiles; what cannot be cut is refused.

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

// Which items stay on the device while memory is short.

device::Context& limited_context() {
  DeviceOptions options;
  options.memory_bytes = 4'000;
  static device::Context context(options);
  return context;
}

/// Items of 1,000 bytes.
struct Items final : maps::Residents {
  std::vector<device::Buffer<std::uint8_t>> items;
  int loads = 0;

  explicit Items(std::size_t count) : Residents(limited_context()), items(count) {}
  using Residents::release;
  using Residents::use;
  void load(std::size_t item) override {
    items[item] = limited_context().allocate<std::uint8_t>(1'000, "item");
    ++loads;
  }
  void unload(std::size_t item) override { items[item] = {}; }
};

maps::MapPage page_of(device::Context& context, std::uint32_t first_map,
                      const std::vector<std::uint32_t>& photons) {
  maps::MapPage page;
  page.first_map = first_map;
  page.last_map = first_map + 1;
  page.entry_count = static_cast<std::uint32_t>(photons.size());
  page.entry_photon = context.upload(std::span(photons), "photons");
  return page;
}

TEST_CASE("items that fit are loaded once") {
  Items items(4);
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < 4; ++i) items.use(i);
  }
  CHECK(items.loads == 4);
}

TEST_CASE("of items that do not fit, used in turn, all places but one stay from round to round") {
  Items items(6);
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < 6; ++i) {
      items.use(i);
      CHECK(items.items[i].size() == 1'000);
      CHECK(items.resident_count() <= 4);
    }
  }
  // Round one loads 0 to 5 and keeps 0, 1, 2 and 5; each later one finds 3 or 4 of them in place.
  CHECK(items.loads <= 6 + 2 * 3);
}

TEST_CASE("the item in use is never unloaded, any other is") {
  Items items(3);
  items.use(0);
  items.use(1);
  CHECK(items.reclaim());
  CHECK(items.items[1].size() == 1'000);
  CHECK(items.items[0].size() == 0);
  CHECK_FALSE(items.reclaim());
  items.release();
  CHECK(items.reclaim());
  CHECK(items.resident_count() == 0);
}

TEST_CASE("pages come back from the host as they were") {
  device::Context& context = limited_context();
  maps::ResidentMaps pages(context);
  std::vector<std::vector<std::uint32_t>> photons;
  for (std::uint32_t p = 0; p < 5; ++p) {
    photons.emplace_back(250, p);
    pages.add(page_of(context, p, photons.back()));
  }
  CHECK(pages.spilled_bytes() == 1'000);
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t p = 0; p < 5; ++p) {
      const maps::MapPage& page = pages.use(p);
      CHECK(page.first_map == p);
      std::vector<std::uint32_t> read(page.entry_photon.size());
      context.read(page.entry_photon, std::span(read));
      CHECK(read == photons[p]);
    }
  }
  CHECK(context.allocated_bytes() <= 4'000);
}

}  // namespace
}  // namespace photile::test
