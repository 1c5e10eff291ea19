#include "command/measure_outputs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "command/command_line.hpp"
#include "command/output_files.hpp"
#include "command/report_contents.hpp"
#include "command/run_record.hpp"
#include "command/terminal_progress.hpp"
#include "command/validators.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "report/honeybee_files.hpp"
#include "report/plan_drawing.hpp"
#include "report/plan_lines.hpp"
#include "report/printing.hpp"
#include "report/report.hpp"
#include "report/tables.hpp"
#include "report/words.hpp"
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
  record["lumen_per_watt"] = run.mix.lumen_per_watt;
  for (const MixedLight& light : run.mix.lights) {
    record["lights"].push_back(
        {{"name", light.name}, {"power", light.power}, {"unit", unit_symbol(light.unit)}});
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
  command
      .add_option("-o,--output", options.outputs,
                  "table (.csv, .json), plan (.svg) or report (.html, .pdf) to write; repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
  command
      .add_option("--honeybee", options.honeybee,
                  "folder for <grid>.res, grids_info.json and grid_summary.csv")
      ->type_name("FOLDER")
      ->group("Output");
  command
      .add_option("--picture", options.picture,
                  "EXR of the scene, whose moods the report shows in pictures and in lux")
      ->type_name("FILE.exr")
      ->check(file_ending_in({".exr"}))
      ->group("Output");
  command
      .add_option("--include", options.results,
                  "JSON of photile glare or daylight, which the report shows; repeatable")
      ->type_name("FILE.json")
      ->allow_extra_args(false)
      ->check(file_ending_in({".json"}))
      ->group("Output");
  const auto text = [&](const char* name, std::string& value, const char* what) {
    command.add_option(name, value, what)->type_name("TEXT")->group("Output");
  };
  command.add_option("--logo", options.logo, "of the designer, PNG or JPEG, for the report's head")
      ->type_name("FILE")
      ->group("Output");
  text("--project", options.project.name, "name of the project, for the report's head");
  text("--client", options.project.client, "for whom the report is; it ends with lines to sign on");
  text("--designer", options.project.designer, "who answers for it");
  command.add_option("--language", options.language, "of the report")
      ->type_name("")
      ->check(CLI::IsMember(report::languages()))
      ->capture_default_str()
      ->group("Output");
  add_false_colour_options(command, options.false_colour);
}

MeasureOutputs::MeasureOutputs(const MeasureOutputOptions& options)
    : unit_(options.daylight_factor ? "DF %" : "lux"),
      colours_(options.false_colour.of(unit_)),
      honeybee_(options.honeybee),
      picture_(options.picture),
      maintenance_(options.maintenance),
      results_(options.results.begin(), options.results.end()),
      project_(options.project),
      language_(options.language) {
  if (options.daylight_factor) colours_.scale = 0;  // thousands of lux would show nothing
  const std::map<std::string, std::vector<std::filesystem::path>*> lists{
      {".csv", &csv_}, {".json", &json_}, {".svg", &svg_}, {".html", &html_}, {".pdf", &pdf_}};
  std::vector<std::filesystem::path> all;
  for (const std::filesystem::path file : options.outputs) {
    const auto list = lists.find(file.extension().string());
    if (list == lists.end()) {
      throw UsageError(fmt::format(
          "{}: an output ends in .csv, .json, .svg, .html or .pdf; rename it", file.string()));
    }
    if (options.daylight_factor && (list->first == ".html" || list->first == ".pdf")) {
      throw UsageError(
          fmt::format("{}: reports are in lux; write daylight factors to .csv, .json "
                      "or .svg",
                      file.string()));
    }
    list->second->push_back(file);
    all.push_back(file);
  }
  if (!honeybee_.empty()) {
    make_folder(honeybee_);
    for (const char* name : report::honeybee_tables) all.push_back(honeybee_ / name);
  }
  const bool reports = any_report();
  const auto only_in_reports = [&](const char* option, bool given) {
    if (!given || reports) return;
    throw UsageError(
        fmt::format("{} is for reports; give -o FILE.html or -o FILE.pdf, too", option));
  };
  only_in_reports("--picture", !picture_.empty());
  only_in_reports("--include", !results_.empty());
  only_in_reports("--logo", !options.logo.empty());
  if (!options.logo.empty()) logo_ = logo_of(options.logo);
  only_in_reports("--project, --client and --designer", project_.said());
  if (!picture_.empty()) note_input(picture_);
  for (const auto& file : results_) note_input(file);
  check_outputs(all);
}

void MeasureOutputs::check_names(const std::vector<measuring::SensorGrid>& grids) const {
  if (!honeybee_.empty()) {
    for (const auto& name : report::honeybee_names(grids)) note_output(honeybee_ / name);
  }
  const auto planes = static_cast<std::size_t>(std::count_if(
      grids.begin(), grids.end(), [](const auto& grid) { return grid.layout.has_value(); }));
  for (const auto& file : svg_) note_plans(file, planes);
}

void MeasureOutputs::check_moods(const std::filesystem::path& moods) const {
  if (picture_.empty() || moods.empty()) return;
  const view::Moods kept(moods);
  const LightMix mix = read_light_mix(picture_);
  for (const std::string& name : kept.names()) kept.changes(name, mix);
}

void MeasureOutputs::check_picture(const Scene& scene, Progress& progress) const {
  if (picture_.empty()) return;
  const PictureHeader header = read_header(picture_);
  const auto surfaces = header.attributes.find("photile.surfaces");
  if (surfaces == header.attributes.end() || surfaces->second == digest_of_surfaces(scene)) return;
  progress.warn(fmt::format(
      "{} shows other surfaces or reflectances than are measured; render it anew with the "
      "options of this command",
      picture_.string()));
}

void MeasureOutputs::write(const measuring::Measurement& measurement, const MeasureRun& run) const {
  if (!honeybee_.empty()) {
    for (const auto& [name, text] : report::honeybee_files(measurement)) {
      write_file(honeybee_ / name, text);
    }
  }
  for (const auto& file : csv_) write_file(file, report::measurement_csv(measurement, unit_));
  for (const auto& file : json_) {
    write_file(file, json_text(run_json(measurement, run, unit_)));
  }
  std::vector<const measuring::GridValues*> planes;
  for (const auto& values : measurement) {
    if (values.grid.layout) planes.push_back(&values);
  }
  if (svg_.empty() && html_.empty() && pdf_.empty()) return;
  const std::vector<report::PlanSurroundings> surroundings = surroundings_of(measurement, run);
  for (const auto& file : svg_) {
    const auto names = plan_names(file, planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const auto grid = static_cast<std::size_t>(planes[i] - measurement.data());
      write_file(names[i], report::plan_svg(*planes[i], planes[i]->total(), colours_,
                                            report::PlanSize::whole, surroundings[grid]));
    }
  }
  if (!any_report()) return;
  const std::vector<report::Part> parts =
      report::parts_of(run.scene, lumens_of(run.scene, run.mix));
  report::ReportText text{
      run.scene.source.filename().string(),
      facts_of(run, maintenance_),
      run.requirement,
      {lamp_schedule(run.scene, run.mix), list_of_parts(parts), reflectances(run.scene)},
      run.included.glare,
      project_};
  text.language = language_;
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
  if (!picture_.empty()) text.pictures = report_pictures(picture_, run.moods, colours_);
  const std::string page = report::report_html(measurement, text, colours_, surroundings);
  for (const auto& file : html_) write_file(file, page);
  for (const auto& file : pdf_) write_file(file, report::pdf_of(page));
}

}  // namespace photile::app
