// What a finished frame was made with, so that it is not made again.
#pragma once

#include <filesystem>
#include <string>

#include "command/run_record.hpp"
#include "photile/camera.hpp"
#include "photile/scene.hpp"

namespace photile::app {

/// A digest of all that light in the scene depends on.
std::string digest_of(const Scene& scene);

/// A digest of everything that a frame's pixels depend on: the scene, photile's version, the
/// record's parameters and lights, and the camera.
std::string frame_settings(const std::string& scene_digest, const RunRecord& record,
                           const Camera& camera);

/// Sets the attribute `photile.settings`.
void set_settings(PictureHeader& picture, const std::string& settings);

/// Whether there is such a picture with these settings, and whole: its pixels are read, for copies
/// may have been cut and disks fail.
bool is_finished(const std::filesystem::path& picture, const std::string& settings);

/// Whether there is a picture of which every pixel can be read.
bool is_whole(const std::filesystem::path& picture);

}  // namespace photile::app
