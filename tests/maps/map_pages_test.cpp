// Maps in parts of the device's memory.

#include <catch2/catch.hpp>

#include "maps/candidate_maps.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "maps/photon_pages.hpp"
#include "maps/resident_maps.hpp"
#include "photile/errors.hpp"
#include "photile/photon_maps.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

using maps::MapRange;

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
    CHECK(entries == page.records);
    CHECK((entries + maps::most_record_padding) * 12 <= max_bytes);
    CHECK((page.last - page.first) * sizeof(PhotileGrid) <= max_bytes);
    paged += entries;
  }
  CHECK(paged == total);
}

TEST_CASE("pages aim at a size of all their buffers together; a larger map has one of its own") {
  const std::vector<std::uint32_t> counts = {10, 10, 0, 10, 500, 10};
  const auto pages = maps::plan_map_pages(counts, {.largest_buffer = 100'000,
                                                   .page_bytes = 1'000,
                                                   .bytes_per_record = 40,
                                                   .bytes_per_map = 80});
  // Two maps take 20 x 40 + 2 x 80 = 960 bytes.
  REQUIRE(pages.size() == 4);
  CHECK((pages[0].first == 0 && pages[0].last == 2 && pages[0].records == 20));
  CHECK((pages[1].first == 3 && pages[1].last == 4 && pages[1].records == 10));
  CHECK((pages[2].first == 4 && pages[2].last == 5 && pages[2].records == 500));
  CHECK((pages[3].first == 5 && pages[3].last == 6 && pages[3].records == 10));
}

TEST_CASE("no index into a page passes 32 bits, however large the device's buffers") {
  constexpr std::uint64_t huge = std::uint64_t{1} << 40;
  // 24 maps of 2^28 photons: three planes of one are 2^29.6 floats.
  const std::vector<std::uint32_t> counts(24, 1u << 28);
  const auto pages = maps::plan_map_pages(counts, {.largest_buffer = huge});
  std::uint64_t paged = 0;
  for (const maps::MapRange& page : pages) {
    CHECK(3 * (page.records + maps::most_record_padding) <= 0xFFFF'FFFFull);
    CHECK(page.records < maps::max_items);
    paged += page.records;
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
  CHECK((halves->first.first == 2 && halves->first.last == 4 && halves->first.records == 8));
  CHECK((halves->second.first == 6 && halves->second.last == 7 && halves->second.records == 8));
  const auto uneven = maps::halves_of({0, 3, 13}, counts);
  REQUIRE(uneven.has_value());
  CHECK((uneven->first.last == 1 && uneven->second.first == 2 && uneven->second.records == 4));
  CHECK_FALSE(maps::halves_of({0, 2, 9}, counts).has_value());
}

TEST_CASE("no photons need no pages") {
  CHECK(maps::plan_map_pages(std::vector<std::uint32_t>(10, 0), {.largest_buffer = 1000}).empty());
}

TEST_CASE("photon pages cover every photon once, in order, within the limit") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8}});
  const Photons photons = uniform_photons(scene, 5000, 3);
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
    const std::uint32_t first_map = photons.oriented_face[page.first];
    const std::uint32_t last_map = photons.oriented_face[page.last - 1];
    const auto first_member = [&](std::uint32_t map) {
      return candidates.offsets[candidates.first_list_of[map]];
    };
    CHECK((first_member(last_map + 1) - first_member(first_map)) * 4 <= max_bytes);
  }
  CHECK(next == photons.size());
}

// Only maps that photons come near are numbered, and take memory.

/// Plates of 4 x 4 squares, 1 m wide, side by side 3 m apart.
Scene plates(int count) {
  Scene scene = empty_scene();
  for (int i = 0; i < count; ++i) {
    add_plate(scene, {3.0f * static_cast<float>(i), 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
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
      add_photon(photons, scene, random_point(scene, t, random), oriented(t, 0), random);
    }
  }
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
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
    if (device().info().type == DeviceType::cpu) {
      CHECK(static_cast<double>(among.peak_bytes) ==
            Approx(static_cast<double>(alone.peak_bytes)).epsilon(0.03));
    }
    CHECK(static_cast<double>(build(20, 1000, mode).map_bytes) ==
          Approx(2.0 * static_cast<double>(among.map_bytes)).epsilon(0.05));
  }
}

// The queue of pages to build: what cannot be cut is refused, or built as it is.

struct Queue {
  std::vector<std::uint32_t> counts;
  maps::PageQueue queue;

  Queue(std::vector<std::uint32_t> map_counts, const maps::PageLimits& limits)
      : counts(std::move(map_counts)), queue(counts, limits, [](std::uint32_t map) {
          return "triangle " + std::to_string(map / 2);
        }) {}
};

TEST_CASE("a map beyond the device's largest buffer is refused with a remedy") {
  Queue queue({3, 0, 5000}, {.largest_buffer = 12'000});
  CHECK(queue.queue.next()->first == 0);
  CHECK_THROWS_WITH(queue.queue.next(),
                    Catch::Contains("triangle 1") && Catch::Contains("fewer photons"));
}

TEST_CASE("a page beyond what pages aim at that cannot be cut is built as it is") {
  Queue queue({500}, {.largest_buffer = 100'000,
                      .page_bytes = 1'000,
                      .bytes_per_record = 40,
                      .bytes_per_map = 80});
  const auto page = queue.queue.next();
  REQUIRE(page.has_value());
  CHECK(page->records == 500);
  CHECK_FALSE(queue.queue.cut(*page));
  CHECK_FALSE(queue.queue.next().has_value());
}

TEST_CASE("a page that did not fit comes again in two, in the order of its maps") {
  Queue queue({4, 4, 4}, {.largest_buffer = 100'000});
  const auto page = queue.queue.next();
  REQUIRE((page.has_value() && page->first == 0 && page->last == 3));
  REQUIRE(queue.queue.cut(*page));
  const auto first = queue.queue.next(), second = queue.queue.next();
  REQUIRE((first.has_value() && second.has_value()));
  CHECK((first->first == 0 && first->last == second->first && second->last == 3));
  CHECK(first->records + second->records == 12);
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
  page.record_count = static_cast<std::uint32_t>(photons.size());
  page.record_photon = context.upload(std::span(photons), "photons");
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
      std::vector<std::uint32_t> read(page.record_photon.size());
      context.read(page.record_photon, std::span(read));
      CHECK(read == photons[p]);
    }
  }
  CHECK(context.allocated_bytes() <= 4'000);
}

}  // namespace
}  // namespace photile::test
