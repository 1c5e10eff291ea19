#include "report/included_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::report {
namespace {

using nlohmann::json;

constexpr std::size_t most_observers = 12;  ///< more do not fit on a page

std::string measured_text(const json& entry, const char* key, int digits) {
  if (!entry.contains(key) || entry[key].is_null()) return "";
  const double value = entry[key].at("value").get<double>();
  const double error = entry[key].at("standard_error").get<double>();
  return fmt::format("{:.{}f} \u00b1 {:.{}f}", value, digits, error, digits);
}

glm::dvec3 vector_of(const json& three) {
  return {three.at(0).get<double>(), three.at(1).get<double>(), three.at(2).get<double>()};
}

std::string place_text(const json& place) {
  const glm::dvec3 p = vector_of(place);
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x, p.y, p.z);
}

/// None where no lamp is seen.
std::optional<double> ugr_of(const json& observer) {
  if (observer.at("ugr").is_null()) return std::nullopt;
  return observer["ugr"].at("value").get<double>();
}

ReportTable glare_table(std::vector<json> observers) {
  std::stable_sort(observers.begin(), observers.end(),
                   [](const json& a, const json& b) { return ugr_of(a) > ugr_of(b); });
  ReportTable table{"Glare", {"observer", "eyes (x, y, z), m", "UGR", "DGP", "lux at the eye"}, {}};
  if (observers.size() > most_observers) {
    table.heading +=
        fmt::format(" (the worst {} of {} observers)", most_observers, observers.size());
    observers.resize(most_observers);
  }
  for (const json& each : observers) {
    const std::optional<double> ugr = ugr_of(each);
    const std::string plain = ugr ? measuring::glare_text(*ugr) : "";
    table.rows.push_back({each.at("name").get<std::string>(), place_text(each.at("position")),
                          plain.starts_with('<') ? plain : measured_text(each, "ugr", 1),
                          measured_text(each, "dgp", 3), measured_text(each, "illuminance", 0)});
  }
  return table;
}

void judge_glare(const json& observers, const measuring::Requirement& requirement,
                 IncludedResults& results) {
  if (!(requirement.glare > 0)) return;
  for (const json& each : observers) {
    const std::optional<double> value = ugr_of(each);
    if (!value || (results.glare && results.glare->measured.value >= *value)) continue;
    results.glare = {each.at("name").get<std::string>(),
                     "UGR",
                     requirement.glare,
                     {*value, each["ugr"].at("standard_error").get<double>()},
                     true};
  }
}

ReportTable daylight_table(const json& grids) {
  ReportTable table{
      "A year of daylight",
      {"grid", "mean, lux", "DA", "sDA", "ASE", "EN 17037: half of the area", "95% of it"},
      {}};
  for (const json& grid : grids) {
    const json errors = grid.value("standard_errors", json::object());
    const auto share = [&](const char* key) -> std::string {
      if (!grid.contains(key)) return "";
      const double value = 100 * grid[key].get<double>();
      if (!errors.contains(key)) return fmt::format("{:.1f}%", value);
      return fmt::format("{:.1f} \u00b1 {:.2g}%", value, 100 * errors[key].get<double>());
    };
    const auto lux = [&](const char* key) {
      return fmt::format("{:.0f} lux", grid.at("EN 17037").at(key).get<double>());
    };
    table.rows.push_back({grid.at("name").get<std::string>(),
                          fmt::format("{:.0f}", grid.at("mean_lux").get<double>()), share("DA"),
                          share("sDA"), share("ASE"), lux("target_lux"),
                          lux("minimum_target_lux")});
  }
  return table;
}

/// Errors: std::domain_error where it is no plane; those of JSON.
measuring::PlaneLayout layout_of(const json& plane) {
  const measuring::PlaneLayout layout{vector_of(plane.at("origin")), vector_of(plane.at("u")),
                                      vector_of(plane.at("v")),      plane.at("columns").get<int>(),
                                      plane.at("rows").get<int>(),   {}};
  const double sides = glm::length(layout.u) * glm::length(layout.v);
  const bool sound = sides > 0 && std::isfinite(sides) && layout.columns > 0 && layout.rows > 0 &&
                     double{1} * layout.columns * layout.rows <= limits::max_sensors;
  if (!sound) throw std::domain_error("no plane");
  return layout;
}

