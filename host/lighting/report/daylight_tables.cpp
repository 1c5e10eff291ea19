#include "report/daylight_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/foreign_text.hpp"
#include "measuring/measurement.hpp"
#include "report/tables.hpp"

namespace photile::report {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::array<const char*, 4> useful_names{"below 100", "100 to 300", "300 to 3000",
                                                  "above 3000"};

Json useful_json(const std::array<double, 4>& useful) {
  Json json;
  for (std::size_t i = 0; i < useful.size(); ++i) json[useful_names[i]] = useful[i];
  return json;
}

double mean_error(const GridDaylight& grid) {
  double sum = 0;
  for (const float error : grid.relative_error) sum += double{error};
  return sum / static_cast<double>(std::max<std::size_t>(1, grid.relative_error.size()));
}

/// "8 to 18", or the name of the schedule.
std::string hours_of(const DaylightAsked& asked) {
  const auto count = std::count(asked.occupied.begin(), asked.occupied.end(), true);
  const daylight::Occupancy& occupancy = asked.occupancy;
  if (!occupancy.schedule.empty())
    return fmt::format("the {:L} hours of {}", count, occupancy.schedule.filename().string());
  const bool daily = std::count(occupancy.days.begin(), occupancy.days.end(), true) == 7;
  return fmt::format("the hours from {:g} to {:g}{}", occupancy.from, occupancy.to,
                     daily ? "" : fmt::format(" of the requested days ({} h)", count));
}

/// "83.9%", with its standard error where there is one.
std::string percent(double share, std::optional<double> error) {
  if (!error) return fmt::format("{:.1f}%", 100 * share);
  constexpr double least = 5e-5;  // of a per cent: what is less says nothing
  return fmt::format("{:.1f} +-{:.1g}%", 100 * share, 100 * *error < least ? 0 : 100 * *error);
}

/// By the hour whether any blinds are closed.
std::vector<bool> closed_hours(const DaylightResults& results) {
  std::vector<bool> closed;
  for (const std::size_t state : results.state_of_hour) closed.push_back(state != 0);
  return closed;
}

std::size_t count_occupied(const std::vector<bool>& hours, const std::vector<bool>& occupied) {
  std::size_t count = 0;
  for (std::size_t h = 0; h < hours.size(); ++h) count += hours[h] && occupied[h] ? 1 : 0;
  return count;
}

std::string csv_rows(const std::vector<GridDaylight>& grids, const std::string& last) {
  std::string text;
  for (const GridDaylight& grid : grids) {
    const std::string name = csv_field(grid.grid.name);
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
      const Sensor& sensor = grid.grid.sensors[i];
      const glm::dvec3 &p = sensor.position, &n = sensor.normal;
      const daylight::PointDaylight& point = grid.points[i];
      text += fmt::format(
          "{},{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{:.3g},{:.4f},{:.4f},{:.4f},"
          "{:.4f},{:.4f},{:.4f},{:g},{:.6g}{}\n",
          name, i, p.x, p.y, p.z, n.x, n.y, n.z, point.mean_lux, grid.relative_error[i],
          point.autonomy, point.continuous_autonomy, point.useful[0], point.useful[1],
          point.useful[2], point.useful[3], point.sun_hours, point.median_lux, last);
    }
  }
  return text;
}

