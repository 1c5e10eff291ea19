#include "tools/report/picture_comparison.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "image/layer_set.hpp"
#include "photile/errors.hpp"

namespace photile::image {
namespace {

/// The layers of a picture by light; none where it has none.
LayerSet layers_of(const Image& image) {
  try {
    return find_layers(image);
  } catch (const InputError&) {
    return {};
  }
}

std::optional<std::size_t> index_in(const LayerSet& layers, const std::string& light) {
  const auto& lights = layers.records.mix.lights;
  const auto found = std::find_if(lights.begin(), lights.end(),
                                  [&](const MixedLight& each) { return each.name == light; });
  if (found == lights.end()) return std::nullopt;
  return static_cast<std::size_t>(found - lights.begin());
}

/// A layer as a picture of its own.
Image layer_picture(const Image& image, const LayerChannels& channels) {
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

PictureComparison compare_pictures(const Image& a, const Image& b) {
  PictureComparison result;
  result.parts.push_back({"", picture_error(a, b)});
  const LayerSet of_a = layers_of(a), of_b = layers_of(b);
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

}  // namespace photile::image
