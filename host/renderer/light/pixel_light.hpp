// The light that reaches one pixel, layer by layer, whichever way the layers are stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "photile/light_layers.hpp"

namespace photile {

/// Calls visit(light, illuminance, radiance) for all lights that reach a pixel, at power 1.
template <class Layers, class Visit>
void for_each_light(Layers& layers, std::size_t x, std::size_t y, const Visit& visit) {
  if (layers.sparse()) {
    auto& row = layers.rows[y];
    for (std::uint32_t i = row.first[x]; i < row.first[x + 1]; ++i) {
      visit(std::size_t{row.light[i]}, row.illuminance[i], row.radiance[i]);
    }
    return;
  }
  const std::size_t pixel = y * static_cast<std::size_t>(layers.width) + x;
  for (std::size_t light = 0; light < layers.layers.size(); ++light) {
    auto& layer = layers.layers[light];
    visit(light, layer.illuminance[pixel], layer.radiance[pixel]);
  }
}

}  // namespace photile