Json grid_json(const GridDaylight& grid, const DaylightAsked& asked) {
  const daylight::RoomDaylight& room = grid.room;
  Json entry{{"name", grid.grid.name},
             {"points", grid.grid.sensors.size()},
             {"target_lux", asked.target_lux},
             {"occupied", {asked.occupancy.from, asked.occupancy.to}},
             {"occupied_hours", std::count(asked.occupied.begin(), asked.occupied.end(), true)},
             {"ground_reflectance", asked.ground},
             {"mean_lux", room.mean_lux},
             {"mean_relative_error", mean_error(grid)},
             {"DA", room.autonomy},
             {"sDA", room.spatial_autonomy},
             {"UDI", useful_json(room.useful)},
             {"EN 17037",
              {{"level", room.level},
               {"target_lux", room.target_lux},
               {"minimum_target_lux", room.minimum_target_lux}}}};
  if (grid.grid.layout) entry["plane"] = plane_json(*grid.grid.layout);
  if (!grid.sun.empty()) entry["ASE"] = room.sunlight_exposure;
  if (grid.errors) {
    entry["standard_errors"] = {{"mean_lux", grid.errors->mean_lux},
                                {"DA", grid.errors->autonomy},
                                {"sDA", grid.errors->spatial_autonomy},
                                {"UDI", useful_json(grid.errors->useful)}};
  }
  for (const daylight::LampEnergy& lamp : grid.lamps) {
    entry["lamps"].push_back({{"name", lamp.lamp},
                              {"watts", lamp.watts},
                              {"kilowatt_hours", lamp.kilowatt_hours},
                              {"undimmed_kilowatt_hours", lamp.undimmed}});
  }
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const Sensor& sensor = grid.grid.sensors[i];
    const daylight::PointDaylight& point = grid.points[i];
    entry["sensors"].push_back(
        {{"position", {sensor.position.x, sensor.position.y, sensor.position.z}},
         {"direction", {sensor.normal.x, sensor.normal.y, sensor.normal.z}},
         {"mean_lux", point.mean_lux},
         {"relative_error", grid.relative_error[i]},
         {"DA", point.autonomy},
         {"cDA", point.continuous_autonomy},
         {"UDI", useful_json(point.useful)},
         {"sun_hours", point.sun_hours},
         {"median_lux", point.median_lux}});
    if (grid.errors) entry["sensors"].back()["DA_error"] = grid.errors->point_autonomy[i];
  }
  return entry;
}

}  // namespace

std::string darkness_warning(double most_percent) {
  constexpr double least_percent = 0.1;
  if (most_percent >= least_percent) return {};
  const std::string reaches =
      most_percent > 0
          ? fmt::format(
                "hardly any skylight reaches the points: at most {:.2g}% of that on open ground",
                most_percent)
          : "no skylight reaches any point";
  return fmt::format("warning: {}: {}", reaches, measuring::closed_to_the_sky);
}

void keep_daylight_factors(measuring::Measurement& measurement, Progress& progress) {
  double most = 0;
  for (measuring::GridValues& values : measurement) {
    values.lights.resize(1);
    most = std::max(most, values.total().statistics.maximum.value);
  }
  const std::string warning = darkness_warning(most);
  if (!warning.empty()) progress.note(warning);
}

std::string autonomy_text(const GridDaylight& grid, const DaylightAsked& asked,
                          std::size_t rounds) {
  // IES LM-83-12: nominally accepted, and preferred.
  constexpr double accepted = 0.55, preferred = 0.75;
  constexpr std::size_t enough_rounds = 4;  // for an error that can be trusted
  const double share = grid.room.spatial_autonomy;
  const std::string text = fmt::format("sDA {:.4g},50%{:<5} ", asked.target_lux, "");
  if (!grid.errors) return text + percent(share, std::nullopt) + " of the points";
  const double error = grid.errors->spatial_autonomy;
  const auto clear_of = [&](double level) { return std::abs(share - level) >= 3 * error; };
  const bool certain = rounds >= enough_rounds && clear_of(accepted) && clear_of(preferred);
  return fmt::format("{}{} of the points: {} ({})", text, percent(share, error),
                     share >= preferred  ? "meets 75%"
                     : share >= accepted ? "meets 55%"
                                         : "misses 55%",
                     certain ? "certain" : "not certain yet");
}

