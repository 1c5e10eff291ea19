#include "render/film.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "render/reflected_radiance.hpp"
#include "render/sparse_film.hpp"

namespace photile {
namespace {

/// Adds the hits whose pixel lies in [first, last), each with all of its lights, in their order.
void add_hits(LightLayers& layers, std::size_t first, std::size_t last, const PrimaryHits& hits,
              const Estimates& estimates, float sample_weight) {
  const std::size_t light_count = layers.layers.size();
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const std::size_t pixel = hits.pixel[hit];
    if (pixel < first || pixel >= last) continue;
    for (std::size_t light = 0; light < light_count; ++light) {
      const std::size_t index = hit * light_count + light;
      LightLayers::Layer& layer = layers.layers[light];
      layer.radiance[pixel] +=
          hits.throughput[hit] * reflected_radiance(hits, hit, estimates, index);
      layer.illuminance[pixel] +=
          sample_weight * static_cast<float>(luminance(estimates.irradiance[index]));
    }
  }
}

}  // namespace

void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const Estimates& estimates,
                 float sample_weight) {
  if (layers.sparse()) {
    add_to_sparse_film(layers, batch, estimates, sample_weight);
    return;
  }
  // A band of pixels for each thread: a hit's lights are read once, and what a pixel sums up, in
  // which order, does not depend on the number of bands.
  const std::size_t pixels =
      static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  const auto bands = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_for(std::size_t{0}, bands, [&](std::size_t band) {
    add_hits(layers, band * pixels / bands, (band + 1) * pixels / bands, batch.hits, estimates,
             sample_weight);
  });
  for (const SeenEmission& seen : batch.emission) {
    layers.layers[seen.light].radiance[seen.pixel] += seen.radiance;
    layers.layers[seen.light].illuminance[seen.pixel] += seen.illuminance;
  }
}

}  // namespace photile
