#include "view/frame.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "image/display.hpp"
#include "image/glare.hpp"
#include "image/light_layers.hpp"
#include "image/white.hpp"
#include "photile/image.hpp"
#include "photile/light_layers.hpp"
#include "report/false_colour.hpp"

namespace photile::view {

EstimateNoise EstimateNoise::of(const Scene& scene, const RenderParameters& parameters) {
  // The area is that to the k-th photon: the variance of its inverse is 1 / (k - 2).
  EstimateNoise noise{std::max(1, parameters.neighbours - 2) / kernel_spread(parameters.kernel),
                      {}};
  const LightGroups groups = light_groups_of(scene);
  noise.paths.resize(groups.groups.size());
  const auto paths =
      photons_per_light(scene, parameters.photons.emitted_photons, parameters.photons.quota);
  for (std::size_t light = 0; light < paths.size(); ++light) {
    noise.paths[groups.group_of[light]] += static_cast<double>(paths[light]);
  }
  return noise;
}

EstimateNoise EstimateNoise::pooled(const LayerMixdown& mixdown) const {
  std::vector<double> sums(mixdown.layers.size()), powers(mixdown.layers.size());
  for (std::size_t light = 0; light < paths.size(); ++light) {
    sums[mixdown.layer_of[light]] += paths[light];
    powers[mixdown.layer_of[light]] += static_cast<double>(mixdown.scale[light]);
  }
  for (std::size_t layer = 0; layer < sums.size(); ++layer) {
    sums[layer] = powers[layer] > 0 ? sums[layer] / powers[layer] : 0.0;
  }
  return {photons, std::move(sums)};
}

using image::for_each_pixel;

namespace {

/// The picture of a frame with layers, mixed.
std::vector<glm::vec3> mixed(const LightLayers& layers, const LightMix& mix) {
  std::vector<glm::vec3> rgb(static_cast<std::size_t>(layers.width) *
                             static_cast<std::size_t>(layers.height));
  combine_layers(layers, mix, rgb);
  return rgb;
}

/// The mixed picture, as automatic exposure takes it.
Image root_of(const Frame& frame, const LightMix& mix) {
  Image image;
  image.width = frame.layers.width;
  image.height = frame.layers.height;
  const std::vector<glm::vec3> rgb = frame.mixed.empty() ? mixed(frame.layers, mix) : frame.mixed;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float>& plane = image.add(std::string(1, "RGB"[channel]));
    for (std::size_t pixel = 0; pixel < rgb.size(); ++pixel) plane[pixel] = rgb[pixel][channel];
  }
  return image;
}

DisplayedFrame tone_mapped(const Frame& frame, const LightMix& mix,
                           const DisplaySettings& settings) {
  const auto texels = [&](std::span<const glm::vec3> rgb) {
    return image::tone_mapped_texels(
        rgb, frame.layers.width,
        {false, settings.automatic_stops + settings.exposure, settings.view, settings.white});
  };
  return {frame.layers.width, frame.layers.height,
          frame.mixed.empty() ? texels(mixed(frame.layers, mix)) : texels(frame.mixed)};
}

/// Illuminances in their colours; of isolines and bands the rest is the picture.
DisplayedFrame false_coloured(const Frame& frame, const LightMix& mix,
                              const DisplaySettings& settings) {
  using report::Contours;
  const Contours contours = settings.false_colour.contours;
  const std::vector<float> values = mixed_illuminance(frame.layers, mix);
  DisplayedFrame result{frame.layers.width, frame.layers.height,
                        std::vector<std::uint8_t>(3 * values.size())};
  if (contours == Contours::lines || contours == Contours::bands) {
    result = tone_mapped(frame, mix, settings);
  }
  report::draw_false_colour(values, result.width, settings.false_colour, result.rgb);
  return result;
}

}  // namespace

