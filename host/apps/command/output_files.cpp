#include "command/output_files.hpp"

#include <fmt/format.h>

#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "common/output_file.hpp"
#include "common/run_files.hpp"
#include "photile/errors.hpp"

namespace photile::app {

void note_inputs_of(const RenderOptions& options) {
  note_input(options.scene);
  for (const LightProfile& profile : options.load.profiles) note_input(profile.file);
  note_input(options.load.environment.file);
  note_input(options.load.situation.weather);
  note_input(options.load.luminaires);
  note_input(options.load_maps);
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

}  // namespace photile::app
