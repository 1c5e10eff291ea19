// The request, the settings and the cost of a run: for the picture's attributes, the summary and
// --stats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device/context.hpp"
#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"
#include "render/refinement.hpp"

namespace photile::app {

/// Kernels of one device.
struct KernelRecord {
  std::string device;                      ///< its id
  std::uint64_t compiled = 0, cached = 0;  ///< programs, and those that were compiled before
  double compile_seconds = 0;
  std::vector<device::KernelTime> times;  ///< with profile=on
};

struct RunRecord {
  bool has_photons() const { return !devices.empty(); }

  std::string scene;  ///< the file's name, without folders, which a picture should not reveal
  std::optional<double> ground;  ///< its reflectance; none without a sky or a sun of the options
  std::string surfaces;          ///< digest_of_surfaces
  std::string camera;
  std::string integrator;  ///< "photon-map" or "path", which has no devices, maps and photons
  Quality quality = Quality::draft;  ///< whose settings are used, except those that are given
  RefinementGoal goal;               ///< that ended the series of pictures
  RenderParameters used;             ///< RenderResult::used, or what paths were asked for
  std::vector<DeviceInfo> devices;
  std::vector<double> device_fractions;  ///< of the hits, per device
  LightMix mix;
  std::string denoiser;  ///< and its version; "" = not denoised
  std::uint64_t stored_photons = 0;
  std::vector<KernelRecord> kernels;  ///< of each device
  RunStatistics stages;
  TimeTaken total;  ///< of the process
};

/// Sets what the process has taken, and adds a row of what no stage has: the rows add up to it.
void close(RunRecord& record, const TimeTaken& total);

/// Sets the string attributes `photile.*` of a picture.
void set_run_attributes(PictureHeader& picture, const RunRecord& record);

/// The content of --stats FILE.
nlohmann::json run_json(const RunRecord& record);

/// Largest memory that the process has had so far, bytes.
std::uint64_t peak_host_bytes();

/// A digest of the geometry of surfaces and how they reflect: pictures of one scene with other
/// reflectances have another.
std::string digest_of_surfaces(const Scene& scene);

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
