// Hours in which rooms are used.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "daylight/daylight_metrics.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

using namespace photile::daylight;
using Catch::Contains;

namespace {

/// A year that begins on a Sunday.
std::vector<SkyHour> year() {
  std::vector<SkyHour> hours(8760);
  for (std::size_t i = 0; i < hours.size(); ++i) {
    hours[i].hour = static_cast<double>(i % 24) + 0.5;
    hours[i].weekday = static_cast<int>((6 + i / 24) % 7);
  }
  return hours;
}

std::ptrdiff_t count(const Occupancy& occupancy) {
  const auto occupied = occupied_hours(year(), occupancy);
  return std::count(occupied.begin(), occupied.end(), true);
}

}  // namespace

TEST_CASE("working days are counted by the calendar of the weather") {
  Occupancy occupancy;
  CHECK(count(occupancy) == 3650);
  occupancy.set_hours("9-17");
  occupancy.set_days("mon-fri");
  CHECK(count(occupancy) == 8 * (365 - 53 - 52));  // 53 Sundays
  occupancy.set_days("Sun");
  CHECK(count(occupancy) == 8 * 53);
  occupancy.set_days("sat-mon,wed");
  CHECK(count(occupancy) == 8 * (53 + 3 * 52));
  CHECK_THROWS_WITH(occupancy.set_days("mo-fr"), Contains("--days mo-fr"));
  CHECK_THROWS_WITH(occupancy.set_hours("18-8"), Contains("--occupied 18-8"));
}

TEST_CASE("a schedule has a value for each hour") {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& content) {
    std::ofstream(folder.path / name) << content;
    return folder.path / name;
  };
  std::string text = "hour,occupancy\n";
  for (int i = 0; i < 8760; ++i) text += i % 24 == 10 ? "x,0.5\n" : "x,0\n";
  Occupancy occupancy;
  occupancy.schedule = write("a.csv", text);
  CHECK(count(occupancy) == 365);
  occupancy.schedule = write("b.csv", text + "x,1\n");
  CHECK_THROWS_WITH(count(occupancy), Contains("8761 hours"));
  occupancy.schedule = write("c.csv", "0\n-1\n");
  CHECK_THROWS_WITH(count(occupancy), Contains("line 2: '-1'"));
}

}  // namespace photile::test
