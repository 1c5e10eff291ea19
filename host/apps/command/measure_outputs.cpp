#include "command/measure_outputs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/run_record.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "report/honeybee_files.hpp"
#include "report/page.hpp"
#include "report/plan_drawing.hpp"
#include "report/plan_lines.hpp"
#include "report/printing.hpp"
#include "report/report.hpp"
#include "report/tables.hpp"
#include "view/moods.hpp"

namespace photile::app {
namespace {

using Json = nlohmann::ordered_json;

Json target_json(const measuring::Measurement& measurement,
                 const measuring::Requirement& requirement) {
  Json json{{"name", requirement.name},
            {"reference", requirement.reference},
            {"ugr_limit", requirement.glare},
            {"ra", requirement.rendering},
            {"judgements", Json::array()}};
  for (const auto& values : measurement) {
    for (const auto& judgement : measuring::judge(values, requirement)) {
      json["judgements"].push_back({{"grid", judgement.grid},
                                    {"figure", judgement.figure},
                                    {"required", judgement.required},
                                    {"value", judgement.measured.value},
                                    {"standard_error", judgement.measured.standard_error},
                                    {"met", judgement.met()},
                                    {"doubtful", judgement.doubtful()}});
    }
  }
  return json;
}

Json run_json(const measuring::Measurement& measurement, const MeasureRun& run,
              const std::string& unit) {
  const MeasuringParameters& parameters = run.parameters;
  const bool planar = parameters.gathering.response == SensorResponse::planar;
  Json record{{"photile", version_number()},
              {"scene", run.scene.source.filename().string()},
              {"unit", unit},
              {"response", planar ? "planar" : "cylindrical"},
              {"maintenance_factor", parameters.maintenance},
              {"integrator", parameters.by_paths ? "path" : "photon-map"},
              {"seed", parameters.photons.seed},
              {"repeats", parameters.repeats},
              {"rays", parameters.gathering.rays}};
  if (!parameters.by_paths) {
    record["photons"] = parameters.photons.photons.emitted_photons;
    record["neighbours"] = parameters.photons.neighbours;
  }
  if (!run.mood.empty()) record["mood"] = run.mood;
  if (run.ground) record["ground_reflectance"] = *run.ground;
  for (const auto& [name, value] : run.sky) record["sky"][name] = value;
  if (!run.warnings.empty()) record["warnings"] = run.warnings;
  record["lumen_per_watt"] = run.mix.lumen_per_watt;
  for (const MixedLight& light : run.mix.lights) {
    record["lights"].push_back(
        {{"name", light.name}, {"power", light.power}, {"unit", symbol_of(light.unit)}});
  }
  if (run.requirement) record["target"] = target_json(measurement, *run.requirement);
  record["grids"] = report::measurement_json(measurement);
  return record;
}

std::vector<std::pair<std::string, std::string>> facts_of(const MeasureRun& run,
                                                          const std::string& maintenance) {
  const MeasuringParameters& parameters = run.parameters;
  const bool planar = parameters.gathering.response == SensorResponse::planar;
  std::vector<std::pair<std::string, std::string>> facts{
      {"illuminance", planar ? "planar" : "cylindrical"},
      {"maintenance factor", fmt::format("{:.3g}{}", parameters.maintenance,
                                         maintenance.empty() ? "" : " = " + maintenance)},
      {"measured",
       fmt::format("{} times with {} rays a point", parameters.repeats, parameters.gathering.rays)},
      {"light by", parameters.by_paths
                       ? "path tracing"
                       : fmt::format("photon maps, {} photons, k = {}",
                                     format_count(static_cast<double>(
                                         parameters.photons.photons.emitted_photons)),
                                     parameters.photons.neighbours)},
      {"errors", "standard errors of the mean of the repeats"},
      {"seed", std::to_string(parameters.photons.seed)}};
  if (!run.mood.empty()) facts.emplace_back("mood", run.mood);
  facts.insert(facts.end(), run.sky.begin(), run.sky.end());
  facts.emplace_back("program", "photile " + version_number());
  facts.emplace_back("date", today());
  return facts;
}

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

/// The surroundings of each grid.
std::vector<report::PlanSurroundings> surroundings_of(const measuring::Measurement& measurement,
                                                      const MeasureRun& run) {
  const RayScene rays(run.scene);
  std::vector<report::PlanSurroundings> surroundings;
  for (const auto& values : measurement) {
    const auto& layout = values.grid.layout;
    surroundings.push_back(layout ? report::surroundings_of(rays, *layout)
                                  : report::PlanSurroundings());
  }
  return surroundings;
}

}  // namespace

void add_measure_output_options(CLI::App& command, MeasureOutputOptions& options) {
  const OptionGroup output(command, "Output");
  output.repeat("-o,--output", options.outputs, "FILE",
                "table (.csv, .json), plan (.svg) or report (.html, .pdf) to write; repeatable",
                file_ending_in({".csv", ".json", ".svg", ".html", ".pdf"}));
  output.add("--honeybee", options.honeybee, "FOLDER",
             "folder for <grid>.res, grids_info.json and grid_summary.csv");
  output.add("--picture", options.picture, "FILE.exr",
             "EXR of the scene, whose moods the report shows in pictures and in lux",
             file_ending_in({".exr"}));
  output.repeat("--include", options.results, "FILE.json",
                "JSON of photile glare or daylight, which the report shows; repeatable",
                file_ending_in({".json"}));
  output.add("--logo", options.logo, "FILE", "of the designer, PNG or JPEG, for the report's head");
  output.add("--project", options.project.name, "TEXT",
             "name of the project, for the report's head");
  output.add("--client", options.project.client, "TEXT",
             "for whom the report is; it ends with lines to sign on");
  output.add("--designer", options.project.designer, "TEXT", "who answers for it");
  output
      .add("--language", options.language, "", "of the report", CLI::IsMember(report::languages()))
      ->capture_default_str();
  add_false_colour_options(command, options.false_colour);
}

MeasureOutputs::MeasureOutputs(const MeasureOutputOptions& options)
    : options_(options),
      unit_(options.daylight_factor ? "DF %" : "lux"),
      colours_(options.false_colour.of(unit_)) {
  if (options.daylight_factor) colours_.scale = 0;  // thousands of lux would show nothing
  const bool reports = any_report();
  if (options.daylight_factor && reports) {
    throw UsageError("reports are in lux; write daylight factors to .csv, .json or .svg");
  }
  const auto only_in_reports = [&](const char* option, bool given) {
    if (!given || reports) return;
    throw UsageError(
        fmt::format("{} is for reports; give -o FILE.html or -o FILE.pdf, too", option));
  };
  only_in_reports("--picture", !options.picture.empty());
  only_in_reports("--include", !options.results.empty());
  only_in_reports("--logo", !options.logo.empty());
  only_in_reports("--project, --client and --designer", options.project.said());
  if (!options.logo.empty()) logo_ = logo_of(options.logo);
  note_input(options.picture);
  for (const auto& file : options.results) note_input(file);
  std::vector<std::filesystem::path> files(options.outputs.begin(), options.outputs.end());
  if (!options.honeybee.empty()) {
    const std::filesystem::path folder = options.honeybee;
    make_folder(folder);
    for (const char* name : report::honeybee_tables) files.push_back(folder / name);
  }
  check_outputs(files);
}

void MeasureOutputs::check_names(const std::vector<measuring::SensorGrid>& grids) const {
  if (!options_.honeybee.empty()) {
    const std::filesystem::path folder = options_.honeybee;
    for (const auto& name : report::honeybee_names(grids)) note_output(folder / name);
  }
  note_plans(options_.outputs, planes_of(grids));
}

report::IncludedResults MeasureOutputs::included(
    const std::optional<measuring::Requirement>& requirement) const {
  const std::vector<std::filesystem::path> files(options_.results.begin(), options_.results.end());
  return report::included_results(files, requirement);
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
      fmt::format("{} shows other surfaces or reflectances than are measured; render it anew with "
                  "the options of this command",
                  options_.picture));
}

