// A finished picture of the walkthrough, before its lights are mixed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/light_pooling.hpp"
#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "view/photon_map_view.hpp"

namespace photile::view {

/// What the noise of an estimate depends on.
struct EstimateNoise {
  /// Photons of one estimate, as many as equal weights would need for its noise; 0 = not known.
  double photons = 0;
  /// Of each layer's lights; of a pooled layer, those of its lights over their powers together.
  std::vector<double> paths;

  static EstimateNoise of(const Scene& scene, const RenderParameters& parameters);
  EstimateNoise pooled(const LightPooling& pooling) const;
};

struct Frame {
  LightLayers layers;  ///< of a quick frame only width and height
  /// A quick frame of a moving viewer: the light of all lamps together, linear RGB; else empty.
  std::vector<glm::vec3> mixed;
  /// The part of it that came by reflection, where it was asked for.
  std::optional<LightLayers> reflections;
  std::shared_ptr<const InspectablePhotons> photons;  ///< of the maps it was estimated from
  std::shared_ptr<const Scene> scene;                 ///< that it shows, as the maps hold it
  Camera camera;                                      ///< in the scene's coordinates
  int samples_per_pixel = 1;
  double lacking = 0;                 ///< share of the surface whose light is not yet final
  std::uint64_t emitted_photons = 0;  ///< paths of the maps it was estimated from
  EstimateNoise noise;
  double seconds = 0;        ///< that it took
  RunStatistics statistics;  ///< of its stages
};

}  // namespace photile::view
