#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "image/light_change.hpp"
#include "photile/errors.hpp"
#include "photile/light_mix.hpp"

namespace photile {
namespace {

/// Pixels summed at a time: their sums stay in the first cache while the layers stream by.
constexpr std::size_t pixels_per_block = 1024;
/// Floats of the loop that the compiler turns into vectors: a multiple of 3 and of any width.
constexpr std::size_t stride = 48;

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

/// A layer as a row of floats, and the factor of each, repeated to the stride.
struct ScaledLayer {
  const float* values;
  std::array<float, stride> scale;
};

/// Off means black, whatever the layer holds: infinity times zero is not.
float scaled(float value, float scale) { return scale == 0.0f ? 0.0f : value * scale; }

/// sums[i] += values[i] x scale[i mod 3]
void add_scaled(const ScaledLayer& layer, std::size_t first, std::size_t count, float* sums) {
  const float* values = layer.values + first;
  std::size_t i = 0;
  for (; i + stride <= count; i += stride) {
    for (std::size_t j = 0; j < stride; ++j) sums[i + j] += scaled(values[i + j], layer.scale[j]);
  }
  for (std::size_t j = 0; i + j < count; ++j) sums[i + j] += scaled(values[i + j], layer.scale[j]);
}

std::vector<ScaledLayer> scaled_layers(const LightLayers& layers, const LightMix& mix) {
  std::vector<ScaledLayer> result;
  for (const LightLayers::Layer& layer : layers.layers) {
    const MixedLight& light = mix.lights[image::index_of(mix, layer.light)];
    const glm::vec3 scale(light.power * glm::dvec3(light.tint));
    ScaledLayer entry{layer.radiance.empty() ? nullptr : &layer.radiance[0].x, {}};
    for (std::size_t i = 0; i < stride; ++i) entry.scale[i] = scale[static_cast<int>(i % 3)];
    result.push_back(entry);
  }
  return result;
}

}  // namespace

void combine_layers(const LightLayers& layers, const LightMix& mix, std::span<glm::vec3> picture) {
  const std::size_t pixels =
      static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  if (picture.size() != pixels) {
    throw UsageError(fmt::format("combine_layers: a picture of {} pixels for layers of {} x {}",
                                 picture.size(), layers.width, layers.height));
  }
  const std::vector<ScaledLayer> entries = scaled_layers(layers, mix);
  const std::size_t blocks = (pixels + pixels_per_block - 1) / pixels_per_block;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t first = block * pixels_per_block;
    const std::size_t count = std::min(pixels_per_block, pixels - first);
    std::fill_n(picture.begin() + static_cast<std::ptrdiff_t>(first), count, glm::vec3(0.0f));
    for (const ScaledLayer& layer : entries) {
      add_scaled(layer, 3 * first, 3 * count, &picture[first].x);
    }
  });
}

}  // namespace photile
