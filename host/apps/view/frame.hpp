// A finished picture of the walkthrough.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "image/white.hpp"
#include "photile/camera.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"

namespace photile::view {

struct InspectablePhotons;  // photon_map.hpp

struct Frame {
  LightLayers layers;  ///< of a quick frame only width and height
  /// A quick frame: the light of all lamps together, linear RGB, of fewer pixels than were asked
  /// for where those are many; else empty.
  std::vector<glm::vec3> mixed;
  /// The part of it that came by reflection, where it was asked for.
  std::optional<LightLayers> reflections;
  std::shared_ptr<const InspectablePhotons> photons;  ///< of the maps it was estimated from
  std::shared_ptr<const Scene> scene;                 ///< that it shows, as the maps hold it
  Camera camera;                                      ///< in the scene's coordinates
  int samples_per_pixel = 1;
  double lacking = 0;                 ///< share of the surface whose light is not yet final
  std::uint64_t emitted_photons = 0;  ///< paths of the maps it was estimated from
};

/// The frame with its layers, its camera and its white, as `render` writes EXR. Errors:
/// OutputError.
void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix, const image::White& white);

/// Power x tint of each layer: what quick frames are mixed by.
std::vector<glm::vec3> scales_of(const LightMix& mix);

}  // namespace photile::view
