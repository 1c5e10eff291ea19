#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/report_contents.hpp"
#include "command/scene_report.hpp"
#include "command/sensor_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "glare/measure_glare.hpp"
#include "loading/load_scene.hpp"
#include "loading/surroundings.hpp"
#include "measuring/requirements.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "report/tables.hpp"

namespace photile::app {
namespace {

using Json = nlohmann::ordered_json;

struct GlareOptions {
  RenderOptions render;
  glare::GlareParameters parameters;
  std::vector<std::string> outputs;  ///< .csv, .json
  ObserverOptions observers;
  std::vector<std::string> cameras;  ///< names or indices
  PlaceOptions places;
  std::vector<std::string> ratings;  ///< empty = all of observers, UGR alone of a grid
  std::string pictures;              ///< folder, "" = none
  std::string target;                ///< "" = none
};

///   plane   is set to that of the observers of --grid
std::vector<glare::Observer> observers_of(const GlareOptions& options, const Scene& scene,
                                          std::optional<measuring::PlaneLayout>& plane,
                                          Progress& progress) {
  std::vector<glare::Observer> all =
      observers_at(options.observers, options.places, scene, plane, progress);
  for (const auto& name : options.cameras) {
    const Camera& placed = choose_camera(scene, name);
    const Camera camera = in_world(scene, placed);
    if (!trace::Room::around(RayScene(scene), {}, placed.position)) {
      progress.warn(
          fmt::format("camera '{}' is not in a room with a ceiling; give the eyes of people who "
                      "sit or stand by --observers FILE",
                      camera.name));
    }
    all.push_back(
        glare::Observer::looking(camera.name, camera.position, camera.forward, camera.up));
  }
  return all;
}

/// The highest UGR beside the required one; none where nothing is required.
std::optional<measuring::Judgement> judged(const GlareOptions& options,
                                           std::span<const glare::ObserverGlare> all) {
  if (options.target.empty()) return std::nullopt;
  const double limit = measuring::parse_requirement(options.target).glare;
  const glare::ObserverGlare* highest = nullptr;
  for (const auto& each : all) {
    if (each.ugr && (!highest || each.ugr->value > highest->ugr->value)) highest = &each;
  }
  if (!(limit > 0) || !highest) return std::nullopt;
  return measuring::Judgement{highest->observer.name, "UGR", limit, *highest->ugr, true};
}

Json run_json(const GlareOptions& options, const Scene& scene, const LightMix& mix,
              const std::optional<measuring::PlaneLayout>& plane,
              std::span<const glare::ObserverGlare> all) {
  const MeasuringParameters& measuring = options.parameters.measuring;
  Json record{{"photile", version_number()},
              {"scene", scene.source.filename().string()},
              {"integrator", name_of(options.render.integrator)},
              {"seed", measuring.photons.seed},
              {"repeats", measuring.repeats},
              {"rays", measuring.gathering.rays},
              {"picture_side", options.parameters.picture_side},
              {"source_threshold", options.parameters.search.threshold},
              {"lumen_per_watt", mix.lumen_per_watt}};
  if (const auto ground = loading::ground_reflectance(options.render.load)) {
    record["ground_reflectance"] = *ground;
  }
  if (options.render.mood.asked()) record["mood"] = options.render.mood.mood;
  if (const auto judgement = judged(options, all)) {
    record["target"] = {{"name", options.target},
                        {"ugr_limit", judgement->required},
                        {"highest_ugr", judgement->measured.value},
                        {"met", judgement->met()}};
  }
  record.update(report::glare_record(scene, all, plane));
  return record;
}

std::filesystem::path picture_name(const GlareOptions& options, std::size_t observer) {
  return std::filesystem::path(options.pictures) / fmt::format("view-{:04}.hdr", observer + 1);
}

/// Whether daylight ratings are asked for.
bool wants_pictures(const GlareOptions& options) {
  if (!options.pictures.empty()) return true;
  if (options.ratings.empty()) return !options.observers.files.empty() || !options.cameras.empty();
  return std::any_of(options.ratings.begin(), options.ratings.end(),
                     [](const std::string& rating) { return rating != "ugr"; });
}

void check_outputs_of(const GlareOptions& options) {
  if (!options.pictures.empty()) make_folder(options.pictures);
  check_outputs(std::vector<std::filesystem::path>(options.outputs.begin(), options.outputs.end()));
}

void run_glare(const CLI::App& command, GlareOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check(render.parameters);
  if (render.integrator == Integrator::path) refuse_photon_map_options(command);
  if (!options.target.empty()) measuring::parse_requirement(options.target);
  if (options.observers.empty() && options.cameras.empty()) {
    throw UsageError("no observer; give --observers FILE, --grid or --camera NAME");
  }
  note_inputs_of(render);
  for (const auto& file : options.observers.files) note_input(file);
  check_outputs_of(options);

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix = mix_of(scene, render);
  tell_scene(scene, mix, render.load, progress);
  std::optional<measuring::PlaneLayout> plane;
  find_rooms(options.places, scene);
  const std::vector<glare::Observer> observers = observers_of(options, scene, plane, progress);
  std::vector<Device> devices = devices_for(render, progress);

  glare::GlareParameters& parameters = options.parameters;
  parameters.measuring.photons = render.parameters;
  parameters.measuring.by_paths = render.integrator == Integrator::path;
  parameters.by_pictures = wants_pictures(options);
  glare::KeepPicture keep;
  if (!options.pictures.empty()) {
    for (std::size_t i = 0; i < observers.size(); ++i) note_output(picture_name(options, i));
    keep = [&](std::size_t i, const Camera& camera, const LightLayers& layers) {
      const auto picture = mixed_picture(layers, mix);
      Image root = picture->root();
      set_camera_attributes(root, in_world(scene, camera), layers.width, layers.height);
      write_hdr(picture_name(options, i), root);
    };
  }
  const auto all = glare::measure_glare(
      scene, observers, mix,
      glare::coverage_by_luminaires(scene, observers.front(), parameters.samples), devices,
      parameters, keep, progress);
  std::vector<bool> reaches(all.front().reached_by.size(), false);
  for (const glare::ObserverGlare& each : all) {
    for (std::size_t i = 0; i < reaches.size(); ++i) reaches[i] = reaches[i] || each.reached_by[i];
  }
  warn_of_dark_lights(scene, mix, reaches, "observer", progress);
  write_results(
      options.outputs,
      {.csv = [&] { return report::glare_csv(all, loading::ground_reflectance(render.load)); },
       .json = [&] { return json_text(run_json(options, scene, mix, plane, all)); }});
  for (const auto& line : report::glare_lines(all)) std::cout << line << '\n';
  for (const auto& line : sky_lines(render.load)) std::cout << line << '\n';
  if (const auto judgement = judged(options, all)) {
    std::cout << fmt::format("target {}: {}\n", options.target,
                             measuring::judgement_text(*judgement));
  }
}

void add_places(CLI::App& command, GlareOptions& options) {
  const OptionGroup places(command, "Places");
  add_observers_option(places, options.observers);
  places.repeat("--camera", options.cameras, "NAME|INDEX",
                "name or index of a camera that is an observer; repeatable");
  const std::string height = fmt::format("floor+{:g}", defaults::eye_height);
  CLI::Option* grid =
      places
          .add("--grid", options.observers.height, "[HEIGHT]",
               "observers over the floor, on the grid of EN 12464-1; default: " + height)
          ->expected(0, 1)
          ->default_str(height);
  places
      .add("--directions", options.observers.directions, "N",
           "directions of view at each point of the grid", count_between(1, 360))
      ->capture_default_str()
      ->needs(grid);
  add_plane_options(places, options.places);
}

void add_rating(CLI::App& command, GlareOptions& options) {
  glare::GlareParameters& parameters = options.parameters;
  const OptionGroup group(command, "Glare");
  group
      .add("--ratings", options.ratings, "LIST",
           "ratings, separated by commas: ugr, dgp, dgi; default: all, with --grid ugr; dgp and "
           "dgi render a picture of each view",
           CLI::IsMember({"ugr", "dgp", "dgi"}))
      ->delimiter(',');
  group.add("--target", options.target, "NAME|VALUES",
            "largest UGR that a standard allows, by name (office-desk) or value (UGR=19)");
  group
      .add("--source-luminance", parameters.search.threshold, "X",
           "threshold of glare sources in pictures: above 100 in cd/m2, otherwise times the mean "
           "luminance",
           positive_number())
      ->capture_default_str();
  group
      .add("--picture-size", parameters.picture_side, "N", "pixels across a fisheye picture",
           count_between(16, limits::max_image_side))
      ->capture_default_str();
  add_sensor_options(group, parameters.measuring);
}

}  // namespace

void add_glare_command(CLI::App& photile) {
  auto options = std::make_shared<GlareOptions>();
  CLI::App* command = photile.add_subcommand("glare", "Rate discomfort glare by UGR, DGP and DGI");
  const OptionGroup output(*command, "Output");
  output.repeat("-o,--output", options->outputs, "FILE",
                "table to write, .csv or .json; repeatable", file_ending_in({".csv", ".json"}));
  output.add("--pictures", options->pictures, "FOLDER",
             "folder for the fisheye pictures of all views, as evalglare reads them");
  add_places(*command, *options);
  add_rating(*command, *options);
  add_setting_options(*command, options->render, {"direct_rays", "gloss"});
  add_integrator_option(*command, options->render);
  command->callback([command, options] { run_glare(*command, *options); });
}

}  // namespace photile::app
