#include "command/output_files.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/validators.hpp"
#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "image/layer_set.hpp"
#include "image/light_layers.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "report/false_colour.hpp"
#include "report/sheet.hpp"

namespace photile::app {

void note_inputs_of(const RenderOptions& options) {
  note_input(options.scene);
  for (const LightProfile& profile : options.load.profiles) note_input(profile.file);
  note_input(options.load.environment.file);
  note_input(options.load.situation.weather);
  note_input(options.load.luminaires);
  note_input(options.load_maps);
  if (ends_in(options.camera, ".vf")) note_input(options.camera);
}

void check_outputs(std::span<const std::filesystem::path> outputs) {
  for (const auto& output : outputs) {
    note_output(output);
    if (!leads()) continue;
    const OutputFile probe(output);
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw OutputError(fmt::format("{}: cannot make this folder; name another", folder.string()));
  }
}

void add_view_option(CLI::App& command, DisplayView& view, const std::string& group) {
  Words names;
  for (const DisplayView one : all_display_views) names.words.push_back(name_of(one));
  const auto set = [&view](const std::string& name) {
    for (const DisplayView one : all_display_views) {
      if (name_of(one) == name) view = one;
    }
  };
  command
      .add_option_function<std::string>("--view", set,
                                        "display transform: Khronos PBR Neutral, in which "
                                        "highlights roll off, or the sRGB curve alone")
      ->type_name("neutral|standard")
      ->transform(within(names))
      ->default_str(std::string(name_of(view)))
      ->group(group);
}

void add_tone_mapping_options(CLI::App& command, ToneMapping& parameters,
                              const std::string& group) {
  command.add_option("--exposure", parameters.exposure, "stops, for PNGs and the window alone")
      ->type_name("STOPS")
      ->transform(number_between(-limits::max_exposure_stops, limits::max_exposure_stops))
      ->capture_default_str()
      ->group(group);
  add_view_option(command, parameters.view, group);
}

namespace {

CLI::Validator top_of_scale() {
  const auto check = [](std::string& text) -> std::string {
    if (text == "auto" || parse_value(text, PositiveNumbers{})) return {};
    return fmt::format("'{}' is neither auto nor a number greater than 0", text);
  };
  return {check, ""};
}

}  // namespace

report::FalseColour FalseColourOptions::of(const std::string& unit) const {
  report::FalseColour result = colours;
  if (result.label.empty()) result.label = unit;
  result.scale = scale == "auto" ? 0 : std::stod(scale);
  return result;
}

void add_scale_option(CLI::App& command, FalseColourOptions& options, const std::string& group) {
  command
      .add_option("-s,--scale", options.scale,
                  "top of the scale, or auto: 98% of the values lie below")
      ->type_name("X|auto")
      ->check(top_of_scale())
      ->capture_default_str()
      ->group(group);
}

void add_false_colour_options(CLI::App& command, FalseColourOptions& options) {
  report::FalseColour& colours = options.colours;
  const char* group = "False colour";
  add_scale_option(command, options, group);
  command.add_option("-l,--label", colours.label, "text of the legend; default: the unit")
      ->type_name("TEXT")
      ->group(group);
  command.add_option("-n,--steps", colours.steps, "steps of the legend and isolines")
      ->type_name("N")
      ->transform(count_between(1, 100))
      ->capture_default_str()
      ->group(group);
  command.add_option("--log", colours.decades, "logarithmic scale over so many decades")
      ->type_name("DECADES")
      ->transform(number_between(0.1, 30))
      ->group(group);
  command.add_option("--pal", colours.palette, "palette")
      ->type_name("")
      ->check(CLI::IsMember(report::Palette::names()))
      ->capture_default_str()
      ->group(group);
  const auto contours = [&](const char* name, report::Contours drawn, const char* what) {
    return command
        .add_flag_callback(
            name, [&colours, drawn] { colours.contours = drawn; }, what)
        ->group(group);
  };
  CLI::Option* lines = contours("--cl", report::Contours::lines, "isolines alone");
  CLI::Option* bands = contours("--cb", report::Contours::bands, "bands around the isolines alone");
  CLI::Option* steps =
      contours("--cp", report::Contours::steps, "posterized: one colour for each step");
  bands->excludes(lines);
  steps->excludes(lines)->excludes(bands);
}

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command
      .add_option("-o,--output", options.outputs,
                  "picture to write, .exr, .png or .hdr; repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
  add_tone_mapping_options(command, options.tone_mapping, "Output");
  const auto add_drawing = [&](const char* name, std::string& file, const char* what) {
    command.add_option(name, file, what)
        ->type_name("FILE.png")
        ->check(file_ending_in({".png"}))
        ->group("Output");
  };
  add_drawing("--illuminance", options.illuminance,
              "lux on the surfaces that are seen, in false colour with a legend");
  add_drawing("--luminance", options.luminance, "cd/m2, in false colour with a legend");
}

ToneMapping shown_as(const PictureOptions& options, const LayeredPicture& picture) {
  ToneMapping shown = options.tone_mapping;
  if (!options.white_balance) return shown;
  std::vector<double> sums;
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    const LightRows rows = picture.read(light, 0, picture.header().height);
    double sum = 0;
    const auto add = [&](double lux) {
      if (std::isfinite(lux) && lux > 0) sum += lux;
    };
    for (const float lux : rows.illuminance) add(static_cast<double>(lux));
    for (std::size_t i = 0; rows.illuminance.empty() && i < rows.rgb[0].size(); ++i) {
      add(luminance(glm::dvec3(rows.rgb[0][i], rows.rgb[1][i], rows.rgb[2][i])));
    }
    sums.push_back(sum);
  }
  shown.white = image::white_of_light(sums, image::read_light_records(picture.header()).mix);
  return shown;
}

