#include "measuring/points_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "common/input_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::measuring {
namespace {

bool separates(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

/// The words of a line.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    if (separates(line[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < line.size() && !separates(line[end])) ++end;
    words.push_back(line.substr(i, end - i));
    i = end;
  }
  return words;
}

/// A whole word as a finite number within what a scene may hold; NaN where it is none.
double number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  return whole && std::abs(value) <= limits::max_coordinate ? value : NAN;
}

Sensor sensor_of(const std::vector<std::string_view>& words, const std::string& where) {
  if (words.size() != 6) {
    throw InputError(
        fmt::format("{}: {} numbers where a point has 6, x y z dx dy dz", where, words.size()));
  }
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = number_of(words[i]);
    if (std::isnan(numbers[i])) {
      throw InputError(
          fmt::format("{}: '{}' is no number of metres; write x y z dx dy dz", where, words[i]));
    }
  }
  const glm::dvec3 facing(numbers[3], numbers[4], numbers[5]);
  const double length = glm::length(facing);
  if (!(length > 0)) {
    throw InputError(fmt::format("{}: the direction is 0 0 0; it has to face somewhere", where));
  }
  return {{numbers[0], numbers[1], numbers[2]}, facing / length};
}

}  // namespace

SensorGrid read_points(const std::filesystem::path& file) {
  const std::string text = read_input_text(file);
  SensorGrid grid{file.stem().string(), {}, {}};
  std::size_t number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const auto words = words_of(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    ++number;
    if (words.empty() || words.front().starts_with('#')) continue;
    grid.sensors.push_back(sensor_of(words, fmt::format("{}: line {}", file.string(), number)));
    if (grid.sensors.size() > limits::max_sensors) {
      throw InputError(fmt::format("{}: more than {} points; split the file", file.string(),
                                   limits::max_sensors));
    }
  }
  if (grid.sensors.empty()) {
    throw InputError(fmt::format("{}: no points; each is a line x y z dx dy dz", file.string()));
  }
  return grid;
}

}  // namespace photile::measuring
