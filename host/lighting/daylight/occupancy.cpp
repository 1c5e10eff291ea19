#include "daylight/occupancy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "common/ascii_text.hpp"
#include "common/input_file.hpp"
#include "photile/errors.hpp"

namespace photile::daylight {
namespace {

constexpr std::array<std::string_view, 7> day_names{"mon", "tue", "wed", "thu",
                                                    "fri", "sat", "sun"};

std::optional<std::size_t> day_of(std::string_view text) {
  const auto found = std::find(day_names.begin(), day_names.end(), lower(trimmed(text)));
  if (found == day_names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - day_names.begin());
}

std::vector<bool> read_schedule(const std::filesystem::path& file, std::size_t hours) {
  const std::string text = read_input_text(file);
  std::vector<bool> occupied;
  std::size_t number = 0;
  for (const std::string_view line : lines_of(text)) {
    ++number;
    if (trimmed(line).empty()) continue;
    const std::size_t comma = line.rfind(',');
    const std::string_view field =
        trimmed(comma == std::string_view::npos ? line : line.substr(comma + 1));
    const auto value = parse_signed(field);
    if (!value && number == 1) continue;  // names of columns
    if (!value || *value < 0) {
      throw InputError(fmt::format(
          "{}: line {}: '{}' is no number of 0 or more; give 1 for an occupied hour, 0 for others",
          file.string(), number, field));
    }
    occupied.push_back(*value > 0);
  }
  if (occupied.size() != hours) {
    throw InputError(fmt::format("{}: {} hours, where the weather has {}; give a line for each",
                                 file.string(), occupied.size(), hours));
  }
  return occupied;
}

}  // namespace

void Occupancy::set_hours(const std::string& text) {
  const std::size_t dash = text.find('-');
  if (dash != std::string::npos) {
    const auto first = parse_signed(text.substr(0, dash)),
               last = parse_signed(text.substr(dash + 1));
    if (first && last && *first >= 0 && *first < *last && *last <= 24) {
      from = *first;
      to = *last;
      return;
    }
  }
  throw UsageError(
      fmt::format("--occupied {}: use FROM-TO, such as 8-18, hours within 0 and 24", text));
}

void Occupancy::set_days(const std::string& text) {
  days.fill(false);
  std::string_view left = text;
  for (bool more = true; more;) {
    const std::size_t comma = left.find(',');
    const std::string_view part = left.substr(0, comma);
    const std::size_t dash = part.find('-');
    const auto first = day_of(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : day_of(part.substr(dash + 1));
    if (!first || !last) {
      throw UsageError(fmt::format("--days {}: use days such as mon-fri, or mon,wed,sat", text));
    }
    for (std::size_t day = *first;; day = (day + 1) % 7) {
      days[day] = true;
      if (day == *last) break;
    }
    more = comma != std::string_view::npos;
    if (more) left.remove_prefix(comma + 1);
  }
}

std::vector<bool> occupied_hours(const std::vector<SkyHour>& hours, const Occupancy& occupancy) {
  if (!occupancy.schedule.empty()) return read_schedule(occupancy.schedule, hours.size());
  std::vector<bool> occupied;
  for (const SkyHour& hour : hours) {
    occupied.push_back(hour.hour > occupancy.from && hour.hour < occupancy.to &&
                       occupancy.days[static_cast<std::size_t>(hour.weekday)]);
  }
  return occupied;
}

}  // namespace photile::daylight
