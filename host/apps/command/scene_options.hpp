// How a scene file is read, and which lights are added to it or changed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"

namespace CLI {
class App;
}

namespace photile::app {

class OptionGroup;

/// Adds the scene's file, an argument that must be given.
void add_scene_file(CLI::App& command, std::string& file);

/// Adds --reflectance.
void add_scene_options(CLI::App& command, SceneLoadOptions& options);

/// Adds those that add lights to the scene or change them. Malformed ones are errors of the command
/// line.
void add_light_options(CLI::App& command, SceneLoadOptions& options);

/// Adds --site, --time and --weather.
void add_situation_options(const OptionGroup& group, SkySituation& situation);

/// Adds --light.
void add_light_change_option(const OptionGroup& group, std::vector<LightChange>& changes);

struct MoodOptions {
  std::string mood;     ///< "" = none
  std::string file;     ///< "" = beside the scene
  bool edited = false;  ///< the run may write the file, too

  bool asked() const { return !mood.empty(); }
};

/// Adds --mood and --moods.
void add_mood_options(const OptionGroup& group, MoodOptions& options);
/// Adds --moods alone.
void add_moods_file_option(const OptionGroup& group, std::string& file);

/// The file of moods: the one that is given, else the first that exists of those beside `scene` and
/// `picture` (either may be empty). Errors: UsageError where there is none.
std::filesystem::path moods_file(const std::string& given, const std::filesystem::path& scene,
                                 const std::filesystem::path& picture = {});

/// What a mood changes in a mix; nothing where none is asked for. Lights that it does not name keep
/// their settings. Errors: UsageError where there is no such mood (the message lists those there
/// are), those of moods_file and note_input; InputError for a damaged file.
std::vector<LightChange> changes_of(const MoodOptions& options, const LightMix& mix,
                                    const std::filesystem::path& scene);

/// The file of moods of a picture. Errors: as moods_file; those of read_header.
std::filesystem::path moods_of_picture(const std::string& given,
                                       const std::filesystem::path& picture);

/// The changes that a mood makes to the lights of a picture. Without --moods the file beside the
/// picture's scene, if it lies in the same folder, or beside the picture. Errors: as above; those
/// of read_header.
std::vector<LightChange> mood_of_picture(const MoodOptions& options,
                                         const std::filesystem::path& picture);

/// Both, in this order: a mood, and what --light changes in it.
std::vector<LightChange> joined(std::vector<LightChange> mood,
                                const std::vector<LightChange>& lights);

}  // namespace photile::app
