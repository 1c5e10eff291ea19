#include "tools/report/daylight_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "photile/errors.hpp"
#include "tools/report/honeybee_files.hpp"

namespace photile::measuring {
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

}  // namespace

std::vector<std::string> daylight_lines(const std::vector<GridDaylight>& grids,
                                        const DaylightAsked& asked) {
  std::vector<std::string> lines;
  for (const GridDaylight& grid : grids) {
    const daylight::RoomDaylight& room = grid.room;
    lines.push_back(fmt::format("{}: {} points", grid.grid.name, grid.grid.sensors.size()));
    lines.push_back(fmt::format("  annual mean      {:.4g} lux, +-{:.1f}% a point", room.mean_lux,
                                100 * mean_error(grid)));
    lines.push_back(fmt::format("  DA {:<13.4g} {:.1f}% of the hours from {:g} to {:g}",
                                asked.wanted_lux, 100 * room.autonomy, asked.occupancy.from,
                                asked.occupancy.to));
    lines.push_back(fmt::format("  sDA {:.4g},50%{:<5} {:.1f}% of the points", asked.wanted_lux, "",
                                100 * room.spatial_autonomy));
    if (!grid.sun.empty()) {
      lines.push_back(
          fmt::format("  ASE 1000,250h    {:.1f}% of the points", 100 * room.sunlight_exposure));
    }
    lines.push_back(fmt::format(
        "  UDI              {:.1f}% below 100 lux, {:.1f}% to 300, {:.1f}% "
        "to 3000, {:.1f}% above",
        100 * room.useful[0], 100 * room.useful[1], 100 * room.useful[2], 100 * room.useful[3]));
    lines.push_back(
        fmt::format("  EN 17037         {}: half of the points have {:.4g} lux in half "
                    "of the daylight hours, 95% have {:.4g}",
                    room.level, room.target_lux, room.minimum_target_lux));
    for (const daylight::LampEnergy& lamp : grid.lamps) {
      lines.push_back(
          fmt::format("  {:<16} {:.4g} kWh a year dimmed, {:.4g} at full power ({:.4g} "
                      "W)",
                      lamp.lamp, lamp.kilowatt_hours, lamp.undimmed, lamp.watts));
    }
  }
  return lines;
}

std::string daylight_csv(const std::vector<GridDaylight>& grids) {
  std::string text =
      "grid,point,x,y,z,dx,dy,dz,mean_lux,relative_error,da,cda,udi_below_100,udi_100_300,"
      "udi_300_3000,udi_above_3000,sun_hours,median_lux\n";
  for (const GridDaylight& grid : grids) {
    std::string name = grid.grid.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ',' || c == '"'; }, '_');
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
      const Sensor& sensor = grid.grid.sensors[i];
      const glm::dvec3 &p = sensor.position, &n = sensor.normal;
      const daylight::PointDaylight& point = grid.points[i];
      text += fmt::format(
          "{},{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g},{:.6g},{:.3g},{:.4f},{:.4f},{:.4f},"
          "{:.4f},{:.4f},{:.4f},{:g},{:.6g}\n",
          name, i, p.x, p.y, p.z, n.x, n.y, n.z, point.mean_lux, grid.relative_error[i],
          point.autonomy, point.continuous_autonomy, point.useful[0], point.useful[1],
          point.useful[2], point.useful[3], point.sun_hours, point.median_lux);
    }
  }
  return text;
}

Json daylight_json(const std::vector<GridDaylight>& grids, const DaylightAsked& asked) {
  Json all = Json::array();
  for (const GridDaylight& grid : grids) {
    const daylight::RoomDaylight& room = grid.room;
    Json entry{{"name", grid.grid.name},
               {"points", grid.grid.sensors.size()},
               {"wanted_lux", asked.wanted_lux},
               {"occupied", {asked.occupancy.from, asked.occupancy.to}},
               {"mean_lux", room.mean_lux},
               {"mean_relative_error", mean_error(grid)},
               {"DA", room.autonomy},
               {"sDA", room.spatial_autonomy},
               {"UDI", useful_json(room.useful)},
               {"EN 17037",
                {{"level", room.level},
                 {"target_lux", room.target_lux},
                 {"minimum_target_lux", room.minimum_target_lux}}}};
    if (!grid.sun.empty()) entry["ASE"] = room.sunlight_exposure;
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
    }
    all.push_back(std::move(entry));
  }
  return all;
}

std::map<std::string, std::string> annual_files(const std::vector<GridDaylight>& grids,
                                                const std::vector<daylight::SkyHour>& hours) {
  std::map<std::string, std::string> files;
  std::vector<std::size_t> up;
  std::string up_hours;
  for (std::size_t h = 0; h < hours.size(); ++h) {
    if (!(hours[h].sun.elevation > 0)) continue;
    up.push_back(h);
    up_hours += fmt::format("{:g}\n", static_cast<double>(h) + 0.5);
  }
  files["sun-up-hours.txt"] = up_hours;
  std::vector<SensorGrid> named;
  for (const GridDaylight& grid : grids) named.push_back(grid.grid);
  const std::vector<std::string> names = honeybee_names(named);
  Json info = Json::array();
  for (std::size_t g = 0; g < grids.size(); ++g) {
    const std::string identifier = names[g].substr(0, names[g].size() - 4);
    const auto lines = [&](const std::vector<float>& lux) {
      std::string text;
      for (std::size_t sensor = 0; sensor < grids[g].points.size(); ++sensor) {
        for (std::size_t i = 0; i < up.size(); ++i) {
          text += fmt::format("{}{:.4g}", i == 0 ? "" : " ", lux[sensor * hours.size() + up[i]]);
        }
        text += '\n';
      }
      return text;
    };
    files[identifier + ".ill"] = lines(grids[g].lux);
    if (!grids[g].sun.empty()) files[identifier + "_direct.ill"] = lines(grids[g].sun);
    info.push_back({{"name", grids[g].grid.name},
                    {"identifier", identifier},
                    {"full_id", identifier},
                    {"group", ""},
                    {"count", grids[g].points.size()}});
  }
  files["grids_info.json"] =
      info.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return files;
}

}  // namespace photile::measuring
