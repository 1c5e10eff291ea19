#include "photometry/photometric_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "photile/limits.hpp"

namespace photile::photometry {

IntensityDistribution read_photometry(const std::string& name, std::span<const unsigned char> bytes,
                                      files::Warnings& warnings) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    if (bytes.size() > limits::max_photometry_bytes) {
      throw files::ResourceError(fmt::format("it has {} bytes; the limit is {}", bytes.size(),
                                             limits::max_photometry_bytes));
    }
    IntensityDistribution distribution = ends_in(name, ".ldt") ? read_eulumdat(name, text, warnings)
                                                               : read_ies(name, text, warnings);
    if (!(distribution.flux() > 0.0)) throw files::ResourceError("all intensities are 0");
    return distribution;
  } catch (const files::ResourceError& error) {
    throw files::ResourceError(fmt::format(
        "photometric file '{}': {}; get a new one from the manufacturer", name, error.what()));
  }
}

namespace {

/// The digits of a text, run by run, with where each begins.
struct Digits {
  std::size_t begin;
  std::string_view run;
};

std::vector<Digits> digits_in(std::string_view text) {
  constexpr std::string_view digits = "0123456789";
  std::vector<Digits> runs;
  for (std::size_t at = text.find_first_of(digits); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_not_of(digits, at), text.size());
    runs.push_back({at, text.substr(at, end - at)});
    at = text.find_first_of(digits, end);
  }
  return runs;
}

/// Groups of colour rendering by DIN 5035, as EULUMDAT has them, and the least Ra of each.
constexpr std::array<std::pair<std::string_view, int>, 8> rendering_groups{
    {{"1a", 90}, {"1b", 80}, {"2a", 70}, {"2b", 60}, {"1", 80}, {"2", 60}, {"3", 40}, {"4", 20}}};

/// "840": Ra from 80, 4000 K; as lamps are named worldwide.
bool is_colour_code(std::string_view run) {
  return run.size() == 3 && run[0] >= '7' && run[1] >= '1' && run[1] <= '8';
}

/// The temperatures that a text states, or else those of its colour codes.
std::vector<double> kelvins_in(std::string_view text) {
  std::vector<double> stated, coded;
  for (const Digits& digits : digits_in(text)) {
    const double value = parse_number<double>(digits.run).value_or(0);
    if (digits.run.size() >= 4 && value >= 1000 && value <= 25'000) stated.push_back(value);
    if (is_colour_code(digits.run)) coded.push_back(100 * *parse_number<int>(digits.run.substr(1)));
  }
  return stated.empty() ? coded : stated;
}

}  // namespace

double kelvin_in(std::string_view text) {
  const std::vector<double> all = kelvins_in(text);
  return all.empty() ? 0 : *std::min_element(all.begin(), all.end());
}

double highest_kelvin_in(std::string_view text) {
  const std::vector<double> all = kelvins_in(text);
  const double highest = all.empty() ? 0 : *std::max_element(all.begin(), all.end());
  return highest > kelvin_in(text) ? highest : 0;
}

double coded_rendering_in(std::string_view text) {
  for (const Digits& digits : digits_in(text)) {
    if (is_colour_code(digits.run)) return 10 * (digits.run[0] - '0');
  }
  return 0;
}

double rendering_in(std::string_view text) {
  constexpr double least_value = 20;
  const std::vector<Digits> all = digits_in(text);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Digits& digits = all[i];
    const double value = parse_number<double>(digits.run).value_or(0);
    if (digits.run.size() >= 2 && value >= least_value && value <= 100) return value;
    const bool other_index =  // "R9 50" is none of Ra
        digits.run.size() == 1 && digits.begin > 0 &&
        lower(text.substr(digits.begin - 1, 1)) == "r";
    if (other_index) ++i;
  }
  if (const double coded = coded_rendering_in(text); coded > 0) return coded;
  std::string words = lower(text);
  std::erase_if(words, [](char c) { return c == ' ' || c == '.' || c == '-'; });
  for (const auto& [name, least] : rendering_groups) {
    if (words.starts_with(name) && all.front().run.size() == 1) return least;
  }
  return 0;
}

namespace {

constexpr std::string_view separators = " \t\f\v,\x1A";  // old files end with Ctrl-Z
constexpr std::size_t longest_shown = 20;

/// A token as a message may show it.
std::string shown(std::string_view token) {
  std::string text(token.substr(0, longest_shown));
  std::replace_if(
      text.begin(), text.end(),
      [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E;
      },
      '?');
  return text;
}

}  // namespace

std::string_view NumberReader::token() {
  for (; line_ < lines_.size(); ++line_, column_ = 0) {
    const std::string_view line = lines_[line_];
    const std::size_t first = line.find_first_not_of(separators, column_);
    if (first == std::string_view::npos) continue;
    column_ = std::min(line.find_first_of(separators, first), line.size());
    return line.substr(first, column_ - first);
  }
  return {};
}

std::string NumberReader::place() const { return fmt::format("line {}", line_ + 1); }

double NumberReader::number(const std::string& what) {
  const std::string_view text = token();
  if (text.empty()) throw files::ResourceError(fmt::format("the file ends before the {}", what));
  const auto value = parse_signed(text);
  if (!value) {
    throw files::ResourceError(
        fmt::format("{}: the {} is '{}', not a number", place(), what, shown(text)));
  }
  return *value;
}

std::size_t NumberReader::count(const std::string& what, std::uint64_t lowest,
                                std::uint64_t highest) {
  const double value = number(what);
  if (value != std::floor(value) || value < static_cast<double>(lowest) ||
      value > static_cast<double>(highest)) {
    throw files::ResourceError(fmt::format("{}: the {} is {}, not a whole number from {} to {}",
                                           place(), what, value, lowest, highest));
  }
  return static_cast<std::size_t>(value);
}

std::vector<double> NumberReader::numbers(const std::string& what, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(number(fmt::format("{} {} of {}", what, i + 1, count)));
  }
  return values;
}

namespace {

/// Adds the images of the planes in a mirror at the last one.
void mirror_at_end(std::vector<MeasuredPlane>& planes) {
  const double mirror = planes.back().azimuth;
  for (std::size_t i = planes.size() - 1; i-- > 0;) {
    planes.push_back({2.0 * mirror - planes[i].azimuth, planes[i].measured});
  }
}

}  // namespace

std::vector<MeasuredPlane> planes_all_around(const std::vector<double>& azimuths) {
  const double first = azimuths.front(), last = azimuths.back(), range = last - first;
  if (azimuths.size() == 1) return {{0.0, 0}, {360.0, 0}};
  std::vector<MeasuredPlane> planes;
  double largest_step = 0;
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    planes.push_back({azimuths[i], i});
    if (i > 0) largest_step = std::max(largest_step, azimuths[i] - azimuths[i - 1]);
  }
  if (range == 90.0 && first == 0.0) {
    mirror_at_end(planes);
    mirror_at_end(planes);
  } else if (range == 180.0 && (first == 0.0 || first == 90.0)) {
    mirror_at_end(planes);
  } else if (range < 360.0 && range + 1.5 * largest_step >= 360.0) {
    planes.push_back({first + 360.0, 0});
  } else if (range != 360.0) {
    throw files::ResourceError(
        fmt::format("the horizontal angles run from {} to {} degrees; they must be 0, or run from "
                    "0 to 90, 0 to 180, 90 to 270 or 0 to 360",
                    first, last));
  }
  return planes;
}

}  // namespace photile::photometry
