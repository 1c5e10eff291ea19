#include "command/output_files.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "command/option_group.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
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
    throw OutputError(fmt::format("{}: cannot create this folder; name another", folder.string()));
  }
}

WhiteOption WhiteOption::parse(const std::string& text) {
  const auto kelvin = text.ends_with('K')
                          ? parse_number<double>(std::string_view(text).substr(0, text.size() - 1))
                          : std::nullopt;
  if (!kelvin || !(*kelvin >= limits::min_color_temperature) ||
      *kelvin > limits::max_color_temperature) {
    throw UsageError(fmt::format("--white {}: use a colour temperature from {:.0f}K to {:.0f}K",
                                 text, limits::min_color_temperature,
                                 limits::max_color_temperature));
  }
  return {image::white_of_temperature(*kelvin)};
}

void add_white_option(const OptionGroup& group, WhiteOption& white) {
  group.call(
      "--white", [&white](const std::string& text) { white = WhiteOption::parse(text); }, "KELVINK",
      "colour temperature that is shown as white; default: that of the scene's lamps");
}

void add_exposure_option(const OptionGroup& group, double& exposure) {
  group
      .add("--exposure", exposure, "STOPS", "exposure in stops, for PNGs only",
           number_between(-limits::max_exposure_stops, limits::max_exposure_stops))
      ->capture_default_str();
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

void add_scale_option(const OptionGroup& group, FalseColourOptions& options) {
  group
      .add("-s,--scale", options.scale, "X|auto",
           "top of the scale, or auto: 98% of the values lie below", top_of_scale())
      ->capture_default_str();
}

void add_false_colour_options(CLI::App& command, FalseColourOptions& options) {
  report::FalseColour& colours = options.colours;
  const OptionGroup group(command, "False colour");
  add_scale_option(group, options);
  group.add("-l,--label", colours.label, "TEXT", "text of the legend; default: the unit");
  group
      .add("-n,--steps", colours.steps, "N", "number of steps of the legend and of isolines",
           count_between(1, 100))
      ->capture_default_str();
  group.add("--log", colours.decades, "DECADES", "logarithmic scale over this number of decades",
            number_between(0.1, 30));
  group.add("--pal", colours.palette, "", "palette", CLI::IsMember(report::Palette::names()))
      ->capture_default_str();
  const auto contours = [&](const char* name, report::Contours drawn, const char* what) {
    return group.call_flag(
        name, [&colours, drawn] { colours.contours = drawn; }, what);
  };
  CLI::Option* lines = contours("--cl", report::Contours::lines, "isolines only");
  CLI::Option* bands = contours("--cb", report::Contours::bands, "only bands around the isolines");
  CLI::Option* steps =
      contours("--cp", report::Contours::steps, "posterized: one colour for each step");
  bands->excludes(lines);
  steps->excludes(lines)->excludes(bands);
}

void add_picture_options(CLI::App& command, PictureOptions& options) {
  const OptionGroup output(command, "Output");
  output.repeat("-o,--output", options.outputs, "FILE",
                "picture to write, .exr, .png or .hdr; repeatable",
                file_ending_in({".exr", ".png", ".hdr"}));
  add_exposure_option(output, options.tone_mapping.exposure);
  add_white_option(output, options.white);
  output.add("--illuminance", options.illuminance, "FILE.png",
             "illuminance on the visible surfaces, lux, in false colour with a legend",
             file_ending_in({".png"}));
  output.add("--luminance", options.luminance, "FILE.png",
             "luminance, cd/m2, in false colour with a legend", file_ending_in({".png"}));
}

ToneMapping shown_as(const PictureOptions& options, const PictureHeader& picture) {
  ToneMapping shown = options.tone_mapping;
  const std::optional<image::White> white =
      options.white.white ? options.white.white : image::kept_white(picture);
  if (options.white_balance && white) shown.white = *white;
  return shown;
}

ToneMapping shown_as(const PictureOptions& options, const LayeredPicture& picture) {
  ToneMapping shown = options.tone_mapping;
  if (options.white_balance) shown.white = options.white.of(picture);
  return shown;
}

image::White white_of_scene(const PictureOptions& options, const LightLayers& layers,
                            const Scene& scene, double lumen_per_watt) {
  if (options.white.white) return *options.white.white;
  return image::white_of(layers, LightMix::of(scene, lumen_per_watt));
}

std::vector<std::filesystem::path> PictureOutputs::files() const {
  std::vector<std::filesystem::path> all(options_.outputs.begin(), options_.outputs.end());
  for (const std::string& drawing : {options_.illuminance, options_.luminance}) {
    if (!drawing.empty()) all.emplace_back(drawing);
  }
  return all;
}

void PictureOutputs::write(LayeredPicture& picture, Progress& notes,
                           const std::filesystem::path& source) const {
  about_file(source, [&] { image::keep_white(picture.header(), options_.white.of(picture)); });
  // First, because the picture may lack them.
  std::vector<float> lux, candela;
  Image root, displayed;
  const auto all = files();
  if (!std::all_of(all.begin(), all.end(),
                   [](const auto& file) { return ends_in(file.string(), ".exr"); })) {
    root = picture.root();
    const ToneMapping shown = shown_as(options_, picture);
    if (shown.white != ToneMapping{}.white) {
      notes.note(fmt::format("white balance: linear RGB {:.3f}, {:.3f}, {:.3f} is shown as white",
                             shown.white[0], shown.white[1], shown.white[2]));
    }
    displayed = tone_map(root, shown);
  }
  about_file(source, [&] {
    if (!options_.illuminance.empty()) lux = report::illuminance_of(picture);
    if (!options_.luminance.empty()) candela = report::luminance_of(root);
  });

  for (const std::string& file : options_.outputs) {
    if (ends_in(file, ".exr")) write_exr(file, picture, options_.precision);
    if (ends_in(file, ".png")) write_png(file, displayed);
    if (ends_in(file, ".hdr")) write_hdr(file, root);
  }
  const auto draw = [&](const std::string& file, const std::vector<float>& values,
                        const char* unit) {
    if (file.empty()) return;
    write_png(file,
              report::false_colour_picture(values, displayed, options_.false_colour.of(unit)));
    if (report::Sheet::has_font()) return;
    notes.warn(
        fmt::format("{}: the legend has no numbers without the font DejaVu Sans; "
                    "install fonts-dejavu-core",
                    file));
  };
  draw(options_.illuminance, lux, "lux");
  draw(options_.luminance, candela, "cd/m2");
  for (const std::string& line : picture.overflows()) notes.warn(line);
}

}  // namespace photile::app