/// Values of points on a plane by the cells that they lie in; of several in one the highest.
///   entries   with "position"
///   value     of an entry, none where it has none
template <class Value>
ReportMap map_of(const json& plane, const std::string& grid, const std::string& figure,
                 FalseColour colours, const json& entries, const Value& value) {
  measuring::PlaneLayout layout = layout_of(plane);
  std::map<std::uint32_t, double> values;
  for (const json& entry : entries) {
    const std::optional<double> found = value(entry);
    const glm::dvec2 at = layout.in_cells(vector_of(entry.at("position")));
    if (!found || !(at.x >= 0 && at.x < layout.columns && at.y >= 0 && at.y < layout.rows))
      continue;
    const auto cell =
        static_cast<std::uint32_t>(at.y) * static_cast<std::uint32_t>(layout.columns) +
        static_cast<std::uint32_t>(at.x);
    const auto [place, is_first] = values.emplace(cell, *found);
    if (!is_first) place->second = std::max(place->second, *found);
  }
  measuring::LightValues light{figure, {}, {}};
  for (const auto& [cell, one] : values) {
    layout.cells.push_back(cell);
    light.sensors.push_back({one, 0});
  }
  ReportMap map{{measuring::grid_on_plane(grid, std::move(layout)), {std::move(light)}},
                std::move(colours)};
  return map;
}

void add_daylight_maps(const json& grid, IncludedResults& results) {
  if (!grid.contains("plane")) return;
  FalseColour percent;
  percent.scale = 100;
  percent.steps = 10;
  percent.label = "%";
  const auto add = [&](const std::string& figure, const auto& share) {
    results.maps.push_back(map_of(
        grid["plane"], grid.at("name").get<std::string>(), figure, percent, grid.at("sensors"),
        [&](const json& sensor) { return std::optional(100 * share(sensor)); }));
  };
  add(fmt::format("DA {:g} lux", grid.at("target_lux").get<double>()),
      [](const json& sensor) { return sensor.at("DA").get<double>(); });
  add("UDI 100 to 3000 lux", [](const json& sensor) {
    const json& useful = sensor.at("UDI");
    return useful.at("100 to 300").get<double>() + useful.at("300 to 3000").get<double>();
  });
}

void add_glare_map(const json& record, IncludedResults& results) {
  if (!record.contains("plane")) return;
  FalseColour ratings;
  ratings.scale = 32;
  ratings.label = "UGR";
  const auto drawn = [](const json& observer) {
    const std::optional<double> rating = ugr_of(observer);
    return rating ? std::optional(std::max(*rating, measuring::least_glare)) : std::nullopt;
  };
  results.maps.push_back(map_of(record["plane"], "observers", "the highest UGR", ratings,
                                record.at("observers"), drawn));
}

}  // namespace

void include_result(const json& content, const std::optional<measuring::Requirement>& requirement,
                    IncludedResults& results) {
  if (content.is_array()) {
    results.tables.push_back(daylight_table(content));
    for (const json& grid : content) add_daylight_maps(grid, results);
    for (const json& lamp : content.empty() ? json() : content[0].value("lamps", json())) {
      results.kilowatt_hours += lamp.at("kilowatt_hours").get<double>();
    }
    return;
  }
  const json& observers = content.at("observers");
  results.tables.push_back(glare_table(observers.get<std::vector<json>>()));
  add_glare_map(content, results);
  if (requirement) judge_glare(observers, *requirement, results);
}

IncludedResults included_results(std::span<const std::filesystem::path> files,
                                 const std::optional<measuring::Requirement>& requirement) {
  IncludedResults results;
  for (const std::filesystem::path& file : files) {
    const json content = read_input_json(file);
    try {
      include_result(content, requirement, results);
    } catch (const std::exception&) {  // its text means something to programmers alone
      throw InputError(fmt::format(
          "{}: is no result of a year or of observers; give what photile glare or daylight has "
          "written by -o FILE.json",
          file.string()));
    }
  }
  return results;
}

}  // namespace photile::report
