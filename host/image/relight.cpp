#include <fmt/format.h>

#include <utility>

#include "image/layer_set.hpp"
#include "image/layered_picture.hpp"
#include "image/light_change.hpp"
#include "photile/errors.hpp"
#include "photile/light_mix.hpp"

namespace photile {
namespace {

/// new / old, where the old value is what the picture was multiplied with.
/// Errors: UsageError when nothing is left to multiply.
double ratio(double now, double before, const std::string& light) {
  if (now == before) return 1.0;  // keeps the bits, and 0 of 0
  if (before == 0.0) {
    throw UsageError(fmt::format(
        "light '{}' is off in the picture, or lacks a colour there, and cannot be turned up; "
        "render it with some power",
        light));
  }
  return now / before;
}

std::vector<float> scaled(const std::vector<float>& plane, double factor) {
  const float scale = static_cast<float>(factor);
  if (scale == 0.0f) return std::vector<float>(plane.size());  // off, whatever the layer holds
  std::vector<float> result(plane);
  if (scale == 1.0f) return result;
  for (float& value : result) value *= scale;
  return result;
}

/// The planes of one light in the picture, brought from `before` to `now`.
image::LightPlanes relit(const Image& picture, const image::LayerChannels& channels,
                         const MixedLight& before, const MixedLight& now) {
  image::LightPlanes planes;
  for (int component = 0; component < 3; ++component) {
    const std::size_t i = static_cast<std::size_t>(component);
    planes.rgb[i] = scaled(
        picture.channels[channels.rgb[i]],
        ratio(now.power * now.tint[component], before.power * before.tint[component], now.name));
  }
  if (channels.illuminance) {
    planes.illuminance =
        scaled(picture.channels[*channels.illuminance], ratio(now.power, before.power, now.name));
  }
  return planes;
}

void apply_to_picture(image::LightRecords& records, const std::vector<LightChange>& changes) {
  for (const LightChange& change : changes) {
    MixedLight& light = records.mix.lights[image::index_of(records.mix, change.name)];
    const image::Request request = image::understand(change);
    if (std::holds_alternative<image::SetPower>(request) && records.relative.contains(light.name)) {
      throw UsageError(
          fmt::format("light '{}': the picture does not say its power; use xFACTOR, #RRGGBB or off",
                      light.name));
    }
    image::apply(light, request, records.mix.lumen_per_watt);
  }
}

}  // namespace

Image relight(const Image& layered, const std::vector<LightChange>& changes) {
  const image::LayerSet before = image::find_layers(layered);
  image::LightRecords now = before.records;
  apply_to_picture(now, changes);

  Image picture;
  picture.width = layered.width;
  picture.height = layered.height;
  picture.attributes = layered.attributes;
  picture.matrices = layered.matrices;
  picture.numbers = layered.numbers;
  std::vector<std::string> names;
  std::vector<image::LightPlanes> planes;
  for (std::size_t i = 0; i < now.mix.lights.size(); ++i) {
    names.push_back(now.mix.lights[i].name);
    planes.push_back(
        relit(layered, before.channels[i], before.records.mix.lights[i], now.mix.lights[i]));
  }
  const std::vector<float>* alpha = layered.find("A");
  const std::size_t pixels =
      static_cast<std::size_t>(layered.width) * static_cast<std::size_t>(layered.height);
  image::set_layered_channels(picture, names, std::move(planes),
                              alpha ? *alpha : std::vector<float>(pixels, 1.0f));
  image::write_light_records(picture, now);
  return picture;
}

LightMix read_light_mix(const Image& layered) { return image::find_layers(layered).records.mix; }

}  // namespace photile
