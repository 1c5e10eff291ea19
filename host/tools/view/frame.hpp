// A finished picture of the walkthrough, before its lights are mixed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/statistics.hpp"
#include "tools/view/photon_map_view.hpp"

namespace photile::view {

struct Frame {
  LightLayers layers;
  /// The part of it that came by reflection, where it was asked for.
  std::optional<LightLayers> reflections;
  std::shared_ptr<const InspectablePhotons> photons;  ///< of the maps it was estimated from
  Camera camera;                                      ///< in the scene's coordinates
  int samples_per_pixel = 1;
  std::uint64_t emitted_photons = 0;  ///< paths of the maps it was estimated from
  double seconds = 0;                 ///< that it took
  RunStatistics statistics;           ///< of its stages
};

}  // namespace photile::view
