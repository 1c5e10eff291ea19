// The table of light, and the sums that its rows are made of.
#include "photile/light_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <vector>

#include "light/row_sum.hpp"
#include "photile/defaults.hpp"

namespace photile {
namespace {

constexpr std::size_t lights = 5;
constexpr int batches = 4;

/// Rows of numbers that tell row, light and batch; sparse ones lack some lights, every third all.
LightTable numbered(bool sparse, std::size_t rows) {
  LightTable table(lights, sparse);
  table.batches = batches;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t light = 0; light < lights; ++light) {
      if (sparse && (row % 3 == 0 || (row + light) % 2 == 0)) continue;
      const auto value = static_cast<float>(100 * row + light);
      table.irradiance.emplace_back(value);
      table.by_normal.emplace_back(value);
      for (int b = 0; b < batches; ++b) table.batch.push_back(value + 0.1f * static_cast<float>(b));
      if (sparse) table.light.push_back(static_cast<std::uint16_t>(light));
    }
    if (sparse) table.first.push_back(table.irradiance.size());
  }
  return table;
}

using Row = std::map<std::size_t, float>;  ///< by light

Row row_of(const LightTable& table, std::size_t row) {
  Row found;
  table.for_each(row, [&](std::size_t light, std::size_t entry) {
    REQUIRE(found.emplace(light, table.irradiance[entry].x).second);
    CHECK(table.by_normal[entry].w == table.irradiance[entry].x);
    CHECK(table.batch[entry * batches + 3] == table.irradiance[entry].x + 0.1f * 3);
  });
  return found;
}

void check_rows(const LightTable& table, const LightTable& of,
                const std::vector<std::uint32_t>& rows) {
  REQUIRE(table.rows() == rows.size());
  CHECK(table.sparse() == of.sparse());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    CHECK(row_of(table, row) == row_of(of, rows[row]));
  }
}

}  // namespace

TEST_CASE("rows of a table of light are appended, gathered and cut out as they are") {
  const bool sparse = GENERATE(false, true);
  const LightTable all = numbered(sparse, 10);
  REQUIRE(all.rows() == 10);
  CHECK(row_of(all, 7).size() == (sparse ? 3 : lights));
  check_rows(all.gathered(std::vector<std::uint32_t>{9, 3, 3, 0}), all, {9, 3, 3, 0});
  check_rows(all.slice(4, 3), all, {4, 5, 6});
  check_rows(all.slice(4, 0), all, {});
  LightTable one_by_one;
  for (const std::size_t row : {8, 0, 1}) one_by_one.append(all.slice(row, 1));
  check_rows(one_by_one, all, {8, 0, 1});
  LightTable joined;
  for (const auto& [first, count] : {std::pair{0, 4}, {4, 0}, {4, 6}}) {
    joined.append(all.slice(static_cast<std::size_t>(first), static_cast<std::size_t>(count)));
  }
  check_rows(joined, all, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(joined.bytes() == all.bytes());
}

TEST_CASE("rows without lights are rows") {
  LightTable table(20, true);
  LightTable dark(20, true);
  dark.first = {0, 0, 0};
  table.append(dark);
  table.append(dark);
  CHECK(table.rows() == 4);
}

TEST_CASE("the error of lights together is the scatter of the sums of their batches") {
  LightTable table(2, false);
  table.batches = batches;
  table.irradiance = {glm::vec3(2.5f), glm::vec3(25.0f)};
  table.batch = {1, 2, 3, 4, 40, 30, 20, 10};  // what one finds more the other finds less
  table.shared_variance = {0, 4};
  const double of_one = std::sqrt(5.0 / (4 * 3));  // squares of 1.5, 0.5, 0.5, 1.5
  CHECK(table.error(0) == Approx(of_one));
  CHECK(table.error(1) == Approx(std::hypot(10 * of_one, 2)));
  CHECK(table.scatter(1) == Approx(std::hypot(10 * of_one, 2 * defaults::aimed_noise)));
  const LightTable::Total together = table.total(0, std::vector<double>{10, 1});
  CHECK(together.luminance == Approx(50));
  CHECK(together.error == Approx(2 * defaults::aimed_noise));  // the batches make up for each other
}

TEST_CASE("light of two kinds is added light by light, with its batches") {
  const bool sparse = GENERATE(false, true);
  const LightTable a = numbered(sparse, 6), b = numbered(sparse, 6);
  const LightTable sum = sum_of(a, b, 0.25f, 0.75f);
  REQUIRE(sum.rows() == 6);
  for (std::size_t row = 0; row < 6; ++row) {
    const Row expected = row_of(a, row);
    std::size_t found = 0;
    sum.for_each(row, [&](std::size_t light, std::size_t entry) {
      ++found;
      CHECK(sum.irradiance[entry].x == Approx(expected.at(light)));
      CHECK(sum.batch[entry * batches + 1] == Approx(expected.at(light) + 0.1f));
    });
    CHECK(found == expected.size());
  }
}

TEST_CASE("a row sum writes the lights that were added to, ascending, and forgets them") {
  for (const bool sparse : {false, true}) {
    LightTable table(lights, sparse);
    light::RowSum<light::Reflection> sums(lights);
    sums.of(4).add(glm::vec3(1.0f), glm::vec3(0.5f));
    sums.of(1).add(glm::vec3(2.0f), glm::vec3(0.0f));
    sums.of(4).add(glm::vec3(3.0f), glm::vec3(0.5f));
    light::end_row(sums, table, true);
    light::end_row(sums, table, true);
    sums.of(0).add(glm::vec3(7.0f), glm::vec3(7.0f));
    light::end_row(sums, table, false);
    CHECK(table.rows() == 3);
    const auto irradiance = [&](std::size_t row) {
      Row found;
      table.for_each(row, [&](std::size_t light, std::size_t entry) {
        if (table.irradiance[entry].x > 0) found[light] = table.irradiance[entry].x;
      });
      return found;
    };
    CHECK(irradiance(0) == Row{{1, 2.0f}, {4, 4.0f}});
    CHECK(irradiance(1).empty());
    CHECK(irradiance(2) == Row{{0, 7.0f}});
    CHECK(table.radiance.size() == (sparse ? 2 : 2 * lights));
    if (sparse) CHECK(table.light == std::vector<std::uint16_t>{1, 4, 0});
  }
}

}  // namespace photile
