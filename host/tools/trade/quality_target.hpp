// Settings for a wanted error or frame time, from a model that a few quick renderings measure.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/light_mix.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile {

/// The error of a picture of one view as a function of its settings:
///   relative_mse = noise / (k - 2) + sampling / samples + bias (k / photons)^exponent
/// The first term is the variance of a density from k photons, the second that of the places in a
/// pixel, the third the squared bias of a disc whose area is in proportion to k / photons
/// (Hachisuka et al. 2010 derive the exponent 2 where irradiance is smooth; shadow borders make it
/// less).
struct ErrorModel {
  double noise = 0;     ///< times 1 / (k - 2)
  double sampling = 0;  ///< times 1 / samples a pixel
  double bias = 0;      ///< times (k / emitted photons)^exponent
  double exponent = 1;

  /// relative_mse (picture_error.hpp) that is to be expected.
  double relative_mse(double photons, double k, double samples) const;
};

/// The time of a picture as a function of its settings, seconds.
struct TimeModel {
  double fixed = 0;                 ///< ray tracing structure, neighbour groups
  double per_photon = 0;            ///< emitted: tracing, building maps
  double per_sample = 0;            ///< primary hit, film, and what an estimate costs at any k
  double per_sample_neighbour = 0;  ///< times k
  double samples_per_picture = 0;   ///< pixels

  double frame(double k, double samples) const;
  double first_picture(double photons, double k, double samples) const;
};

/// What the user wants; 0 = does not matter.
struct QualityTarget {
  /// At most, of the whole picture: PictureError::relative_error; where nodes of light maps gather,
  /// the standard error that they state.
  double relative_error = 0;
  double frame_seconds = 0;  ///< at most, of each picture once the photon maps exist
  double run_seconds = 0;    ///< of the whole process, where nodes of light maps gather
};

/// What was chosen, what is expected of it, and whether that is what was wanted.
struct QualityChoice {
  std::uint64_t photons = 0;
  int neighbours = 0;
  int samples_per_pixel = 1;
  double expected_error = 0;  ///< relative
  double expected_frame_seconds = 0;
  double expected_first_picture_seconds = 0;
  bool reached = false;  ///< the target is expected to be met; else this is as near as it gets
};

/// The fastest settings expected to meet the target. With a wanted error all of photons, neighbours
/// and samples are chosen; with a frame time alone `photons` stays, and the error is made least.
QualityChoice choose_settings(const QualityTarget& target, const ErrorModel& error,
                              const TimeModel& time, std::uint64_t photons);

/// Both models, measured on a view.
struct QualityModels {
  ErrorModel error;
  TimeModel time;
  double seconds = 0;  ///< that the measurement took
};

/// Renders small pictures of the view with photons of two independent seeds and three k. What
/// differs between the seeds is noise; what differs between the k in both seeds alike is bias.
/// Errors: those of the stages.
QualityModels measure_models(const Scene& scene, const Camera& camera, Device& device,
                             const LightMix& mix, const RenderParameters& parameters,
                             Progress& progress = Progress::none());

}  // namespace photile
