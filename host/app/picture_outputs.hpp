// The pictures that a command writes: which files, checked early, written late.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"

namespace CLI {
class App;
}

namespace photile::app {

struct PictureOptions {
  std::vector<std::string> outputs;  ///< -o: .exr or .png
  std::vector<std::string> png;      ///< --png
  double exposure = ToneMapping{}.exposure;
  bool no_automatic_exposure = false;
};

/// Adds -o, --png, --exposure and --no-auto-exposure to a subcommand.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// Files to be written, each with its format.
class PictureOutputs {
 public:
  /// Errors: UsageError for a name that ends neither in .exr nor in .png, or that is given twice.
  explicit PictureOutputs(const PictureOptions& options);

  bool empty() const { return exr_.empty() && png_.empty(); }
  std::vector<std::filesystem::path> files() const;

  /// Writes every file: `picture` as EXR, its tone-mapped root as PNG.
  /// Errors: OutputError; the file that it names is then as it was before. Those of `picture`.
  void write(const LayeredPicture& picture) const;

 private:
  std::vector<std::filesystem::path> exr_, png_;
  ToneMapping tone_mapping_;
};

}  // namespace photile::app
