// EPW files, whole and damaged.
#include "weather/weather_file.hpp"

#include <random>

#include "file_bytes.hpp"
#include "message_of.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"
#include "weather_text.hpp"

namespace photile::test {

namespace {

/// Direct irradiance tells month and day, diffuse the hour.
std::string text_of_year() {
  return weather_text([](int month, int day, int) { return 10 * month + day; },
                      [](int, int, int hour) { return hour; });
}

std::string error_of(const TemporaryFolder& folder, const std::string& text) {
  const auto file = folder.path / "bad.epw";
  put(file, text);
  return message_of<InputError>([&] { weather::read_weather(file); });
}

weather::WeatherYear year_of(const TemporaryFolder& folder, const std::string& text) {
  const auto file = folder.path / "good.epw";
  put(file, text);
  return weather::read_weather(file);
}

std::size_t hours_in(const TemporaryFolder& folder, const std::string& text) {
  return year_of(folder, text).hours.size();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("the hours of a weather file are read, their middle half an hour before their name") {
  const weather::WeatherYear year = year_of(TemporaryFolder(), text_of_year());
  CHECK(year.site.latitude_degrees == 52.5);
  CHECK(year.site.longitude_degrees == 13.4);
  CHECK(year.site.time_zone == 1);
  REQUIRE(year.hours.size() == 8760);
  const weather::WeatherHour& hour = weather::hour_at(year, {2026, 6, 21, 14.25});
  CHECK(hour.month == 6);
  CHECK(hour.day == 21);
  CHECK(hour.hour == 14.5);
  CHECK(hour.irradiance.direct_normal == 81);
  CHECK(hour.irradiance.diffuse_horizontal == 15);
  CHECK(hour.irradiance.dew_point == 5.5);
}

TEST_CASE("a moment takes the row that covers it, and the sun of that row's middle") {
  const weather::WeatherYear year = year_of(TemporaryFolder(), text_of_year());
  // The row of hour 10 covers 9:00 to 10:00.
  for (const double hour : {9.01, 9.5, 9.75, 10.0}) {
    CAPTURE(hour);
    const LocalTime time{2026, 6, 21, hour};
    const weather::WeatherHour& row = weather::hour_at(year, time);
    CHECK(row.irradiance.diffuse_horizontal == 10);
    const LocalTime middle = weather::middle_of(row, time);
    CHECK(middle.hour == 9.5);
    CHECK((middle.year == 2026 && middle.month == 6 && middle.day == 21));
  }
  CHECK(weather::hour_at(year, {2026, 6, 21, 0.0}).irradiance.diffuse_horizontal == 1);
}

TEST_CASE("a header says its data period as tools do") {
  const TemporaryFolder folder;
  CHECK(hours_in(folder, replaced(text_of_year(), "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31",
                                  "data periods,1,1,,Monday,1/1/2005,12/31/2005")) == 8760);
}

TEST_CASE("a leap year has its 29th of February, and may begin on any day") {
  const TemporaryFolder folder;
  std::string text = text_of_year(), leap;
  const std::size_t february = text.find("2005,2,28,1,"), march = text.find("2005,3,1,1,");
  leap = text.substr(february, march - february);
  for (std::size_t at = leap.find("2005,2,28,"); at != std::string::npos;
       at = leap.find("2005,2,28,")) {
    leap.replace(at, 10, "2005,2,29,");
  }
  CHECK(hours_in(folder, text.substr(0, march) + leap + text.substr(march)) == 8784);
  const std::size_t january = text.find("2005,1,1,1,"), july = text.find("2005,7,1,1,");
  const std::string shifted = replaced(text.substr(0, january), " 1/ 1,12/31", " 7/ 1, 6/30") +
                              text.substr(july) + text.substr(january, july - january);
  CHECK(hours_in(folder, shifted) == 8760);
}

TEST_CASE("random bytes in a weather file never do worse than an error") {
  const TemporaryFolder folder;
  const std::string good = text_of_year();
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    std::string text = good.substr(0, trial % 2 == 0 ? good.size() : random() % good.size());
    for (int change = 0; change < 40 && !text.empty(); ++change)
      text[random() % text.size()] = static_cast<char>(random());
    const std::string error = error_of(folder, text);
    CHECK(error.find('\n') == std::string::npos);
  }
}

}  // namespace photile::test
