#include "view/display.hpp"

#include <algorithm>
#include <cmath>

#include "image/glare.hpp"
#include "image/pixel_lights.hpp"
#include "image/srgb.hpp"
#include "photile/image.hpp"

namespace photile::view {

using image::for_each_light;
using image::for_each_pixel;

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

namespace {

/// Illuminances in their colours; of isolines and bands the rest is the picture.
DisplayedFrame false_coloured(const Frame& frame, const LightMix& mix,
                              const DisplaySettings& settings) {
  using measuring::Contours;
  const std::vector<float> values = mixed_illuminance(frame.layers, mix);
  const double largest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  const measuring::ColourScale scale(settings.false_colour, largest);
  const Contours contours = settings.false_colour.contours;
  const bool over_picture = contours == Contours::lines || contours == Contours::bands;
  const auto width = static_cast<std::size_t>(frame.layers.width);
  DisplayedFrame result{frame.layers.width, frame.layers.height,
                        std::vector<std::uint8_t>(3 * values.size())};
  if (over_picture) result = tone_mapped(root_of(frame, mix), settings.exposure);
  const auto value_at = [&](std::size_t pixel) { return static_cast<double>(values[pixel]); };
  const auto on_line = [&](std::size_t pixel) {
    const int level = scale.levels_below(value_at(pixel));
    const bool right = (pixel + 1) % width != 0 && scale.levels_below(value_at(pixel + 1)) != level;
    const bool below =
        pixel + width < values.size() && scale.levels_below(value_at(pixel + width)) != level;
    return right || below;
  };
  for_each_pixel(values.size(), [&](std::size_t pixel) {
    if (contours == Contours::lines && !on_line(pixel)) return;
    if (contours == Contours::bands && !scale.in_band(value_at(pixel))) return;
    const auto color = scale.rgb(value_at(pixel));
    std::copy(color.begin(), color.end(),
              result.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  });
  return result;
}

}  // namespace

DisplayedFrame display(const Frame& frame, const LightMix& mix, const DisplaySettings& settings) {
  if (settings.mode == DisplayMode::illuminance) return false_coloured(frame, mix, settings);
  DisplayedFrame result = tone_mapped(root_of(frame, mix), settings.exposure);
  // The first frames of the mode may still be without.
  if (settings.mode == DisplayMode::glare && frame.reflections) {
    image::draw_marks(
        image::find_glare(frame.layers, *frame.reflections, mix, settings.glare_limit).marks,
        result.rgb);
  }
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
