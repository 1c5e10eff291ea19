// The trade between time and error: one view rendered with many settings, each beside a reference.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/image.hpp"
#include "photile/light_mix.hpp"
#include "photile/picture_error.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile {

/// What is varied. Photons and neighbours are tried in all pairs; of each other axis every value
/// alone, with all else as in RenderParameters.
struct TradeAxes {
  std::vector<std::uint64_t> photons;    ///< paths over all lights
  std::vector<int> neighbours;           ///< k
  std::vector<int> least_neighbours;     ///< with an own k for each hit, from this on
  std::vector<double> radius_scales;     ///< of the automatic radius
  std::vector<double> angles;            ///< degrees
  std::vector<float> photons_per_cell;   ///< of uniform grids
  std::vector<int> samples;              ///< per pixel
  std::vector<AreaMode> areas;           ///< disc has dark borders
  std::vector<DensityKernel> kernels;    ///< other noise and blur at the same k
  std::vector<int> direct_rays;          ///< light straight from lamps not by photons
  std::vector<int> node_rays;            ///< of nodes that gather, photons in proportion
  std::vector<MapMode> maps;             ///< naive has dark edges
  std::vector<MapStructure> structures;  ///< same picture, other time

  /// The axes that `photile trade` tries unless told otherwise, around these parameters.
  static TradeAxes around(const RenderParameters& parameters);
};

/// One rendering.
struct TradePoint {
  std::string varied;  ///< "photons and neighbours", "radius", ...: what it was rendered for
  RenderParameters parameters = {};
  RenderParameters used = {};  ///< RenderResult::used
  std::uint64_t stored_photons = 0;
  PictureError error = {};
  /// From the loaded scene to the picture, without the compilation of kernels.
  double first_picture_seconds = 0;
  /// Of a further picture from another place: primary hits, estimate, film.
  double frame_seconds = 0;
  std::uint64_t host_bytes = 0, device_bytes = 0;  ///< most that the stages' results took
  bool on_front = false;  ///< Pareto: no other is both more right and faster to the first picture
};

/// What a trade is measured on.
struct TradeSubject {
  const Scene& scene;
  const Camera& camera;
  std::span<Device> devices;
  const LightMix& mix;
  const Image& reference;  ///< of the size in the parameters' film
};

/// Renders every setting, first the pairs of photons and neighbours. Errors: those of render and
/// picture_error.
std::vector<TradePoint> measure_trade(const TradeSubject& subject,
                                      const RenderParameters& parameters, const TradeAxes& axes,
                                      Progress& progress = Progress::none());

/// Marks the points that no other beats in both error and time to the first picture.
void mark_front(std::span<TradePoint> points);

/// The fastest point to the first picture whose relative error is at most `error`, or nullptr.
const TradePoint* fastest_within(std::span<const TradePoint> points, double error);

}  // namespace photile
