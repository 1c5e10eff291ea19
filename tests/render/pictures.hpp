// What the tests of pictures share.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "render/hit_source.hpp"
#include "render/render_session.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

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

/// Whether both layers of a furnished room with a floor of this material are those that paths see,
/// in the mean over a place beside a block.
inline void check_room(Scene room, const Material& floor, RenderParameters parameters,
                       double delta) {
  room.materials[0] = floor;
  const Camera camera = above(2.6, 2.2, 2.0, 0.4);
  std::vector<std::vector<double>> differences(4);
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    parameters.seed = seed;
    const LightLayers own = render(room, camera, device(), parameters).layers;
    PrimaryHitParameters film = eye_rays(parameters);
    film.samples_per_pixel = 1024;
    const LightLayers paths = trace_paths(room, camera, film).layers;
    for (std::size_t layer = 0; layer < 2; ++layer) {
      const LayerMeans mean(own.layers[layer]), truth(paths.layers[layer]);
      differences[2 * layer].push_back(mean.illuminance / truth.illuminance - 1);
      differences[2 * layer + 1].push_back(mean.radiance / truth.radiance - 1);
    }
  }
  for (const std::vector<double>& difference : differences) {
    CHECK_VERDICT(mean_is(difference, 0.0, delta));
  }
}

/// A picture whose rows are estimated a few at a time, as where many lights are pooled: in at least
/// 16 parts of rows where there are as many. Each layer is pooled into itself.
inline LightLayers picture_in_parts(const Scene& scene, const Camera& camera,
                                    const RenderParameters& parameters) {
  LayerMixdown itself;
  for (const LightGroup& group : light_groups_of(scene).groups) {
    itself.layer_of.push_back(static_cast<std::uint32_t>(itself.layers.size()));
    itself.layers.push_back(group.name);
    itself.scale.push_back(1.0f);
  }
  RenderSession session(std::make_shared<const PreparedScene>(scene), std::span(&device(), 1),
                        parameters, Progress::none());
  return session.render(camera_hits(camera), parameters.film, Progress::none(), &itself).layers;
}

}  // namespace photile::test
