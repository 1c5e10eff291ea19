// Layers of lights that are mixed before they reach the film.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace photile {

/// What becomes of the lights' layers: each is multiplied by a number and added to another. Of
/// hundreds of patches of a sky one layer is left, which costs a film as much as one lamp.
struct LightPooling {
  std::vector<std::string> layers;      ///< of the film
  std::vector<std::uint32_t> layer_of;  ///< per layer of the scene: into `layers`
  std::vector<float> scale;             ///< per layer of the scene
};

}  // namespace photile
