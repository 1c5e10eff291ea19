// Which items stay on the device while memory is short.
#include <catch2/catch.hpp>

#include "maps/resident_maps.hpp"

namespace photile::test {
namespace {

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

}  // namespace

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

}  // namespace photile::test
