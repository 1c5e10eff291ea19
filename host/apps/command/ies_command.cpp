#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/report_program.hpp"
#include "common/files.hpp"
#include "files/scene_files.hpp"
#include "loading/light_changes.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "report/record.hpp"

namespace photile::app {
namespace {

struct IesOptions {
  std::string file;
  bool ugr_table = false;
  double spacing = defaults::ugr_table_spacing;
  bool per_thousand_lumens = false;
  std::vector<std::string> outputs;  ///< .csv, .json
};

/// "0.1", or those of the sides towards C0, C90, C180 and C270 where they differ.
std::string heights_text(const LuminousOpening& opening) {
  const auto& heights = opening.heights;
  if (std::all_of(heights.begin(), heights.end(), [&](double h) { return h == heights[0]; })) {
    return fmt::format("{:.4g}", heights[0]);
  }
  return fmt::format("{:.4g}", fmt::join(heights, "/"));
}

/// "0.2", or "0.2 x 0.3" where two diameters differ.
std::string across_text(double first, double second) {
  return first == second ? fmt::format("{:.4g}", first)
                         : fmt::format("{:.4g} x {:.4g}", first, second);
}

/// A cylinder that lies along x (azimuth 0 of type C) or y, or, without length, a disc.
std::string lying_text(int azimuth, double length, double diameter, double height) {
  const std::string across = across_text(diameter, height);
  if (length > 0) {
    return fmt::format("cylinder along azimuth {}, {:.4g} m long, {} m across", azimuth, length,
                       across);
  }
  return fmt::format("disc that faces azimuth {}, {} m across", azimuth, across);
}

std::string opening_text(const LuminousOpening& opening) {
  if (!opening.stated()) return "none stated";
  using Shape = LuminousOpening::Shape;
  const double x = opening.x, y = opening.y, height = opening.height();
  switch (opening.shape) {
    case Shape::box:
      break;
    case Shape::upright_cylinder:
      return fmt::format("round, {} m across, {} m high", across_text(x, y), heights_text(opening));
    case Shape::cylinder_along_x:
      return lying_text(0, x, y, height);
    case Shape::cylinder_along_y:
      return lying_text(90, y, x, height);
    case Shape::ellipsoid:
      return x == y && y == height
                 ? fmt::format("sphere, {:.4g} m across", x)
                 : fmt::format("ellipsoid, {} m across, {:.4g} m high", across_text(x, y), height);
  }
  return fmt::format("{:.4g} m along azimuth 0 x {:.4g} m along 90, {} m high", x, y,
                     heights_text(opening));
}

void print_lamp(const IntensityDistribution& lamp) {
  std::cout << fmt::format("lamp: {}: {:.5g} lm\n", lamp.name(), lamp.flux());
  std::cout << fmt::format("luminous opening: {}\n", opening_text(lamp.opening()));
  for (const auto& [name, value] : report::data_rows(lamp)) {
    std::cout << fmt::format("{}: {}\n", name, value);
  }
}

/// What photile.report makes a UGR table of: intensities by angles in radians, and the opening.
nlohmann::ordered_json table_record(const IesOptions& options, const IntensityDistribution& lamp) {
  const PhotometricAxes& axes = lamp.axes();
  const LuminousOpening& opening = lamp.opening();
  const auto part = [](const glm::dvec3& direction, const glm::dvec3& axis) {
    return glm::dot(direction, axis);
  };
  std::vector<double> polar, azimuth, candela;
  for (std::size_t column = 0; column <= lamp.columns(); ++column) {
    for (std::size_t row = 0; row <= lamp.rows(); ++row) {
      // A corner of a cell, and the middle of a side of one, which has an azimuth at the pole, too.
      const std::size_t i = std::min(column, lamp.columns() - 1),
                        j = std::min(row, lamp.rows() - 1);
      const double u = column > i ? 1 : 0, v = row > j ? 1 : 0;
      const auto corner = lamp.in_cell(i, j, u, v);
      candela.push_back(corner.intensity);
      if (column == 0) {
        polar.push_back(std::acos(std::clamp(part(corner.direction, axes.pole), -1.0, 1.0)));
      }
      if (row > 0) continue;
      const glm::dvec3 aside = lamp.in_cell(i, j, u, 0.5).direction;
      azimuth.push_back(std::atan2(part(aside, axes.quarter), part(aside, axes.zero)));
      while (column > 0 && azimuth[column] <= azimuth[column - 1])
        azimuth[column] += 2 * std::numbers::pi;
    }
  }
  constexpr std::array shapes{"box", "upright cylinder", "cylinder along x", "cylinder along y",
                              "ellipsoid"};
  const auto axis = [](const glm::dvec3& v) { return std::array{v.x, v.y, v.z}; };
  return {{"spacing", options.spacing},
          {"per_thousand_lumens", options.per_thousand_lumens},
          {"flux", lamp.flux()},
          {"axes", {axis(axes.zero), axis(axes.quarter), axis(axes.pole)}},
          {"polar", polar},
          {"azimuth", azimuth},
          {"intensity", candela},
          {"opening",
           {{"x", opening.x},
            {"y", opening.y},
            {"heights", opening.heights},
            {"shape", shapes.at(static_cast<std::size_t>(opening.shape))}}}};
}

void run_ies(const IesOptions& options) {
  note_input(options.file);
  check_outputs(std::vector<std::filesystem::path>(options.outputs.begin(), options.outputs.end()));
  files::Warnings warnings;
  const IntensityDistribution lamp = loading::read_user_photometry(options.file, warnings);
  const bool luminous = lamp.opening().projected_area(glm::normalize(glm::dvec3(1, 1, -1))) > 0;
  const std::string table = options.ugr_table && luminous
                                ? write_ugr_table(table_record(options, lamp), options.outputs)
                                : std::string();
  print_lamp(lamp);
  for (const auto& line : warnings.lines()) std::cerr << "warning: " << line << '\n';
  if (options.ugr_table && !luminous) {
    throw InputError(
        fmt::format("{}: states no luminous opening, so its luminance is not known; ask the maker "
                    "for a complete file",
                    options.file));
  }
  std::cout << table;
}

}  // namespace

void add_ies_command(CLI::App& photile) {
  auto options = std::make_shared<IesOptions>();
  CLI::App* command =
      photile.add_subcommand("ies", "Print what a photometric file holds, and its UGR table");
  command->add_option("FILE", options->file, "photometric file: .ies or .ldt")
      ->required()
      ->type_name("");
  const OptionGroup group(*command);
  CLI::Option* table = group.flag("--ugr-table", options->ugr_table,
                                  "UGR in standard rooms by the tabular method (CIE 190)");
  group
      .add("--spacing", options->spacing, "X",
           "spacing of the luminaires, over their height above the eyes", number_between(0.1, 2))
      ->capture_default_str()
      ->needs(table);
  group
      .flag("--per-1000-lm", options->per_thousand_lumens,
            "uncorrected values, for a luminaire of 1000 lm")
      ->needs(table);
  group
      .repeat("-o,--output", options->outputs, "FILE", "table to write, .csv or .json; repeatable",
              file_ending_in({".csv", ".json"}))
      ->needs(table);
  command->callback([options] { run_ies(*options); });
}

}  // namespace photile::app
