// Layers of pictures: which of them have light, and work on all of their pixels.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <string>
#include <vector>

#include "light/pixel_light.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"

namespace photile::image {

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
