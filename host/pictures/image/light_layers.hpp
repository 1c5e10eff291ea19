// The light that reaches one pixel, layer by layer, whichever way the layers are stored.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"

namespace photile::image {

/// Calls add(light, illuminance, radiance) for all that reaches a pixel, at power 1.
template <class Add>
void for_each_light(const LightLayers& layers, std::size_t x, std::size_t y, const Add& add) {
  if (layers.sparse()) {
    const LightLayers::Row& row = layers.rows[y];
    for (std::uint32_t i = row.first[x]; i < row.first[x + 1]; ++i) {
      add(std::size_t{row.light[i]}, row.illuminance[i], row.radiance[i]);
    }
    return;
  }
  const std::size_t pixel = y * static_cast<std::size_t>(layers.width) + x;
  for (std::size_t light = 0; light < layers.layers.size(); ++light) {
    const LightLayers::Layer& layer = layers.layers[light];
    add(light, layer.illuminance[pixel], layer.radiance[pixel]);
  }
}

/// Calls work(pixel) for all pixels, on all cores.
template <class Work>
void for_each_pixel(std::size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
                        work(pixel);
                      }
                    });
}

/// Per layer whether its light reaches any pixel.
std::vector<bool> lit_layers(const LightLayers& layers);

/// Of the layers of a scene's pictures, in order: a light, or a group of lights.
std::vector<std::string> layer_names(const Scene& scene);

}  // namespace photile::image
