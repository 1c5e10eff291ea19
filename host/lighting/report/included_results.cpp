#include "report/included_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/json_object.hpp"
#include "photile/errors.hpp"

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

std::string place_text(const json& place) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", place.at(0).get<double>(), place.at(1).get<double>(),
                     place.at(2).get<double>());
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
    table.rows.push_back({each.at("name").get<std::string>(), place_text(each.at("position")),
                          measured_text(each, "ugr", 1), measured_text(each, "dgp", 3),
                          measured_text(each, "illuminance", 0)});
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
    const auto share = [&](const char* key) {
      return grid.contains(key) ? fmt::format("{:.1f}%", 100 * grid[key].get<double>()) : "";
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

}  // namespace

IncludedResults included_results(std::span<const std::filesystem::path> files,
                                 const std::optional<measuring::Requirement>& requirement) {
  IncludedResults results;
  for (const std::filesystem::path& file : files) {
    const json content = read_input_json(file);
    try {
      if (content.is_array()) {
        results.tables.push_back(daylight_table(content));
        for (const json& lamp : content.empty() ? json() : content[0].value("lamps", json())) {
          results.kilowatt_hours += lamp.at("kilowatt_hours").get<double>();
        }
        continue;
      }
      const json& observers = content.at("observers");
      results.tables.push_back(glare_table(observers.get<std::vector<json>>()));
      if (requirement) judge_glare(observers, *requirement, results);
    } catch (const json::exception&) {  // its text means something to programmers alone
      throw InputError(fmt::format(
          "{}: is no result of a year or of observers; give what photile glare or daylight has "
          "written by -o FILE.json",
          file.string()));
    }
  }
  return results;
}

}  // namespace photile::report
