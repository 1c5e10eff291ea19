// Tiles of a grid: whoever looks up a place finds the page that holds all cells within the radius.
#include "maps/map_tiling.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "photile/scene.hpp"

namespace photile::test {

using maps::MapTiling;
using maps::Rectangle;

namespace {

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

}  // namespace

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

}  // namespace photile::test
