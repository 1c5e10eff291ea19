#include "command/picture_outputs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "command/tone_mapping_options.hpp"
#include "command/validators.hpp"
#include "common/ascii_text.hpp"
#include "common/input_file.hpp"
#include "photile/errors.hpp"
#include "report/false_colour_picture.hpp"
#include "report/sheet.hpp"

namespace photile::app {
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

PictureOutputs::PictureOutputs(const PictureOptions& options)
    : illuminance_(options.illuminance),
      luminance_(options.luminance),
      tone_mapping_(options.tone_mapping),
      false_colour_(options.false_colour) {
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
    displayed = tone_map(root, tone_mapping_);
  }
  about_file(source, [&] {
    if (!illuminance_.empty()) lux = report::illuminance_of(picture);
    if (!luminance_.empty()) candela = report::luminance_of(root);
  });

  for (const auto& file : exr_) write_exr(file, picture);
  for (const auto& file : png_) write_png(file, displayed);
  for (const auto& file : hdr_) write_hdr(file, root);
  const auto draw = [&](const std::filesystem::path& file, const std::vector<float>& values,
                        const char* unit) {
    if (file.empty()) return;
    write_png(file, report::false_colour_picture(values, displayed, false_colour_.of(unit)));
    if (report::Sheet::has_font()) return;
    notes.note(
        fmt::format("warning: {}: the legend has no numbers without the font DejaVu Sans; "
                    "install fonts-dejavu-core",
                    file.string()));
  };
  draw(illuminance_, lux, "lux");
  draw(luminance_, candela, "cd/m2");
  for (const std::string& line : picture.overflows()) notes.note("warning: " + line);
}

}  // namespace photile::app
