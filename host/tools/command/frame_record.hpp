// What a finished frame was made with, so that it is not made again.
#pragma once

#include <filesystem>
#include <string>

#include "photile/camera.hpp"
#include "photile/scene.hpp"
#include "tools/command/run_record.hpp"

namespace photile::app {

/// A digest of all that light in the scene depends on.
std::string digest_of(const Scene& scene);

/// A digest of everything that a frame's pixels depend on: the scene, photile's version, the
/// record's parameters and lights, and the camera.
std::string frame_settings(const std::string& scene_digest, const RunRecord& record,
                           const Camera& camera);

/// Sets the attribute `photile.settings`.
void set_settings(PictureHeader& picture, const std::string& settings);

/// Whether there is such a picture with these settings. Files are written whole, so then it is
/// complete.
bool has_settings(const std::filesystem::path& picture, const std::string& settings);

}  // namespace photile::app
