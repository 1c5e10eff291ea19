#include "view/display.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "image/srgb.hpp"
#include "photile/image.hpp"

namespace photile::view {
namespace {

/// The mixed picture, as tone mapping takes it.
Image root_of(const Frame& frame, const LightMix& mix) {
  Image image;
  image.width = frame.layers.width;
  image.height = frame.layers.height;
  std::vector<glm::vec3> rgb(image.pixels());
  combine_layers(frame.layers, mix, rgb);
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float>& plane = image.add(std::string(1, "RGB"[channel]));
    for (std::size_t pixel = 0; pixel < rgb.size(); ++pixel) plane[pixel] = rgb[pixel][channel];
  }
  return image;
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

DisplayedFrame tone_mapped(const Image& root, double exposure) {
  const Image display = tone_map(root, {false, exposure});
  DisplayedFrame result{root.width, root.height, std::vector<std::uint8_t>(3 * root.pixels())};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::vector<float>& plane = *display.find(std::string(1, "RGB"[channel]));
    for_each_pixel(plane.size(), [&](std::size_t pixel) {
      result.rgb[3 * pixel + channel] = image::srgb8_from_linear(plane[pixel]);
    });
  }
  return result;
}

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

}  // namespace

std::vector<float> mixed_illuminance(const LightLayers& layers, const LightMix& mix) {
  const auto width = static_cast<std::size_t>(layers.width);
  std::vector<float> result(width * static_cast<std::size_t>(layers.height));
  for_each_pixel(result.size(), [&](std::size_t pixel) {
    double sum = 0;
    for_each_light(layers, pixel % width, pixel / width,
                   [&](std::size_t light, float illuminance, const glm::vec3&) {
                     sum += mix.lights[light].power * static_cast<double>(illuminance);
                   });
    result[pixel] = static_cast<float>(sum);
  });
  return result;
}

DisplayedFrame display(const Frame& frame, const LightMix& mix, const DisplaySettings& settings) {
  if (settings.mode == DisplayMode::picture) {
    return tone_mapped(root_of(frame, mix), settings.exposure);
  }
  const std::vector<float> values = mixed_illuminance(frame.layers, mix);
  const double largest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  const measuring::ColourScale scale(settings.false_colour, largest);
  DisplayedFrame result{frame.layers.width, frame.layers.height,
                        std::vector<std::uint8_t>(3 * values.size())};
  for_each_pixel(values.size(), [&](std::size_t pixel) {
    const auto color = scale.rgb(static_cast<double>(values[pixel]));
    std::copy(color.begin(), color.end(),
              result.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  });
  return result;
}

double automatic_stops(const Frame& frame, const LightMix& mix) {
  return std::log2(automatic_exposure(root_of(frame, mix)));
}

std::vector<LightReading> readings_at(const Frame& frame, const LightMix& mix, int x, int y) {
  std::vector<LightReading> readings(mix.lights.size());
  if (x < 0 || y < 0 || x >= frame.layers.width || y >= frame.layers.height) return readings;
  for_each_light(frame.layers, static_cast<std::size_t>(x), static_cast<std::size_t>(y),
                 [&](std::size_t light, float illuminance, const glm::vec3& radiance) {
                   const MixedLight& mixed = mix.lights[light];
                   readings[light] = {
                       mixed.power * luminance(glm::dvec3(mixed.tint) * glm::dvec3(radiance)),
                       mixed.power * static_cast<double>(illuminance)};
                 });
  return readings;
}

}  // namespace photile::view
