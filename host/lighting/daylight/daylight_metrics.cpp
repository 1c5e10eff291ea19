#include "daylight/daylight_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string_view>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
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
      throw InputError(
          fmt::format("{}: line {}: '{}' is not a number of 0 or more; give 1 for an occupied "
                      "hour, 0 for others",
                      file.string(), number, field));
    }
    occupied.push_back(*value > 0);
  }
  if (occupied.size() != hours) {
    throw InputError(fmt::format("{}: {} hours, but the weather file has {}; give a line for each",
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

namespace {

// IES LM-83-12.
constexpr double sun_lux = 1'000, sun_hours = 250;
constexpr double half = 0.5;
/// Bounds of useful daylight illuminance (Mardaljevic 2015), lux.
constexpr std::array<double, 3> useful_bounds{100, 300, 3'000};

/// EN 17037:2018, table A.1: lux that half of the room and 95% of it have.
struct Level {
  const char* name;
  double target, minimum_target;
};
constexpr std::array<Level, 3> levels{
    {{"high", 750, 500}, {"medium", 500, 300}, {"minimum", 300, 100}}};

/// The value that a fraction of the values reaches or exceeds.
double reached_by(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto count =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto reached = values.begin() + static_cast<std::ptrdiff_t>(
                                            std::clamp<std::size_t>(count, 1, values.size()) - 1);
  std::nth_element(values.begin(), reached, values.end(), std::greater<>());
  return *reached;
}

}  // namespace

std::vector<bool> daylight_hours(const std::vector<SkyHour>& hours) {
  std::vector<std::size_t> order(hours.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return hours[a].diffuse_lux > hours[b].diffuse_lux;
  });
  std::vector<bool> daylight(hours.size(), false);
  for (std::size_t i = 0; i < hours.size() / 2; ++i) daylight[order[i]] = true;
  return daylight;
}

double median_outdoors(const std::vector<SkyHour>& hours) {
  std::vector<double> lux;
  for (const SkyHour& hour : hours) lux.push_back(hour.diffuse_lux);
  return reached_by(std::move(lux), half * half);  // the daylight hours are half of all
}

PointDaylight point_daylight(std::span<const float> lux, std::span<const float> sun,
                             const std::vector<bool>& occupied, const std::vector<bool>& daylight,
                             double target_lux) {
  PointDaylight point;
  double hours = 0;
  std::vector<double> by_day;
  for (std::size_t h = 0; h < lux.size(); ++h) {
    const double value = lux[h];
    point.mean_lux += value / static_cast<double>(lux.size());
    if (daylight[h]) by_day.push_back(value);
    if (!occupied[h]) continue;
    ++hours;
    point.autonomy += value >= target_lux ? 1 : 0;
    point.continuous_autonomy += std::min(1.0, value / target_lux);
    const auto bin = std::upper_bound(useful_bounds.begin(), useful_bounds.end(), value);
    ++point.useful[static_cast<std::size_t>(bin - useful_bounds.begin())];
    point.sun_hours += !sun.empty() && double{sun[h]} > sun_lux ? 1 : 0;
  }
  if (hours > 0) {
    point.autonomy /= hours;
    point.continuous_autonomy /= hours;
    for (double& share : point.useful) share /= hours;
  }
  point.median_lux = reached_by(std::move(by_day), half);
  return point;
}

RoomDaylight room_daylight(std::span<const PointDaylight> points) {
  RoomDaylight room;
  std::vector<double> medians;
  const double share = 1 / static_cast<double>(std::max<std::size_t>(1, points.size()));
  for (const PointDaylight& point : points) {
    room.mean_lux += share * point.mean_lux;
    room.autonomy += share * point.autonomy;
    room.spatial_autonomy += point.autonomy >= half ? share : 0;
    room.sunlight_exposure += point.sun_hours > sun_hours ? share : 0;
    for (std::size_t i = 0; i < room.useful.size(); ++i) room.useful[i] += share * point.useful[i];
    medians.push_back(point.median_lux);
  }
  room.target_lux = reached_by(medians, half);
  room.minimum_target_lux = reached_by(medians, 0.95);
  room.level = "none";
  for (const Level& level : levels) {
    if (room.target_lux < level.target || room.minimum_target_lux < level.minimum_target) continue;
    room.level = level.name;
    break;
  }
  return room;
}

double jackknife_error(double all, std::span<const double> without,
                       std::span<const double> shares) {
  const auto parts = static_cast<double>(without.size());
  if (without.size() < 2) return 0;
  double estimate = parts * all;
  for (std::size_t g = 0; g < without.size(); ++g) estimate -= (1 - shares[g]) * without[g];
  double variance = 0;
  for (std::size_t g = 0; g < without.size(); ++g) {
    const double times = 1 / shares[g];
    const double difference = times * all - (times - 1) * without[g] - estimate;
    variance += difference * difference / (times - 1) / parts;
  }
  return std::sqrt(variance);
}

DaylightErrors daylight_errors(std::span<const PointDaylight> points,
                               std::span<const std::vector<PointDaylight>> without,
                               std::span<const double> shares) {
  std::vector<RoomDaylight> rooms;
  for (const auto& part : without) rooms.push_back(room_daylight(part));
  const RoomDaylight room = room_daylight(points);
  std::vector<double> values(without.size());
  const auto error_of = [&](double all, const auto& figure) {
    for (std::size_t g = 0; g < values.size(); ++g) values[g] = figure(g);
    return jackknife_error(all, values, shares);
  };
  DaylightErrors errors;
  errors.mean_lux = error_of(room.mean_lux, [&](std::size_t g) { return rooms[g].mean_lux; });
  errors.autonomy = error_of(room.autonomy, [&](std::size_t g) { return rooms[g].autonomy; });
  for (std::size_t i = 0; i < room.useful.size(); ++i) {
    errors.useful[i] = error_of(room.useful[i], [&](std::size_t g) { return rooms[g].useful[i]; });
  }
  // A sum over points of steps at a half, of normal values: the variance of each step, and of
  // pairs the first term of their covariance, which the slopes of the steps give.
  const double share = 1 / static_cast<double>(std::max<std::size_t>(1, points.size()));
  std::vector<double> slopes(points.size(), 0.0);
  double steps = 0, own = 0, all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double error =
        error_of(points[i].autonomy, [&](std::size_t g) { return without[g][i].autonomy; });
    errors.point_autonomy.push_back(error);
    if (!(error > 0)) continue;
    const double z = (points[i].autonomy - half) / error;
    const double above = std::erfc(-z / std::numbers::sqrt2) / 2;
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
    steps += share * share * above * (1 - above);
    own += share * share * density * density;
    slopes[i] = share * density / error;
    all += slopes[i] * points[i].autonomy;
  }
  const double together = error_of(all, [&](std::size_t g) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) sum += slopes[i] * without[g][i].autonomy;
    return sum;
  });
  errors.spatial_autonomy = std::sqrt(steps + std::max(0.0, together * together - own));
  return errors;
}

std::vector<LampEnergy> lamp_energy(std::span<const double> mean_daylight,
                                    const std::vector<bool>& occupied,
                                    const std::vector<std::string>& light_sampler,
                                    std::span<const double> lamp_mean,
                                    std::span<const double> watts, double target_lux) {
  const double full = std::accumulate(lamp_mean.begin(), lamp_mean.end(), 0.0);
  double dimmed_hours = 0, hours = 0;
  for (std::size_t h = 0; h < mean_daylight.size(); ++h) {
    if (!occupied[h]) continue;
    ++hours;
    const double lacking = target_lux - mean_daylight[h];
    if (lacking > 0) dimmed_hours += full > 0 ? std::min(1.0, lacking / full) : 1.0;
  }
  std::vector<LampEnergy> energies;
  for (std::size_t i = 0; i < light_sampler.size(); ++i) {
    energies.push_back(
        {light_sampler[i], watts[i], watts[i] * dimmed_hours / 1000, watts[i] * hours / 1000});
  }
  return energies;
}

}  // namespace photile::daylight
