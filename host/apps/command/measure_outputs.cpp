#include "command/measure_outputs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/run_record.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "photile/errors.hpp"
#include "report/honeybee_files.hpp"
#include "report/printing.hpp"
#include "report/tables.hpp"
#include "view/moods.hpp"

namespace photile::app {
namespace {

using Json = nlohmann::ordered_json;

/// As a page holds it. Errors: those of read_input_text; InputError for another kind of file.
std::string logo_of(const std::filesystem::path& file) {
  note_input(file);
  const std::string bytes = read_input_text(file);
  const bool png = bytes.starts_with("\x89PNG"), jpeg = bytes.starts_with("\xff\xd8");
  if (!png && !jpeg) {
    throw InputError(file.string() + ": a logo is a PNG or a JPEG; save it as one");
  }
  return fmt::format("data:image/{};base64,{}", png ? "png" : "jpeg", report::base64(bytes));
}

}  // namespace

void add_measure_output_options(CLI::App& command, MeasureOutputOptions& options) {
  const OptionGroup output(command, "Output");
  output.repeat(
      "-o,--output", options.outputs, "FILE",
      "table (.csv, .json), plan (.svg, .dxf) or report (.html, .pdf) to write; repeatable",
      file_ending_in({".csv", ".json", ".svg", ".dxf", ".html", ".pdf"}));
  output.add("--honeybee", options.honeybee, "FOLDER",
             "folder for <grid>.res, grids_info.json and grid_summary.csv");
  output.add("--picture", options.picture, "FILE.exr",
             "EXR of the scene; the report shows its moods as pictures and in lux",
             file_ending_in({".exr"}));
  output.repeat("--include", options.report.results, "FILE.json",
                "JSON to show in the report: glare, daylight, daylight factors, rooms; repeatable",
                file_ending_in({".json"}));
  output.add("--logo", options.logo, "FILE", "logo at the head of the report, PNG or JPEG");
  output.add("--project", options.project, "TEXT",
             "name of the project, at the head of the report");
  output.add("--client", options.client, "TEXT",
             "name of the client; the report ends with lines for signatures");
  output.add("--designer", options.designer, "TEXT",
             "name of the designer, at the head of the report");
  output
      .add("--language", options.report.language, "NAME",
           "language of the report: en, de, or one whose texts --template has")
      ->capture_default_str();
  add_template_option(output, options.report);
  options.false_colour.scale = "auto";
  add_false_colour_options(command, options.false_colour);
}

MeasureOutputs::MeasureOutputs(MeasureOutputOptions& options)
    : options_(options),
      unit_(options.daylight_factor ? "DF %" : "lux"),
      colours_(options.false_colour.of(unit_)) {
  if (options.daylight_factor) colours_.scale = 0;  // a scale for lux would show nothing
  const bool reports = has_any(options.outputs, {".html", ".pdf"});
  const auto only_in_reports = [&](const char* option, bool given) {
    if (!given || reports) return;
    throw UsageError(
        fmt::format("{} is for reports; give -o FILE.html or -o FILE.pdf, too", option));
  };
  only_in_reports("--picture", !options.picture.empty());
  only_in_reports("--include", !options.report.results.empty());
  only_in_reports("--logo", !options.logo.empty());
  only_in_reports("--project, --client and --designer",
                  !(options.project + options.client + options.designer).empty());
  if (!options.logo.empty()) logo_ = logo_of(options.logo);
  note_input(options.picture);
  std::vector<std::filesystem::path> files(options.outputs.begin(), options.outputs.end());
  if (!options.honeybee.empty()) {
    const std::filesystem::path folder = options.honeybee;
    check_honeybee();
    make_folder(folder);
    for (const char* name : report::honeybee_tables) files.push_back(folder / name);
  }
  check_outputs(files);
  check_report(options.report, options.outputs);
}

void MeasureOutputs::check_names(const std::vector<measuring::SensorGrid>& grids) const {
  if (!options_.honeybee.empty()) {
    const std::filesystem::path folder = options_.honeybee;
    for (const auto& name : report::honeybee_names(grids)) note_output(folder / name);
  }
  note_plans(options_.outputs, planes_of(grids));
}

void MeasureOutputs::check_moods(const std::filesystem::path& moods) const {
  if (options_.picture.empty() || moods.empty()) return;
  const view::Moods kept(moods);
  const LightMix mix = read_light_mix(options_.picture);
  for (const std::string& name : kept.names()) kept.changes(name, mix);
}

void MeasureOutputs::check_picture(const Scene& scene, Progress& progress) const {
  if (options_.picture.empty()) return;
  const PictureHeader header = read_header(options_.picture);
  const auto surfaces = header.attributes.find("photile.surfaces");
  if (surfaces == header.attributes.end() || surfaces->second == digest_of_surfaces(scene)) return;
  progress.warn(
      fmt::format("{} shows other surfaces or reflectances than are measured; render it again with "
                  "the options of this command",
                  options_.picture));
}

Json MeasureOutputs::record_of(const measuring::Measurement& measurement,
                               const report::MeasureRun& run,
                               const std::filesystem::path& moods) const {
  Json record = run_json(measurement, run, unit_);
  if (!options_.maintenance.empty()) record["maintenance"] = options_.maintenance;
  record["report"] = {{"project", options_.project},          {"client", options_.client},
                      {"designer", options_.designer},        {"logo", logo_},
                      {"language", options_.report.language}, {"colours", colours_json(colours_)}};
  if (!options_.picture.empty()) {
    record["report"]["pictures"] = report_pictures(options_.picture, moods, colours_);
  }
  if (!options_.report.included.empty()) record["report"]["included"] = options_.report.included;
  return record;
}

void MeasureOutputs::write(const measuring::Measurement& measurement, const report::MeasureRun& run,
                           const std::filesystem::path& moods) const {
  if (!options_.honeybee.empty()) {
    write_honeybee(options_.honeybee,
                   [&](const auto&) { return report::honeybee_record(measurement); });
  }
  std::vector<measuring::SensorGrid> grids;
  for (const auto& values : measurement) grids.push_back(values.grid);
  const Json record = any_record() ? record_of(measurement, run, moods) : Json();
  write_results(options_.outputs,
                {.csv = [&] { return report::measurement_csv(measurement, unit_, run.ground); },
                 .json = [&] { return json_text(record); },
                 .record = [&] { return record; },
                 .plans = planes_of(grids),
                 .report = options_.report});
}

}  // namespace photile::app
