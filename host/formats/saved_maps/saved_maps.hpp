// Photons and groups in a file, so that the same scene is looked at again without tracing it.
// What has to be equal: docs/reference/saved-maps.md.
#pragma once

#include <filesystem>
#include <string>

#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile::saved_maps {

/// What a file has to match beside the scene, in words for a refusal.
struct Settings {
  std::string photons;
  std::string groups;  ///< what these depend on beside the photons
};

/// Writes a file, through a temporary name and a rename.
///   prepared   without groups: the file fits any settings of groups
/// Errors: OutputError naming the file; an existing file is kept then.
void save(const std::filesystem::path& file, const Scene& scene, const Settings& settings,
          const TracedPhotons& prepared);

/// Adds light maps of these photons to a file, in place of those that it holds: through a temporary
/// name and a rename. Errors: InputError where it is no such file; OutputError.
void add_light_maps(const std::filesystem::path& file, const LightMapContents& contents);

/// Reads a file back, bit for bit. Errors: InputError naming the file where it is missing, no such
/// file, of another version or byte order, truncated, longer than it says, damaged, inconsistent,
/// or a part; or where it was saved from another scene or with other settings, which it names.
TracedPhotons load(const std::filesystem::path& file, const Scene& scene, const Settings& settings);

/// "" where all indices and sizes fit one another and the scene, and all numbers are finite; else
/// what is wrong.
std::string problem_of(const TracedPhotons& prepared, const Scene& scene);

}  // namespace photile::saved_maps
