#include "report/tables.hpp"

#include <algorithm>
#include <cstddef>

#include "common/foreign_text.hpp"

namespace photile::report {

namespace {

using Json = nlohmann::ordered_json;

Json statistics_json(const measuring::GridStatistics& statistics) {
  Json minimum = measured_json(statistics.minimum), maximum = measured_json(statistics.maximum);
  minimum["at_most"] = statistics.minimum_at_most;
  maximum["at_least"] = statistics.maximum_at_least;
  return {{"Em", measured_json(statistics.mean)},
          {"Emin", minimum},
          {"Emax", maximum},
          {"Uo", measured_json(statistics.uniformity)},
          {"Ud", measured_json(statistics.diversity)}};
}

}  // namespace

Json plane_json(const measuring::PlaneLayout& layout) {
  return {{"origin", vector_json(layout.origin)},
          {"u", vector_json(layout.u)},
          {"v", vector_json(layout.v)},
          {"columns", layout.columns},
          {"rows", layout.rows},
          {"cells", layout.cells}};
}

namespace {

/// Why a value is doubtful, or "".
std::string mark_of(const measuring::SensorGrid& grid, std::size_t sensor) {
  return sensor < grid.marks.size() ? grid.marks[sensor] : "";
}

Json sensor_json(const measuring::GridValues& values, std::size_t sensor) {
  const Sensor& place = values.grid.sensors[sensor];
  const Measured& total = values.total().sensors[sensor];
  Json entry{{"position", vector_json(place.position)},
             {"direction", vector_json(place.normal)},
             {"lux", total.value},
             {"standard_error", total.standard_error}};
  if (const std::string mark = mark_of(values.grid, sensor); !mark.empty()) entry["mark"] = mark;
  for (std::size_t i = 1; i < values.lights.size(); ++i) {
    const Measured& part = values.lights[i].sensors[sensor];
    entry["lights"][values.lights[i].light] = {{"lux", part.value},
                                               {"standard_error", part.standard_error}};
  }
  return entry;
}

/// Of UTF-8.
std::size_t letters_in(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

std::string lux_with_error(const Measured& measured) {
  return fmt::format("{:>9} +-{:<8}", number_text(measured.value, 4),
                     number_text(measured.standard_error, 2));
}

std::string ratio_with_error(const Measured& measured) {
  return fmt::format("{:>6.3f} +-{:<6.2g}", measured.value, measured.standard_error);
}

}  // namespace

std::string grouped(double value, int digits) {
  std::string text = number_text(value, digits);
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  const std::size_t end = std::min(text.find_first_not_of("0123456789", sign), text.size());
  constexpr std::size_t most_ungrouped = 4;
  if (end - sign <= most_ungrouped) return text;
  for (std::size_t place = end; place > sign + 3;) text.insert(place -= 3, 1, ',');
  return text;
}

std::vector<std::string> aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], letters_in(row[i]));
    }
  }
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - letters_in(row[i]), ' ');
      line += i == 0 ? row[i] + blanks : "  " + blanks + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

std::string ground_heading(std::optional<double> ground) {
  return ground ? ",ground_reflectance" : "";
}

std::string ground_field(std::optional<double> ground) {
  return ground ? fmt::format(",{:g}", *ground) : "";
}

