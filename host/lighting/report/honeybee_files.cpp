#include "report/honeybee_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <utility>

#include "photile/errors.hpp"
#include "report/tables.hpp"

namespace photile::report {

namespace {

using Json = nlohmann::ordered_json;

/// A name as honeybee cleans identifiers: letters, digits, '.', '_' and '-'.
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

std::vector<std::string> annual_names(const std::vector<measuring::SensorGrid>& grids,
                                      std::size_t states) {
  std::vector<std::string> names{"grids_info.json", "grid_states.json", "states_schedule.json",
                                 "sun-up-hours.txt"};
  for (const std::string& name : honeybee_names(grids)) {
    const std::string identifier = name.substr(0, name.size() - 4);
    for (const char* ending : {".ill", "_direct.ill"}) names.push_back(identifier + ending);
    for (std::size_t state = 0; state < states; ++state) {
      const std::string folder =
          states > 1 ? fmt::format("blinds/{}_blinds", state) : "__static_apertures__/default";
      for (const char* kind : {"/total/", "/direct/"}) {
        names.push_back(folder + kind + identifier + ".npy");
      }
    }
  }
  return names;
}

Json honeybee_record(const measuring::Measurement& measurement) {
  Json grids = measurement_json(measurement);
  for (std::size_t g = 0; g < grids.size(); ++g)
    grids[g]["identifier"] = identifier_of(measurement[g].grid.name);
  return {{"grids", std::move(grids)}};
}

Json annual_record(const DaylightResults& results, const std::vector<daylight::SkyHour>& hours,
                   const std::filesystem::path& values) {
  Json record{{"hours", hours.size()},
              {"up", Json::array()},
              {"sun", !results.grids.front().sun.empty()},
              {"states", results.states.size()},
              {"state_of_hour", results.state_of_hour}};
  for (std::size_t h = 0; h < hours.size(); ++h) {
    if (hours[h].sun.elevation > 0) record["up"].push_back(h);
  }
  std::ofstream stream(values, std::ios::binary);
  const auto add = [&](const GridDaylight& grid) {
    for (const auto* lux : {&grid.lux, &grid.sun}) {
      stream.write(reinterpret_cast<const char*>(lux->data()),
                   static_cast<std::streamsize>(lux->size() * sizeof(float)));
    }
  };
  for (std::size_t g = 0; g < results.grids.size(); ++g) {
    const measuring::SensorGrid& grid = results.grids[g].grid;
    record["grids"].push_back({{"name", grid.name},
                               {"identifier", identifier_of(grid.name)},
                               {"count", grid.sensors.size()}});
    add(results.grids[g]);
    for (const DaylightState& state : results.states) add(state.grids[g]);
  }
  if (!stream.flush()) {
    throw OutputError(values.string() +
                      ": cannot be written; set TMPDIR to a folder with more space");
  }
  return record;
}

}  // namespace photile::report