std::vector<std::string> daylight_lines(const DaylightResults& results,
                                        const DaylightAsked& asked) {
  std::vector<std::string> lines;
  for (std::size_t g = 0; g < results.grids.size(); ++g) {
    const GridDaylight& grid = results.grids[g];
    const daylight::RoomDaylight& room = grid.room;
    lines.push_back(fmt::format(
        "{}: {} points{}", grid.grid.name, grid.grid.sensors.size(),
        grid.grid.blanks.empty() ? "" : fmt::format(", and {} left out", grid.grid.blanks.size())));
    lines.push_back(fmt::format("  annual mean      {:.4g} lux, +-{:.1f}% a point", room.mean_lux,
                                100 * mean_error(grid)));
    const auto error = [&](auto&& member) {
      return grid.errors ? std::optional(member(*grid.errors)) : std::nullopt;
    };
    const auto useful = [&](std::size_t i) {
      return percent(room.useful[i], error([i](const auto& of) { return of.useful[i]; }));
    };
    lines.push_back(
        fmt::format("  DA {:<13.4g} {} of {}", asked.target_lux,
                    percent(room.autonomy, error([](const auto& of) { return of.autonomy; })),
                    hours_of(asked)));
    lines.push_back("  " + autonomy_text(grid, asked, results.rounds));
    if (!grid.sun.empty()) {
      lines.push_back(
          fmt::format("  ASE 1000,250h    {:.1f}% of the points", 100 * room.sunlight_exposure));
    }
    lines.push_back(
        fmt::format("  UDI              {} below 100 lux, {} to 300, {} to 3000, {} above",
                    useful(0), useful(1), useful(2), useful(3)));
    lines.push_back(
        fmt::format("  EN 17037         {}: half of the points have {:.4g} lux in half "
                    "of the daylight hours, 95% have {:.4g}",
                    room.level, room.target_lux, room.minimum_target_lux));
    for (const DaylightState& state : results.states) {
      const GridDaylight& all_year = state.grids[g];
      lines.push_back(fmt::format("  {:<16} annual mean {:.4g} lux, sDA {:.1f}%", state.name,
                                  all_year.room.mean_lux, 100 * all_year.room.spatial_autonomy));
    }
    for (const daylight::LampEnergy& lamp : grid.lamps) {
      lines.push_back(
          fmt::format("  {:<16} {:.4g} kWh a year dimmed, {:.4g} at full power ({:.4g} "
                      "W)",
                      lamp.lamp, lamp.kilowatt_hours, lamp.undimmed, lamp.watts));
    }
  }
  if (!results.states.empty()) {
    const std::vector<bool> closed = closed_hours(results);
    lines.push_back(fmt::format("blinds closed: {} hours of the year, {} of the occupied ones",
                                std::count(closed.begin(), closed.end(), true),
                                count_occupied(closed, asked.occupied)));
  }
  lines.push_back(fmt::format("ground: reflectance {:g} below the horizon", asked.ground));
  return lines;
}

std::string daylight_csv(const DaylightResults& results, const DaylightAsked& asked) {
  std::string text =
      "grid,point,x,y,z,dx,dy,dz,mean_lux,relative_error,da,cda,udi_below_100,udi_100_300,"
      "udi_300_3000,udi_above_3000,sun_hours,median_lux";
  const std::string heading = ground_heading(asked.ground), ground = ground_field(asked.ground);
  if (results.states.empty()) return text + heading + "\n" + csv_rows(results.grids, ground);
  text += ",blinds" + heading + "\n" + csv_rows(results.grids, ",by schedule" + ground);
  for (const DaylightState& state : results.states)
    text += csv_rows(state.grids, fmt::format(",{}{}", csv_field(state.name), ground));
  return text;
}

Json daylight_json(const DaylightResults& results, const DaylightAsked& asked) {
  Json all = Json::array();
  const std::vector<bool> closed = closed_hours(results);
  for (std::size_t g = 0; g < results.grids.size(); ++g) {
    Json entry = grid_json(results.grids[g], asked);
    entry["EN 17037"]["median_outdoor_lux"] = results.outdoor_lux;
    if (!results.states.empty()) {
      Json& blinds = entry["blinds"];
      blinds["closed_hours"] = std::count(closed.begin(), closed.end(), true);
      blinds["closed_occupied_hours"] = count_occupied(closed, asked.occupied);
      blinds["state_of_hour"] = results.state_of_hour;
      for (const DaylightState& state : results.states) {
        Json of_state{{"state", state.name}};
        of_state.update(grid_json(state.grids[g], asked));
        blinds["states"].push_back(std::move(of_state));
      }
    }
    all.push_back(std::move(entry));
  }
  return all;
}

}  // namespace photile::report
