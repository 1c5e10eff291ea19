#include "report/honeybee_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "photile/errors.hpp"

namespace photile::report {
namespace {

/// As honeybee cleans identifiers: letters, digits, '.', '_' and '-'.
std::string identifier_of(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' ||
                      (c == '.' && !result.empty());
    result += kept ? c : '_';
  }
  return result;
}

}  // namespace

std::vector<std::string> honeybee_names(const std::vector<measuring::SensorGrid>& grids) {
  std::vector<std::string> names;
  for (const measuring::SensorGrid& grid : grids) {
    names.push_back(identifier_of(grid.name) + ".res");
    if (std::find(names.begin(), names.end() - 1, names.back()) != names.end() - 1) {
      throw UsageError(fmt::format("two grids are named '{}'; rename one", grid.name));
    }
  }
  return names;
}

std::map<std::string, std::string> honeybee_files(const measuring::Measurement& measurement) {
  std::map<std::string, std::string> files;
  nlohmann::ordered_json grids = nlohmann::ordered_json::array();
  std::string summary = "Sensor Grid,Sensor Grid ID,Mean,Minimum,Maximum,Uniformity Ratio\n";
  for (const measuring::GridValues& values : measurement) {
    const std::string identifier = identifier_of(values.grid.name);
    std::string lines;
    auto blank = values.grid.blanks.begin();  // lines stay those of the grid's points
    const auto add_blanks = [&](std::size_t before) {
      for (; blank != values.grid.blanks.end() && blank->before == before; ++blank)
        lines += "nan\n";
    };
    for (std::size_t sensor = 0; sensor < values.grid.sensors.size(); ++sensor) {
      add_blanks(sensor);
      lines += fmt::format("{:.6g}\n", values.total().sensors[sensor].value);
    }
    add_blanks(values.grid.sensors.size());
    if (!files.emplace(identifier + ".res", lines).second) {
      throw UsageError(fmt::format("two grids are named '{}'; rename one", values.grid.name));
    }
    grids.push_back({{"name", values.grid.name},
                     {"identifier", identifier},
                     {"full_id", identifier},
                     {"group", ""},
                     {"count", values.grid.sensors.size() + values.grid.blanks.size()}});
    const measuring::GridStatistics& statistics = values.total().statistics;
    summary += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.4g}\n", identifier, identifier,
                           statistics.mean.value, statistics.minimum.value,
                           statistics.maximum.value, 100 * statistics.uniformity.value);
  }
  files["grids_info.json"] =
      grids.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  files["grid_summary.csv"] = summary;
  return files;
}

}  // namespace photile::report
