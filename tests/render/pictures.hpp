// What the tests of pictures share.
#pragma once

#include <cmath>
#include <cstring>

#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile::test {

/// A picture of so few photons and pixels that a test can render several.
inline RenderParameters small_picture(std::uint64_t photons, int width, int height,
                                      int samples = 2) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons;
  parameters.film.width = width;
  parameters.film.height = height;
  parameters.film.samples_per_pixel = samples;
  return parameters;
}

/// Looks into furnished_room.
inline Camera room_camera() {
  return Camera::look_at({3.6, 0.4, 1.6}, {1, 2, 0.9}, {0, 0, 1}, 1.1);
}

/// Looks straight down at a square of `side` metres around a point of the floor.
inline Camera above(double x, double y, double height, double side) {
  return Camera::look_at({x, y, height}, {x, y, 0}, {0, 1, 0}, 2 * std::atan(side / (2 * height)));
}

/// The values, in whichever form either has them.
inline bool same_bits(const LightLayers& a, const LightLayers& b) {
  if (a.sparse() || b.sparse()) return same_bits(a.dense(), b.dense());
  if (a.layers.size() != b.layers.size()) return false;
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    const auto& first = a.layers[i];
    const auto& second = b.layers[i];
    if (first.radiance.size() != second.radiance.size()) return false;
    if (std::memcmp(first.radiance.data(), second.radiance.data(),
                    first.radiance.size() * sizeof(glm::vec3)) != 0) {
      return false;
    }
    if (first.illuminance != second.illuminance) return false;
  }
  return true;
}

/// Means over the picture of one layer.
struct LayerMeans {
  double illuminance = 0, radiance = 0;

  explicit LayerMeans(const LightLayers::Layer& layer) {
    for (const float value : layer.illuminance) illuminance += value;
    for (const glm::vec3& value : layer.radiance) radiance += luminance(value);
    illuminance /= static_cast<double>(layer.illuminance.size());
    radiance /= static_cast<double>(layer.radiance.size());
  }
};

}  // namespace photile::test
