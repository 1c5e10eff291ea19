// Files that a command writes, checked early and written late: outputs that can be written and are
// not inputs, and how pictures are shown.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/white.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/progress.hpp"
#include "report/false_colour.hpp"

namespace photile::app {

struct RenderOptions;
class OptionGroup;

/// Notes the files that these options name to be read. What those name in turn is noted when it is
/// read. Errors: those of note_input.
void note_inputs_of(const RenderOptions& options);

/// Notes `outputs` and makes sure that they can be written, by creating and removing a temporary
/// file beside each.
/// Errors: OutputError naming the one that cannot; those of note_output.
void check_outputs(std::span<const std::filesystem::path> outputs);

/// Makes a folder for outputs, and those above it. Errors: OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace photile::app

namespace CLI {
class App;
}

namespace photile::app {

/// The value of --white.
struct WhiteOption {
  std::optional<image::White> white;  ///< none = that of the lamps

  static WhiteOption parse(const std::string& text);
  image::White of(const LayeredPicture& picture) const {
    return white ? *white : image::white_of(picture);
  }
};

/// Adds --white.
void add_white_option(const OptionGroup& group, WhiteOption& white);

/// Adds --exposure.
void add_exposure_option(const OptionGroup& group, double& exposure);

/// The options of false colour as typed, checked against the limits.
struct FalseColourOptions {
  report::FalseColour colours;  ///< without the top of the scale; no label: the unit
  std::string scale;            ///< top, or "auto"

  FalseColourOptions() : scale(fmt::format("{}", colours.scale)) { colours.label.clear(); }

  /// The false colours that they request where values are in `unit`.
  report::FalseColour of(const std::string& unit) const;
};

/// Adds --scale.
void add_scale_option(const OptionGroup& group, FalseColourOptions& options);

/// Adds all of them to a subcommand.
void add_false_colour_options(CLI::App& command, FalseColourOptions& options);

struct PictureOptions {
  std::vector<std::string> outputs;  ///< -o: .exr, .png or .hdr
  std::string illuminance;           ///< .png in false colour, "" = none
  std::string luminance;             ///< the same
  FalseColourOptions false_colour;   ///< of both
  ToneMapping tone_mapping;
  WhiteOption white;
  bool white_balance = true;
  LayerPrecision precision = LayerPrecision::whole;  ///< of EXRs
};

/// How a picture is shown: with the white that --white names, else that which is kept with it, or
/// else that of its lights, where it has any.
ToneMapping shown_as(const PictureOptions& options, const PictureHeader& picture);
ToneMapping shown_as(const PictureOptions& options, const LayeredPicture& picture);

/// The white that rendered pictures keep: what --white names, or that of the lamps as the scene has
/// them, whatever --light and --mood make of them.
image::White white_of_scene(const PictureOptions& options, const LightLayers& layers,
                            const Scene& scene, double lumen_per_watt);

/// Adds -o, --exposure, --white, --illuminance and --luminance to a subcommand.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// Files to be written, each in the format that its name ends in.
class PictureOutputs {
 public:
  explicit PictureOutputs(const PictureOptions& options) : options_(options) {}

  bool empty() const { return files().empty(); }
  std::vector<std::filesystem::path> files() const;

  /// Keeps the white with `picture` and writes every file: `picture` as EXR, its tone-mapped root
  /// as PNG, its root in Radiance's format, its illuminance and its luminance in false colour.
  /// `notes` get what a drawing lacks. Errors: OutputError; the file that it names is then as it
  /// was before. Those of `picture`, of measuring::illuminance_of and luminance_of; then nothing is
  /// written.
  ///   source   the file that the picture is from, named where it lacks something
  void write(LayeredPicture& picture, Progress& notes = Progress::none(),
             const std::filesystem::path& source = {}) const;

 private:
  PictureOptions options_;
};

}  // namespace photile::app
