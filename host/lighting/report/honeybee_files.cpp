#include "report/honeybee_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

#include "common/foreign_text.hpp"
#include "photile/errors.hpp"

namespace photile::report {

namespace {

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

using Json = nlohmann::ordered_json;

Json grid_info(const std::string& name, const std::string& identifier, std::size_t count) {
  return {{"name", name},
          {"identifier", identifier},
          {"full_id", identifier},
          {"group", ""},
          {"count", count}};
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
  Json grids = Json::array();
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
    grids.push_back(grid_info(values.grid.name, identifier,
                              values.grid.sensors.size() + values.grid.blanks.size()));
    const measuring::GridStatistics& statistics = values.total().statistics;
    summary += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.4g}\n", identifier, identifier,
                           statistics.mean.value, statistics.minimum.value,
                           statistics.maximum.value, 100 * statistics.uniformity.value);
  }
  files["grids_info.json"] = json_text(grids, 2);
  files["grid_summary.csv"] = summary;
  return files;
}

namespace {

constexpr std::size_t hours_of_common_year = 8'760;
constexpr const char* group_of_blinds = "blinds";
constexpr const char* folder_without_blinds = "__static_apertures__/default";

std::string name_of_state(std::size_t state) {
  return fmt::format("{}_{}", state, group_of_blinds);
}
std::string folder_of_state(std::size_t state) {
  return fmt::format("{}/{}", group_of_blinds, name_of_state(state));
}

/// Four digits, or all before the point.
void append_lux(std::string& text, float lux) {
  const int decimals = lux < 1 ? 4 : lux < 10 ? 3 : lux < 100 ? 2 : lux < 1000 ? 1 : 0;
  if (lux < 5e-5f) {
    text += '0';
  } else {
    fmt::format_to(std::back_inserter(text), "{:.{}f}", lux, decimals);
  }
}

/// The hours with the sun up, of one profile.
class Profile {
 public:
  Profile(std::span<const float> lux, std::size_t sensors, std::span<const std::size_t> up)
      : lux_(lux), sensors_(sensors), hours_(sensors > 0 ? lux.size() / sensors : 0), up_(up) {}

  std::string lines() const {
    std::string text;
    text.reserve(6 * sensors_ * up_.size());
    for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
      for (std::size_t i = 0; i < up_.size(); ++i) {
        if (i > 0) text += ' ';
        append_lux(text, lux_[sensor * hours_ + up_[i]]);
      }
      text += '\n';
    }
    return text;
  }

  /// NumPy's format, version 1.0.
  std::string array() const {
    static_assert(std::endian::native == std::endian::little);
    std::string head = fmt::format(
        "{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", sensors_, up_.size());
    constexpr std::size_t before = 10, alignment = 64;
    head.append(alignment - (before + head.size() + 1) % alignment, ' ');
    head += '\n';
    std::string text("\x93NUMPY\x01\x00", 8);
    text += static_cast<char>(head.size() & 0xFF);
    text += static_cast<char>(head.size() >> 8);
    text += head;
    std::vector<float> row(up_.size());
    for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
      for (std::size_t i = 0; i < up_.size(); ++i) row[i] = lux_[sensor * hours_ + up_[i]];
      text.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float));
    }
    return text;
  }

 private:
  std::span<const float> lux_;
  std::size_t sensors_, hours_;
  std::span<const std::size_t> up_;
};

}  // namespace

std::vector<std::string> annual_names(const std::vector<measuring::SensorGrid>& grids,
                                      std::size_t states) {
  std::vector<std::string> names{"grids_info.json", "grid_states.json", "states_schedule.json",
                                 "sun-up-hours.txt"};
  for (const std::string& name : honeybee_names(grids)) {
    const std::string identifier = name.substr(0, name.size() - 4);
    for (const char* ending : {".ill", "_direct.ill"}) names.push_back(identifier + ending);
    for (std::size_t state = 0; state < states; ++state) {
      const std::string folder = states > 1 ? folder_of_state(state) : folder_without_blinds;
      for (const char* kind : {"/total/", "/direct/"}) {
        names.push_back(folder + kind + identifier + ".npy");
      }
    }
  }
  return names;
}

std::map<std::string, std::string> annual_files(const DaylightResults& results,
                                                const std::vector<daylight::SkyHour>& hours) {
  std::map<std::string, std::string> files;
  std::vector<std::size_t> up;
  for (std::size_t h = 0; h < hours.size(); ++h) {
    if (!(hours[h].sun.elevation > 0)) continue;
    up.push_back(h);
    files["sun-up-hours.txt"] += fmt::format("{:g}\n", static_cast<double>(h) + 0.5);
  }
  std::vector<measuring::SensorGrid> named;
  for (const GridDaylight& grid : results.grids) named.push_back(grid.grid);
  const std::vector<std::string> names = honeybee_names(named);
  const bool with_blinds = !results.states.empty();
  Json info = Json::array(), states = Json::object();
  const auto add_arrays = [&](const std::string& folder, const std::string& identifier,
                              const GridDaylight& grid) {
    const std::size_t count = grid.points.size();
    files[folder + "/total/" + identifier + ".npy"] = Profile(grid.lux, count, up).array();
    if (!grid.sun.empty())
      files[folder + "/direct/" + identifier + ".npy"] = Profile(grid.sun, count, up).array();
  };
  for (std::size_t g = 0; g < results.grids.size(); ++g) {
    const GridDaylight& grid = results.grids[g];
    const std::size_t count = grid.points.size();
    const std::string identifier = names[g].substr(0, names[g].size() - 4);
    files[identifier + ".ill"] = Profile(grid.lux, count, up).lines();
    if (!grid.sun.empty()) files[identifier + "_direct.ill"] = Profile(grid.sun, count, up).lines();
    const char* const path = with_blinds ? group_of_blinds : "__static_apertures__";
    for (std::size_t state = 0; state < results.states.size(); ++state) {
      states[identifier][group_of_blinds].push_back(name_of_state(state));
      add_arrays(folder_of_state(state), identifier, results.states[state].grids[g]);
    }
    if (!with_blinds) add_arrays(folder_without_blinds, identifier, grid);
    info.push_back(grid_info(grid.grid.name, identifier, count));
    info.back()["light_path"] = Json::array({Json::array({path})});
  }
  files["grids_info.json"] = json_text(info, 2);
  files["grid_states.json"] = json_text(states, 2);
  if (with_blinds && hours.size() == hours_of_common_year) {
    files["states_schedule.json"] = json_text(Json{{group_of_blinds,
                                                    {{"identifier", group_of_blinds},
                                                     {"schedule", results.state_of_hour},
                                                     {"is_static", false}}}});
  }
  return files;
}

}  // namespace photile::report
