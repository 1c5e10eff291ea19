#include "photile/light_mix.hpp"

#include <utility>

#include "image/layered_picture.hpp"
#include "image/light_change.hpp"
#include "image/light_records.hpp"

namespace photile {
namespace {

/// A layer at a light's power and tint.
image::LightPlanes planes_at(const LightLayers::Layer& layer, const MixedLight& light,
                             double lumen_per_watt) {
  const std::size_t pixels = layer.radiance.size();
  const glm::vec3 scale(light.power * glm::dvec3(light.tint));
  image::LightPlanes planes;
  for (int component = 0; component < 3; ++component) {
    std::vector<float>& plane = planes.rgb[static_cast<std::size_t>(component)];
    plane.resize(pixels);
    if (scale[component] == 0.0f) continue;  // off means black, whatever the layer holds
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      plane[pixel] = layer.radiance[pixel][component] * scale[component];
    }
  }
  // The tint is not in it: it leaves the luminance that the light emits as it was.
  const double lumen_per_unit = light.unit == PowerUnit::lumen ? 1.0 : lumen_per_watt;
  const float lux_scale = static_cast<float>(light.power * lumen_per_unit);
  planes.illuminance.resize(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    planes.illuminance[pixel] = layer.illuminance[pixel] * lux_scale;
  }
  return planes;
}

}  // namespace

LightMix LightMix::of(const Scene& scene, double lumen_per_watt) {
  LightMix mix;
  mix.lumen_per_watt = lumen_per_watt;
  for (const Light& light : scene.lights) {
    MixedLight mixed;
    mixed.name = light.name;
    mixed.power = light.power;
    mixed.unit = scene.unit;
    mixed.color = light.color;
    mix.lights.push_back(std::move(mixed));
  }
  return mix;
}

Image mix_layers(const LightLayers& layers, const LightMix& mix) {
  if (layers.sparse()) return mix_layers(layers.dense(), mix);
  Image picture;
  picture.width = layers.width;
  picture.height = layers.height;
  image::LightRecords records;
  records.mix.lumen_per_watt = mix.lumen_per_watt;
  std::vector<std::string> names;
  std::vector<image::LightPlanes> planes;
  for (const LightLayers::Layer& layer : layers.layers) {
    const MixedLight& light = mix.lights[image::index_of(mix, layer.light)];
    names.push_back(light.name);
    planes.push_back(planes_at(layer, light, mix.lumen_per_watt));
    records.mix.lights.push_back(light);
  }
  const std::size_t pixels =
      static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  image::set_layered_channels(picture, names, std::move(planes), std::vector<float>(pixels, 1.0f));
  image::write_light_records(picture, records);
  return picture;
}

}  // namespace photile
