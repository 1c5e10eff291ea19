#include "command/mood_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "view/moods.hpp"

namespace photile::app {

void add_mood_options(CLI::App& command, MoodOptions& options, const std::string& group) {
  command
      .add_option("--mood", options.mood,
                  "lamps as the window kept them under this name; --light changes them further")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--moods", options.file,
                  "file of moods; default: SCENE's, such as room.moods.json")
      ->type_name("FILE")
      ->group(group);
}

std::filesystem::path moods_file(const std::string& given, const std::filesystem::path& scene,
                                 const std::filesystem::path& picture) {
  std::vector<std::filesystem::path> files;
  if (!given.empty()) files.emplace_back(given);
  if (given.empty() && !scene.empty()) files.push_back(view::Moods::file_of(scene));
  if (given.empty() && !picture.empty()) files.push_back(view::Moods::file_of(picture));
  for (const auto& file : files) {
    if (std::filesystem::exists(file)) return file;
  }
  throw UsageError(
      fmt::format("{}: there is no such file of moods; keep moods in the window, or "
                  "give --moods FILE",
                  files.front().string()));
}

std::vector<LightChange> changes_of(const MoodOptions& options, const LightMix& mix,
                                    const std::filesystem::path& scene,
                                    const std::filesystem::path& picture) {
  if (!options.asked()) return {};
  const std::filesystem::path file = moods_file(options.file, scene, picture);
  if (!options.edited) note_input(file);
  const view::Moods moods(file);
  return moods.changes(options.mood, mix);
}

std::vector<LightChange> mood_of_picture(const MoodOptions& options,
                                         const std::filesystem::path& picture) {
  if (!options.asked()) return {};
  const PictureHeader header = read_header(picture);
  std::filesystem::path scene;
  if (const auto name = header.attributes.find("photile.scene"); name != header.attributes.end()) {
    scene = picture.parent_path() / std::filesystem::path(name->second).filename();
  }
  return changes_of(options, read_light_mix(header), scene, picture);
}

std::vector<LightChange> joined(std::vector<LightChange> mood,
                                const std::vector<LightChange>& lights) {
  mood.insert(mood.end(), lights.begin(), lights.end());
  return mood;
}

}  // namespace photile::app