std::string MeasureOutputs::page_of(
    const measuring::Measurement& measurement, const MeasureRun& run,
    const std::vector<report::PlanSurroundings>& surroundings) const {
  const std::vector<report::Part> parts =
      report::parts_of(run.scene, lumens_of(run.scene, run.mix));
  report::ReportText text{
      run.scene.source.filename().string(),
      facts_of(run, options_.maintenance),
      run.requirement,
      {lamp_schedule(run.scene, run.mix), list_of_parts(parts), reflectances(run.scene)},
      run.included.glare,
      options_.project};
  text.language = options_.language;
  text.warnings = run.warnings;
  text.logo = logo_;
  text.sheets = data_sheets(parts);
  text.rendering = least_rendering(parts);
  double area = 0;
  if (const auto& room = run.room) {
    area = room->area;
    text.room = {{"floor area", fmt::format("{:.1f} m2", room->area)},
                 {"sides", fmt::format("{:.2f} x {:.2f} m", room->sides.x, room->sides.y)},
                 {"height", fmt::format("{:.2f} m", room->height)}};
  }
  text.energy = energy_of(parts, area, measurement.front().total().statistics.mean.value,
                          run.included.kilowatt_hours);
  text.tables.insert(text.tables.begin(), run.included.tables.begin(), run.included.tables.end());
  text.maps = run.included.maps;
  add_surroundings(run.scene, text.maps);
  if (!options_.picture.empty()) {
    text.pictures = report_pictures(options_.picture, run.moods, colours_);
  }
  return report::report_html(measurement, text, colours_, surroundings);
}

void MeasureOutputs::write(const measuring::Measurement& measurement, const MeasureRun& run) const {
  if (!options_.honeybee.empty()) {
    const std::filesystem::path folder = options_.honeybee;
    for (const auto& [name, text] : report::honeybee_files(measurement)) {
      write_file(folder / name, text);
    }
  }
  std::vector<report::PlanSurroundings> surroundings;
  if (any_report() || has_any(options_.outputs, {".svg"})) {
    surroundings = surroundings_of(measurement, run);
  }
  const auto plans = [&] {
    std::vector<std::string> drawn;
    for (std::size_t i = 0; i < measurement.size(); ++i) {
      if (!measurement[i].grid.layout) continue;
      drawn.push_back(report::plan_svg(measurement[i], measurement[i].total(), colours_,
                                       report::PlanSize::whole, surroundings[i]));
    }
    return drawn;
  };
  write_results(options_.outputs,
                {.csv = [&] { return report::measurement_csv(measurement, unit_, run.ground); },
                 .json = [&] { return json_text(run_json(measurement, run, unit_)); },
                 .plans = plans,
                 .page = [&] { return page_of(measurement, run, surroundings); }});
}

}  // namespace photile::app