std::string measurement_csv(const measuring::Measurement& measurement, const std::string& unit,
                            std::optional<double> ground) {
  std::string text = fmt::format("grid,point,x,y,z,dx,dy,dz,{},standard_error", csv_field(unit));
  const auto& lights = measurement.front().lights;
  const bool any_mark = std::ranges::any_of(measurement, [](const measuring::GridValues& values) {
    return !measuring::counted_marks(values.grid).empty();
  });
  const bool any_blank = std::ranges::any_of(
      measurement, [](const measuring::GridValues& values) { return !values.grid.blanks.empty(); });
  for (std::size_t i = 1; i < lights.size(); ++i) {
    text += fmt::format(",{},{}", csv_field("lux " + lights[i].light),
                        csv_field("standard_error " + lights[i].light));
  }
  if (any_blank) text += ",blank";
  if (any_mark) text += ",mark";
  text += ground_heading(ground) + "\n";
  const std::string end = ground_field(ground) + "\n";
  for (const measuring::GridValues& values : measurement) {
    std::size_t point = 0;
    const auto start = [&](const Sensor& sensor) {
      const glm::dvec3 &p = sensor.position, &n = sensor.normal;
      text += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g}",
                          csv_field(values.grid.name), point++, p.x, p.y, p.z, n.x, n.y, n.z);
    };
    auto blank = values.grid.blanks.begin();
    for (std::size_t sensor = 0; sensor <= values.grid.sensors.size(); ++sensor) {
      for (; blank != values.grid.blanks.end() && blank->before == sensor; ++blank) {
        start(blank->sensor);
        text += std::string(2 * values.lights.size() + 1, ',') + csv_field(blank->reason) +
                (any_mark ? "," : "") + end;
      }
      if (sensor == values.grid.sensors.size()) break;
      start(values.grid.sensors[sensor]);
      for (const measuring::LightValues& light : values.lights) {
        text += fmt::format(",{:.6g},{:.3g}", light.sensors[sensor].value,
                            light.sensors[sensor].standard_error);
      }
      if (any_blank) text += ",";
      if (any_mark) text += fmt::format(",{}", csv_field(mark_of(values.grid, sensor)));
      text += end;
    }
  }
  return text;
}

Json measurement_json(const measuring::Measurement& measurement) {
  Json grids = Json::array();
  for (const measuring::GridValues& values : measurement) {
    Json grid{{"name", values.grid.name}, {"points", values.grid.sensors.size()}};
    if (values.grid.layout) grid["plane"] = plane_json(*values.grid.layout);
    grid["statistics"] = statistics_json(values.total().statistics);
    for (std::size_t i = 1; i < values.lights.size(); ++i) {
      grid["lights"][values.lights[i].light] = statistics_json(values.lights[i].statistics);
    }
    grid["sensors"] = Json::array();
    for (std::size_t sensor = 0; sensor < values.grid.sensors.size(); ++sensor) {
      grid["sensors"].push_back(sensor_json(values, sensor));
    }
    for (const measuring::BlankPoint& blank : values.grid.blanks) {
      grid["blank"].push_back({{"position", vector_json(blank.sensor.position)},
                               {"direction", vector_json(blank.sensor.normal)},
                               {"reason", blank.reason},
                               {"before", blank.before}});
    }
    grids.push_back(std::move(grid));
  }
  return grids;
}

std::vector<std::string> measurement_lines(const measuring::Measurement& measurement,
                                           const std::string& unit) {
  std::size_t width = 12;
  for (const measuring::LightValues& light : measurement.front().lights) {
    width = std::max(width, light.light.size() + 2);
  }
  std::vector<std::string> lines{fmt::format("{:<{}}{:>9}{:11}{:>9}{:11}{:>9}{:11}{:>6}{:9}{:>6}",
                                             unit, width, "Em", "", "Emin", "", "Emax", "", "Uo",
                                             "", "Ud")};
  for (const measuring::GridValues& values : measurement) {
    std::string heading =
        fmt::format("{}: {} points", values.grid.name, values.grid.sensors.size());
    if (values.grid.layout) {
      heading += fmt::format(", {:.2f} m apart", values.grid.layout->spacing());
    }
    if (!values.grid.blanks.empty()) {
      heading += fmt::format(", and {} left out", values.grid.blanks.size());
    }
    lines.push_back(heading);
    for (const auto& [mark, count] : measuring::counted_marks(values.grid)) {
      lines.push_back(fmt::format("  {} marked: {}", count, mark));
    }
    for (const measuring::LightValues& light : values.lights) {
      const measuring::GridStatistics& s = light.statistics;
      std::string line =
          fmt::format("  {:<{}}", light.light.empty() ? "all lights" : light.light, width - 2);
      for (const Measured& value : {s.mean, s.minimum, s.maximum}) line += lux_with_error(value);
      for (const Measured& value : {s.uniformity, s.diversity}) line += ratio_with_error(value);
      line.erase(line.find_last_not_of(' ') + 1);
      lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace photile::report