PictureOutputs::PictureOutputs(const PictureOptions& options)
    : illuminance_(options.illuminance), luminance_(options.luminance), options_(options) {
  for (const std::string& file : options.outputs) {
    const bool exr = ends_in(file, ".exr"), hdr = ends_in(file, ".hdr");
    if (!exr && !hdr && !ends_in(file, ".png")) {
      throw UsageError(fmt::format("{}: an output ends in .exr, .png or .hdr; rename it", file));
    }
    (exr ? exr_ : hdr ? hdr_ : png_).emplace_back(file);
  }
}

std::vector<std::filesystem::path> PictureOutputs::files() const {
  std::vector<std::filesystem::path> all = exr_;
  all.insert(all.end(), png_.begin(), png_.end());
  all.insert(all.end(), hdr_.begin(), hdr_.end());
  if (!illuminance_.empty()) all.push_back(illuminance_);
  if (!luminance_.empty()) all.push_back(luminance_);
  return all;
}

void PictureOutputs::write(const LayeredPicture& picture, Progress& notes,
                           const std::filesystem::path& source) const {
  // First, for the picture may lack them.
  std::vector<float> lux, candela;
  Image root, displayed;
  if (exr_.size() < files().size()) {
    root = picture.root();
    const ToneMapping shown = shown_as(options_, picture);
    if (shown.white != ToneMapping{}.white) {
      notes.note(fmt::format("white balance: light of {:.3f}, {:.3f}, {:.3f} (R, G, B) is white",
                             shown.white[0], shown.white[1], shown.white[2]));
    }
    displayed = tone_map(root, shown);
  }
  about_file(source, [&] {
    if (!illuminance_.empty()) lux = report::illuminance_of(picture);
    if (!luminance_.empty()) candela = report::luminance_of(root);
  });

  for (const auto& file : exr_) write_exr(file, picture, options_.precision);
  for (const auto& file : png_) write_png(file, displayed);
  for (const auto& file : hdr_) write_hdr(file, root);
  const auto draw = [&](const std::filesystem::path& file, const std::vector<float>& values,
                        const char* unit) {
    if (file.empty()) return;
    write_png(file,
              report::false_colour_picture(values, displayed, options_.false_colour.of(unit)));
    if (report::Sheet::has_font()) return;
    notes.warn(
        fmt::format("{}: the legend has no numbers without the font DejaVu Sans; "
                    "install fonts-dejavu-core",
                    file.string()));
  };
  draw(illuminance_, lux, "lux");
  draw(luminance_, candela, "cd/m2");
  for (const std::string& line : picture.overflows()) notes.warn(line);
}

}  // namespace photile::app
