#include "photile/light_layers.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/value_range.hpp"
#include "image/light_change.hpp"
#include "image/light_layers.hpp"
#include "image/picture_file.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"

namespace photile {

namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

std::size_t pixels_of(const LightLayers& layers) {
  return static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
}

void add_plane(LightLayers::Layer& layer, std::size_t pixels) {
  layer.radiance.assign(pixels, glm::vec3(0.0f));
  layer.illuminance.assign(pixels, 0.0f);
}

}  // namespace

std::vector<bool> image::lit_layers(const LightLayers& layers) {
  std::vector<bool> lit(layers.layers.size(), false);
  for (std::size_t y = 0; y < static_cast<std::size_t>(layers.height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(layers.width); ++x) {
      for_each_light(layers, x, y, [&](std::size_t light, float illuminance, const glm::vec3& l) {
        if (illuminance > 0 || l != glm::vec3(0.0f)) lit[light] = true;
      });
    }
  }
  return lit;
}

std::vector<std::string> image::layer_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const LightGroup& group : light_groups_of(scene).groups) names.push_back(group.name);
  return names;
}

LightLayers::LightLayers(int width, int height, const Scene& scene)
    : LightLayers(width, height, image::layer_names(scene)) {}

LightLayers::LightLayers(int width, int height, const std::vector<std::string>& names)
    : width(width), height(height) {
  for (const std::string& name : names) layers.push_back({name, {}, {}});
  if (names.size() > max_dense_lights) {
    rows.resize(static_cast<std::size_t>(height));
    for (Row& row : rows) row.first.assign(static_cast<std::size_t>(width) + 1, 0);
  } else {
    for (Layer& layer : layers) add_plane(layer, pixels_of(*this));
  }
}

std::uint64_t LightLayers::bytes() const {
  std::uint64_t sum = 0;
  for (const Layer& layer : layers) sum += bytes_of(layer.radiance) + bytes_of(layer.illuminance);
  for (const Row& row : rows) {
    sum += bytes_of(row.first) + bytes_of(row.light) + bytes_of(row.radiance) +
           bytes_of(row.illuminance);
  }
  return sum;
}

LightLayers LightLayers::dense() const {
  LightLayers result = *this;
  if (!sparse()) return result;
  result.rows.clear();
  for (Layer& layer : result.layers) add_plane(layer, pixels_of(*this));
  for (std::size_t pixel = 0; pixel < pixels_of(*this); ++pixel) {
    const auto columns = static_cast<std::size_t>(width);
    for_each_light(*this, pixel % columns, pixel / columns,
                   [&](std::size_t light, float illuminance, const glm::vec3& radiance) {
                     result.layers[light].radiance[pixel] = radiance;
                     result.layers[light].illuminance[pixel] = illuminance;
                   });
  }
  return result;
}

double in_unit(double power, PowerUnit from, PowerUnit to, double lumen_per_watt) {
  if (from == to) return power;
  return to == PowerUnit::lumen ? power * lumen_per_watt : power / lumen_per_watt;
}

PowerUnit LightMix::unit() const {
  const bool watts =
      !lights.empty() && std::all_of(lights.begin(), lights.end(), [](const MixedLight& light) {
        return light.unit == PowerUnit::watt;
      });
  return watts ? PowerUnit::watt : PowerUnit::lumen;
}

LightMix LightMix::of(const Scene& scene, double lumen_per_watt) {
  check_value("lumen_per_watt", lumen_per_watt, PositiveNumbers{});
  LightMix mix;
  mix.lumen_per_watt = lumen_per_watt;
  for (const LightGroup& group : light_groups_of(scene).groups) {
    MixedLight mixed;
    mixed.name = group.name;
    const bool photometric =
        std::all_of(group.lights.begin(), group.lights.end(),
                    [&](std::uint32_t light) { return scene.lights[light].distribution != none; });
    mixed.unit = photometric ? PowerUnit::lumen : scene.unit;
    mixed.power = in_unit(group.power, scene.unit, mixed.unit, lumen_per_watt);
    mixed.color = group.color;
    for (const std::uint32_t light : group.lights) {
      if (!scene.lights[light].group.empty()) mixed.members.push_back(scene.lights[light].name);
    }
    mix.lights.push_back(std::move(mixed));
  }
  return mix;
}

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
  std::array<std::uint32_t, stride> mask;  ///< no bits where the scale is 0, all elsewhere
};

