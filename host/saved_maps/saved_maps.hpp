// Photons and groups in a file, so that the same scene is looked at again without tracing it. The
// format is docs/saved-maps.md.
#pragma once

#include <filesystem>
#include <string>

#include "photile/scene.hpp"
#include "photile/scene_renderer.hpp"

namespace photile::saved_maps {

/// Writes a file, through a temporary name and a rename.
///   settings   in words: what the photons depend on beside the scene
/// Errors: OutputError naming the file; an existing file is kept then.
void save(const std::filesystem::path& file, const Scene& scene, const std::string& settings,
          const PreparedPhotons& prepared);

/// Adds light maps of these photons to a file, in place of those that it holds: through a temporary
/// name and a rename. Errors: InputError where it is no such file; OutputError.
void add_light_maps(const std::filesystem::path& file, const LightMapContents& contents);

/// Reads a file back, bit for bit. Errors: InputError naming the file where it is missing, no such
/// file, of another version or byte order, truncated, longer than it says, damaged, or
/// inconsistent; or where it was saved from another scene or with other settings, which it names.
PreparedPhotons load(const std::filesystem::path& file, const Scene& scene,
                     const std::string& settings);

}  // namespace photile::saved_maps
