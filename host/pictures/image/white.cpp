#include "image/white.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <sstream>
#include <vector>

#include "common/foreign_text.hpp"
#include "image/layer_set.hpp"
#include "image/light_layers.hpp"
#include "photile/errors.hpp"
#include "scene/light_emission.hpp"

namespace photile::image {

namespace {

constexpr const char* attribute = "photile.white";

glm::vec3 own_color(const MixedLight& light) { return light.color * light.tint; }

/// Whether what each lamp gives does not matter.
bool of_one_color(const LightMix& mix) {
  return std::all_of(mix.lights.begin(), mix.lights.end(), [&](const MixedLight& light) {
    return own_color(light) == own_color(mix.lights.front());
  });
}

White white_of_color(const glm::dvec3& color) {
  constexpr double least = 0.05;
  const glm::vec3 white(glm::max(color / luminance(color), least));
  return {white.r, white.g, white.b};
}

}  // namespace

White white_of_light(std::span<const double> illuminance, const LightMix& mix) {
  glm::dvec3 sum(0.0);
  for (std::size_t light = 0; light < illuminance.size(); ++light) {
    sum += illuminance[light] * glm::dvec3(own_color(mix.lights[light]));
  }
  return luminance(sum) > 0 ? white_of_color(sum) : White{1, 1, 1};
}

White white_of(const LightLayers& layers, const LightMix& mix) {
  std::vector<double> sums(mix.lights.size(), 1.0);
  if (of_one_color(mix)) return white_of_light(sums, mix);
  sums.assign(sums.size(), 0.0);
  const auto width = static_cast<std::size_t>(layers.width),
             height = static_cast<std::size_t>(layers.height);
  for (std::size_t pixel = 0; pixel < width * height; ++pixel) {
    for_each_light(layers, pixel % width, pixel / width,
                   [&](std::size_t light, float illuminance, const glm::vec3&) {
                     if (std::isfinite(illuminance)) sums[light] += double{illuminance};
                   });
  }
  for (std::size_t light = 0; light < sums.size(); ++light) {
    sums[light] *= mix.lumens_of(mix.lights[light]);
  }
  return white_of_light(sums, mix);
}

White white_of(const LayeredPicture& picture) {
  if (const auto kept = kept_white(picture.header())) return *kept;
  const LightMix mix = read_light_records(picture.header()).mix;
  std::vector<double> sums(mix.lights.size(), 1.0);
  if (of_one_color(mix)) return white_of_light(sums, mix);
  for (std::size_t light = 0; light < sums.size(); ++light) {
    const LightRows rows = picture.read(light, 0, picture.header().height);
    double sum = 0;
    const auto add = [&](double lux) {
      if (std::isfinite(lux) && lux > 0) sum += lux;
    };
    for (const float lux : rows.illuminance) add(double{lux});
    for (std::size_t i = 0; rows.illuminance.empty() && i < rows.rgb[0].size(); ++i) {
      add(luminance(glm::dvec3(rows.rgb[0][i], rows.rgb[1][i], rows.rgb[2][i])));
    }
    sums[light] = sum;
  }
  return white_of_light(sums, mix);
}

White white_of_temperature(double kelvin) {
  return white_of_color(scene::color_of_temperature(kelvin));
}

std::optional<White> kept_white(const PictureHeader& picture) {
  const auto kept = picture.attributes.find(attribute);
  if (kept == picture.attributes.end()) return std::nullopt;
  std::istringstream stream(kept->second);
  White white{};
  for (float& part : white) {
    if (stream >> part && std::isfinite(part) && part > 0) continue;
    throw InputError(fmt::format("the attribute {} is '{}'; three numbers above 0 are needed",
                                 attribute, one_line(kept->second)));
  }
  return white;
}

void keep_white(PictureHeader& picture, const White& white) {
  picture.attributes[attribute] = fmt::format("{} {} {}", white[0], white[1], white[2]);
}

}  // namespace photile::image
