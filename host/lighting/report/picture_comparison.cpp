#include "report/picture_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "image/layer_set.hpp"
#include "photile/errors.hpp"
#include "photile/light_mix.hpp"
#include "report/false_colour_picture.hpp"

namespace photile::report {
namespace {

/// The layers of a picture by light; none where it has none.
image::LayerSet layers_of(const Image& image) {
  try {
    return image::find_layers(image);
  } catch (const InputError&) {
    return {};
  }
}

std::optional<std::size_t> index_in(const image::LayerSet& layers, const std::string& light) {
  const auto& lights = layers.records.mix.lights;
  const auto found = std::find_if(lights.begin(), lights.end(),
                                  [&](const MixedLight& each) { return each.name == light; });
  if (found == lights.end()) return std::nullopt;
  return static_cast<std::size_t>(found - lights.begin());
}

/// A layer as a picture of its own.
Image layer_picture(const Image& image, const image::LayerChannels& channels) {
  constexpr std::array names{"R", "G", "B"};
  Image layer;
  layer.width = image.width;
  layer.height = image.height;
  for (std::size_t i = 0; i < names.size(); ++i) {
    layer.add(names[i]) = image.channels[channels.rgb[i]];
  }
  return layer;
}

}  // namespace

namespace {

constexpr double high_percentile = 0.95;

double quantile(std::vector<float>& values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return static_cast<double>(*place);
}

void add_levels(const std::string& what, const std::string& unit, std::vector<float> a,
                std::vector<float> b, LevelComparison& result) {
  const auto mean = [](const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += static_cast<double>(value);
    return sum / static_cast<double>(std::max<std::size_t>(1, values.size()));
  };
  if (a.empty() || b.empty()) return;
  result.levels.push_back({what + ", mean", unit, mean(a), mean(b)});
  result.levels.push_back({what + ", median", unit, quantile(a, 0.5), quantile(b, 0.5)});
  result.levels.push_back(
      {what + ", 95% below", unit, quantile(a, high_percentile), quantile(b, high_percentile)});
}

/// Illuminance of the pixels that see a surface in either picture; empty where it is not known.
std::vector<float> surface_illuminance(const LayeredPicture& picture) {
  try {
    return illuminance_of(picture);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

LevelComparison compare_levels(const LayeredPicture& a, const LayeredPicture& b,
                               const PictureHeader& header_a, const PictureHeader& header_b) {
  if (a.header().width != b.header().width || a.header().height != b.header().height) {
    throw UsageError("the pictures differ in size; render them with the same --size");
  }
  LevelComparison result;
  add_levels("luminance", "cd/m2", luminance_of(a.root()), luminance_of(b.root()), result);
  add_levels("illuminance", "lux", surface_illuminance(a), surface_illuminance(b), result);
  const LightMix of_a = read_light_mix(header_a), of_b = read_light_mix(header_b);
  for (const MixedLight& light : of_a.lights) {
    const auto other = std::find_if(of_b.lights.begin(), of_b.lights.end(),
                                    [&](const auto& each) { return each.name == light.name; });
    if (other == of_b.lights.end()) continue;
    result.powers.push_back({light.name, light.power, other->power, light.unit});
  }
  return result;
}

bool lights_differ(const PictureHeader& a, const PictureHeader& b) {
  try {
    const LightMix of_a = read_light_mix(a), of_b = read_light_mix(b);
    for (const MixedLight& light : of_a.lights) {
      for (const MixedLight& other : of_b.lights) {
        if (light.name != other.name) continue;
        const double larger = std::max(light.power, other.power);
        if (std::abs(light.power - other.power) > 1e-6 * larger) return true;
        if (glm::length(light.tint - other.tint) > 1e-4f) return true;
      }
    }
  } catch (const InputError&) {  // no lights
  }
  return false;
}

PictureComparison compare_pictures(const Image& a, const Image& b) {
  PictureComparison result;
  result.parts.push_back({"", picture_error(a, b)});
  const image::LayerSet of_a = layers_of(a), of_b = layers_of(b);
  for (std::size_t i = 0; i < of_a.channels.size(); ++i) {
    const std::string& light = of_a.records.mix.lights[i].name;
    const auto other = index_in(of_b, light);
    if (!other) {
      result.only_a.push_back(light);
      continue;
    }
    ComparedPart part{light, std::nullopt};
    try {
      part.error = picture_error(layer_picture(a, of_a.channels[i]),
                                 layer_picture(b, of_b.channels[*other]));
    } catch (const InputError&) {  // b is black: off, say
    }
    result.parts.push_back(std::move(part));
  }
  for (const MixedLight& light : of_b.records.mix.lights) {
    if (!index_in(of_a, light.name)) result.only_b.push_back(light.name);
  }
  return result;
}

}  // namespace photile::report
