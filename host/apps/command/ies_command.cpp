#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/report_contents.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "files/scene_files.hpp"
#include "glare/ugr_table.hpp"
#include "loading/light_changes.hpp"
#include "photile/errors.hpp"
#include "report/luminaires.hpp"
#include "report/tables.hpp"

namespace photile::app {
namespace {

struct IesOptions {
  std::string file;
  bool ugr_table = false;
  double spacing = defaults::ugr_table_spacing;
  bool per_thousand_lumens = false;
  std::vector<std::string> outputs;  ///< .csv, .json
};

void print_lamp(const IntensityDistribution& lamp) {
  const LuminousOpening& opening = lamp.opening();
  std::cout << fmt::format("lamp: {}: {:.5g} lm\n", lamp.name(), lamp.flux());
  if (opening.round) {
    const std::string across =
        opening.along_zero == opening.along_quarter
            ? fmt::format("{:.4g}", opening.along_zero)
            : fmt::format("{:.4g} x {:.4g}", opening.along_zero, opening.along_quarter);
    std::cout << fmt::format("luminous opening: round, {} m across, {:.4g} m high\n", across,
                             opening.height);
  } else {
    std::cout << fmt::format(
        "luminous opening: {:.4g} m along azimuth 0 x {:.4g} m along 90, {:.4g} m high\n",
        opening.along_zero, opening.along_quarter, opening.height);
  }
  for (const auto& [name, value] : report::data_rows(lamp)) {
    std::cout << fmt::format("{}: {}\n", name, value);
  }
}

/// The ratings of a lamp of 1000 lm with the same distribution.
void scale_to_thousand_lumens(double flux, glare::UgrTable& table) {
  const double change = 8 * std::log10(flux / 1000);
  for (auto* rows : {&table.crosswise, &table.endwise}) {
    for (auto& row : *rows) {
      for (double& value : row) value -= change;
    }
  }
}

void run_ies(const IesOptions& options) {
  note_input(options.file);
  check_outputs(std::vector<std::filesystem::path>(options.outputs.begin(), options.outputs.end()));
  files::Warnings warnings;
  const IntensityDistribution lamp = loading::read_user_photometry(options.file, warnings);
  print_lamp(lamp);
  for (const auto& line : warnings.lines()) std::cerr << "warning: " << line << '\n';
  if (!options.ugr_table) return;
  if (!(lamp.opening().along_zero > 0)) {
    throw InputError(fmt::format(
        "{}: states no luminous opening, so no luminance is known; get it again from the maker",
        options.file));
  }
  glare::UgrTable table = glare::ugr_table(lamp, options.spacing);
  if (options.per_thousand_lumens) scale_to_thousand_lumens(lamp.flux(), table);
  write_results(options.outputs,
                {.csv = [&] { return report::ugr_table_csv(table); },
                 .json = [&] { return json_text(report::ugr_table_json(table)); }});
  for (const auto& line : report::ugr_table_lines(table)) std::cout << line << '\n';
}

}  // namespace

void add_ies_command(CLI::App& photile) {
  auto options = std::make_shared<IesOptions>();
  CLI::App* command =
      photile.add_subcommand("ies", "Say what a photometric file holds, and its UGR table");
  command->add_option("FILE", options->file, "photometric file: .ies or .ldt")
      ->required()
      ->type_name("");
  const OptionGroup group(*command);
  CLI::Option* table = group.flag("--ugr-table", options->ugr_table,
                                  "glare in standard rooms by the tabular method (CIE 190)");
  group
      .add("--spacing", options->spacing, "X",
           "of the luminaires, over their height above the eyes", number_between(0.1, 2))
      ->capture_default_str()
      ->needs(table);
  group
      .flag("--per-1000-lm", options->per_thousand_lumens,
            "uncorrected values: of a luminaire of 1000 lm")
      ->needs(table);
  group
      .repeat("-o,--output", options->outputs, "FILE", "table to write, .csv or .json; repeatable",
              file_ending_in({".csv", ".json"}))
      ->needs(table);
  command->callback([options] { run_ies(*options); });
}

}  // namespace photile::app
