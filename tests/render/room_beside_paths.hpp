// A room by photons and rays, beside the path tracer.
#pragma once

#include <catch2/catch.hpp>
#include <vector>

#include "pictures.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {

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

}  // namespace photile::test
