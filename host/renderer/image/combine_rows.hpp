// Some rows of what combine_layers makes of all.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "photile/light_layers.hpp"

namespace photile::image {

/// Adds up the layers, each times its scale, from a row on: as many rows as the picture has room
/// for. `scales` has one per layer, power x tint.
void combine_rows(const LightLayers& layers, std::span<const glm::vec3> scales, int row,
                  std::span<glm::vec3> picture);

}  // namespace photile::image
