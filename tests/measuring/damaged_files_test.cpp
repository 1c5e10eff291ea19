// Files of points and planes damaged at random, with fixed seeds: each gives sensors that can be
// measured at, or an InputError of one line that names the file.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

using nlohmann::json;

namespace {

void check_sensors(const measuring::SensorGrid& grid) {
  CHECK_FALSE(grid.sensors.empty());
  CHECK(grid.sensors.size() <= limits::max_sensors);
  std::size_t bad = 0;
  for (const auto& sensor : grid.sensors) {
    bad += !(glm::length(sensor.position) < 10 * limits::max_coordinate);
    bad += !(std::abs(glm::length(sensor.normal) - 1) < 1e-9);
  }
  CHECK(bad == 0);
}

/// Reads damaged files one after the other and counts.
struct DamagedFiles {
  void read_points(const std::string& text) {
    read("desk.pts", text, [](const auto& file) { check_sensors(measuring::read_points(file)); });
  }
  void read_planes(const std::string& text) {
    read("desk.json", text, [](const auto& file) {
      for (const auto& grid : measuring::read_planes(file)) check_sensors(grid);
    });
  }

  template <class Read>
  void read(const std::string& name, const std::string& text, const Read& reader) {
    const auto file = folder.path / name;
    std::ofstream(file, std::ios::binary) << text;
    try {
      reader(file);
      ++good;
    } catch (const InputError& error) {
      const std::string message = error.what();
      CAPTURE(message);
      CHECK(message.find(name) != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
      ++refused;
    }
  }

  TemporaryFolder folder;
  int good = 0, refused = 0;
};

std::string with_changes(std::string text, std::mt19937& random) {
  using namespace std::string_view_literals;
  constexpr auto bytes = "0123456789.-+eE, \n\t#naif{}[]\":\0\xFF"sv;
  for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
    text[random() % text.size()] = bytes[random() % bytes.size()];
  }
  return text;
}

const std::string points =
    "# desk\n1 2 0.75 0 0 1\r\n1.5,2,7.5e-1, 0,0,2\n\t+2\t-2\t.75\t1\t0\t-1\n";

json planes() {
  return json::parse(R"([
    {"name": "desk", "origin": [1, 2, 0.75], "u": [2, 0, 0], "v": [0, 1, 0], "spacing": 0.5},
    {"origin": [0, 0, 0], "u": [0, 0, 5], "v": [5, 0, 0]},
    {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "columns": 3, "rows": 2}])");
}

}  // namespace

TEST_CASE("points cut anywhere or with bytes replaced are read or refused", "[fuzz]") {
  std::mt19937 random(21);
  DamagedFiles files;
  for (std::size_t length = 0; length < points.size(); ++length) {
    files.read_points(points.substr(0, length));
  }
  for (int trial = 0; trial < 1'000; ++trial) files.read_points(with_changes(points, random));
  CHECK(files.good > 100);
  CHECK(files.refused > 100);
}

TEST_CASE("planes cut anywhere or with bytes replaced are read or refused", "[fuzz]") {
  std::mt19937 random(22);
  DamagedFiles files;
  const std::string text = planes().dump();
  for (std::size_t length = 0; length < text.size(); ++length) {
    files.read_planes(text.substr(0, length));
  }
  CHECK(files.good == 0);
  for (int trial = 0; trial < 1'000; ++trial) files.read_planes(with_changes(text, random));
  CHECK(files.good > 20);
  CHECK(files.refused > 100);
}

TEST_CASE("planes with values replaced are read or refused", "[fuzz]") {
  const std::vector<json> wild = {-1,
                                  0,
                                  1,
                                  7,
                                  1e-12,
                                  1e-300,
                                  1e11,
                                  1e300,
                                  -1e9,
                                  true,
                                  nullptr,
                                  "",
                                  "x",
                                  json::array(),
                                  0.1,
                                  1e-5,
                                  json::object(),
                                  json{0, 0, 0},
                                  18'446'744'073'709'551'615ull};
  std::mt19937 random(23);
  DamagedFiles files;
  const json whole = planes();
  for (int trial = 0; trial < 1'000; ++trial) {
    json damaged = whole;
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
      json& plane = damaged[random() % damaged.size()];
      auto member = plane.begin();
      std::advance(member, random() % plane.size());
      json& value = *member;
      if (value.is_array() && !value.empty() && random() % 2 == 0) {
        value[random() % value.size()] = wild[random() % wild.size()];
      } else {
        value = wild[random() % wild.size()];
      }
    }
    files.read_planes(damaged.dump());
  }
  CHECK(files.good > 20);
  CHECK(files.refused > 100);
}

}  // namespace photile::test