std::vector<glm::vec3> scales_of(const LightMix& mix) {
  std::vector<glm::vec3> scales;
  for (const MixedLight& light : mix.lights) {
    scales.emplace_back(mix.power_in_picture(light) * glm::dvec3(light.tint));
  }
  return scales;
}

std::vector<float> mixed_illuminance(const LightLayers& layers, const LightMix& mix) {
  const auto width = static_cast<std::size_t>(layers.width);
  std::vector<float> result(width * static_cast<std::size_t>(layers.height));
  for_each_pixel(result.size(), [&](std::size_t pixel) {
    double sum = 0;
    for_each_light(layers, pixel % width, pixel / width,
                   [&](std::size_t light, float illuminance, const glm::vec3&) {
                     sum += mix.lumens_of(mix.lights[light]) * static_cast<double>(illuminance);
                   });
    result[pixel] = static_cast<float>(sum);
  });
  return result;
}

DisplayedFrame display(const Frame& frame, const LightMix& mix, const DisplaySettings& settings) {
  if (settings.mode == DisplayMode::illuminance && frame.mixed.empty()) {
    return false_coloured(frame, mix, settings);
  }
  DisplayedFrame result = tone_mapped(frame, mix, settings);
  // The first frames of the mode may not have any yet.
  if (settings.mode == DisplayMode::glare && frame.reflections) {
    image::draw_marks(
        image::find_glare(frame.layers, *frame.reflections, mix, settings.glare_limit).marks,
        result.rgb);
  }
  return result;
}

std::array<float, 3> white_of(const Frame& frame, const LightMix& mix) {
  if (frame.mixed.empty()) return image::white_of(frame.layers, mix);
  std::vector<double> powers;
  for (const MixedLight& light : mix.lights) powers.push_back(mix.lumens_of(light));
  return image::white_of_light(powers, mix);
}

double automatic_stops(const Frame& frame, const LightMix& mix) {
  return std::log2(automatic_exposure(root_of(frame, mix)));
}

std::vector<LightReading> readings_at(const Frame& frame, const LightMix& mix, int x, int y) {
  std::vector<LightReading> readings(mix.lights.size());
  if (!frame.mixed.empty() || x < 0 || y < 0 || x >= frame.layers.width || y >= frame.layers.height)
    return readings;
  // A layer holds the light of power 1: multiplied by the number of paths it is in proportion to
  // the number of photons.
  std::vector<double> photons(mix.lights.size());
  for_each_light(
      frame.layers, static_cast<std::size_t>(x), static_cast<std::size_t>(y),
      [&](std::size_t light, float illuminance, const glm::vec3& radiance) {
        const MixedLight& mixed = mix.lights[light];
        readings[light].luminance.value =
            mix.power_in_picture(mixed) * luminance(glm::dvec3(mixed.tint) * glm::dvec3(radiance));
        readings[light].illuminance.value = mix.lumens_of(mixed) * static_cast<double>(illuminance);
        if (light >= frame.noise.paths.size()) return;
        photons[light] = static_cast<double>(illuminance) * frame.noise.paths[light];
      });
  const double all = std::accumulate(photons.begin(), photons.end(), 0.0);
  for (std::size_t light = 0; light < readings.size(); ++light) {
    if (!(photons[light] > 0) || !(frame.noise.photons > 0)) continue;
    const double relative = 1 / std::sqrt(frame.noise.photons * photons[light] / all);
    for (Measured* part : {&readings[light].luminance, &readings[light].illuminance}) {
      part->standard_error = relative * part->value;
    }
  }
  return readings;
}

LightReading sum_of(std::span<const LightReading> readings) {
  const auto add = [](Measured& sum, const Measured& part) {
    sum.value += part.value;
    sum.standard_error = std::hypot(sum.standard_error, part.standard_error);
  };
  LightReading sum;
  for (const LightReading& reading : readings) {
    add(sum.luminance, reading.luminance);
    add(sum.illuminance, reading.illuminance);
  }
  return sum;
}

}  // namespace photile::view
