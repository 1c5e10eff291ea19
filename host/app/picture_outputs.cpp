#include "app/picture_outputs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "app/validators.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::app {
namespace {

std::string lower_case_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command.add_option("-o,--output", options.outputs, "picture to write, .exr or .png; repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
  command.add_option("--png", options.png, "tone-mapped picture to write")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
  command.add_option("--exposure", options.exposure, "stops, for PNG only")
      ->type_name("STOPS")
      ->transform(number_between(-limits::max_exposure_stops, limits::max_exposure_stops))
      ->capture_default_str()
      ->group("Output");
  command
      .add_flag("--no-auto-exposure", options.no_automatic_exposure,
                "1 cd/m2 or 1 W/(m2 sr) becomes white, before --exposure")
      ->group("Output");
}

PictureOutputs::PictureOutputs(const PictureOptions& options)
    : tone_mapping_{!options.no_automatic_exposure, options.exposure} {
  for (const std::string& file : options.outputs) {
    const std::string extension = lower_case_extension(file);
    if (extension != ".exr" && extension != ".png") {
      throw UsageError(fmt::format("{}: an output ends in .exr or .png; rename it", file));
    }
    (extension == ".exr" ? exr_ : png_).emplace_back(file);
  }
  for (const std::string& file : options.png) {
    if (lower_case_extension(file) != ".png") {
      throw UsageError(fmt::format("{}: --png writes a file that ends in .png; rename it", file));
    }
    png_.emplace_back(file);
  }
}

std::vector<std::filesystem::path> PictureOutputs::files() const {
  std::vector<std::filesystem::path> all = exr_;
  all.insert(all.end(), png_.begin(), png_.end());
  return all;
}

void PictureOutputs::write(const LayeredPicture& picture) const {
  for (const auto& file : exr_) write_exr(file, picture);
  if (png_.empty()) return;
  const Image displayed = tone_map(picture.root(), tone_mapping_);
  for (const auto& file : png_) write_png(file, displayed);
}

}  // namespace photile::app
