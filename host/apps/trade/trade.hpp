// Convergence: the time and error of one view rendered with many settings, each compared with a
// reference.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile::trade {

/// Settings to measure.
struct TradeSettings {
  std::string varied;  ///< "photons and neighbours", "samples_per_pixel", ...
  RenderParameters parameters;
};

/// What `photile trade` measures: photons and neighbours in all pairs, the work of the quality
/// `good`, and other settings each alone, all else as in `parameters`.
std::vector<TradeSettings> settings_around(const RenderParameters& parameters);

/// One rendering.
struct TradePoint {
  TradeSettings settings = {};
  RenderParameters used = {};  ///< RenderResult::used
  std::uint64_t stored_photons = 0;
  PictureError error = {};
  /// From the loaded scene to the picture, without the compilation of kernels.
  double first_picture_seconds = 0;
  /// Seconds of a further picture from another viewpoint: primary hits, estimate, film.
  double frame_seconds = 0;
  std::uint64_t host_bytes = 0, device_bytes = 0;  ///< most that the stages' results took
};

/// The scene and view that time and error are measured on.
struct TradeSubject {
  const Scene& scene;
  const Camera& camera;
  std::span<Device> devices;
  const LightMix& mix;
  const Image& reference;  ///< of the size in the parameters' film
};

/// Renders with all settings. Errors: those of render and picture_error.
std::vector<TradePoint> measure_trade(const TradeSubject& subject,
                                      std::span<const TradeSettings> settings,
                                      Progress& progress = Progress::none());

/// The fastest point to the first picture whose relative error is at most `error`, or nullptr.
const TradePoint* fastest_within(std::span<const TradePoint> points, double error);

}  // namespace photile::trade