/// Off means black, whatever the layer holds: infinity times zero is not. A mask of bits rather
/// than a condition, which compilers do not turn into vectors where it may raise a floating-point
/// exception.
float scaled(float value, float scale, std::uint32_t mask) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value * scale) & mask);
}

/// sums[i] += values[i] x scale[i mod 3]
void add_scaled(const ScaledLayer& layer, std::size_t first, std::size_t count, float* sums) {
  const std::array<float, stride> scale = layer.scale;
  const std::array<std::uint32_t, stride> mask = layer.mask;
  const float* values = layer.values + first;
  std::size_t i = 0;
  for (; i + stride <= count; i += stride) {
    std::array<float, stride> products;  // apart from the sums, which might overlap the values
    for (std::size_t j = 0; j < stride; ++j) products[j] = scaled(values[i + j], scale[j], mask[j]);
    for (std::size_t j = 0; j < stride; ++j) sums[i + j] += products[j];
  }
  for (std::size_t j = 0; i + j < count; ++j)
    sums[i + j] += scaled(values[i + j], scale[j], mask[j]);
}

/// The factor of each light's radiance.
std::vector<glm::vec3> scales_of(const LightLayers& layers, const LightMix& mix) {
  std::vector<glm::vec3> scales;
  for (const LightLayers::Layer& layer : layers.layers) {
    const MixedLight& light = mix.lights[image::index_of(mix, layer.light)];
    scales.emplace_back(mix.power_in_picture(light) * glm::dvec3(light.tint));
  }
  return scales;
}

std::vector<ScaledLayer> scaled_layers(const LightLayers& layers,
                                       std::span<const glm::vec3> scales) {
  std::vector<ScaledLayer> result;
  for (std::size_t l = 0; l < scales.size(); ++l) {
    const LightLayers::Layer& layer = layers.layers[l];
    const glm::vec3& scale = scales[l];
    ScaledLayer entry{layer.radiance.empty() ? nullptr : &layer.radiance[0].x, {}, {}};
    for (std::size_t i = 0; i < stride; ++i) {
      entry.scale[i] = scale[static_cast<int>(i % 3)];
      entry.mask[i] = entry.scale[i] == 0.0f ? 0u : ~0u;
    }
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
  image::combine_rows(layers, scales_of(layers, mix), 0, picture);
}

void image::combine_rows(const LightLayers& layers, std::span<const glm::vec3> scales, int row,
                         std::span<glm::vec3> picture) {
  const auto width = static_cast<std::size_t>(layers.width), begin = static_cast<std::size_t>(row);
  if (layers.sparse()) {
    tbb::parallel_for(std::size_t{0}, picture.size() / width, [&](std::size_t y) {
      // Lights that do not reach a pixel would add 0: leaving them out changes no bit.
      for (std::size_t x = 0; x < width; ++x) {
        glm::vec3& sum = picture[y * width + x];
        sum = glm::vec3(0.0f);
        for_each_light(layers, x, begin + y,
                       [&](std::size_t light, float, const glm::vec3& radiance) {
                         for (int c = 0; c < 3; ++c) {
                           if (scales[light][c] != 0.0f) sum[c] += radiance[c] * scales[light][c];
                         }
                       });
      }
    });
    return;
  }
  const std::size_t pixels = picture.size();
  const std::vector<ScaledLayer> entries = scaled_layers(layers, scales);
  const std::size_t blocks = (pixels + pixels_per_block - 1) / pixels_per_block;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t first = block * pixels_per_block;
    const std::size_t count = std::min(pixels_per_block, pixels - first);
    std::fill_n(picture.begin() + static_cast<std::ptrdiff_t>(first), count, glm::vec3(0.0f));
    for (const ScaledLayer& layer : entries) {
      add_scaled(layer, 3 * (begin * width + first), 3 * count, &picture[first].x);
    }
  });
}

}  // namespace photile
