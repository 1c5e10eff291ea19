#include "render/film.hpp"

#include <tbb/parallel_for.h>

#include "render/reflected_radiance.hpp"
#include "render/sparse_film.hpp"

namespace photile {
namespace {

void add_hits(LightLayers::Layer& layer, std::size_t light, std::size_t light_count,
              const PrimaryHits& hits, const Estimates& estimates, float sample_weight) {
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const std::size_t index = hit * light_count + light;
    layer.radiance[hits.pixel[hit]] +=
        hits.throughput[hit] * reflected_radiance(hits, hit, estimates, index);
    layer.illuminance[hits.pixel[hit]] +=
        sample_weight * static_cast<float>(luminance(estimates.irradiance[index]));
  }
}

}  // namespace

void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const Estimates& estimates,
                 float sample_weight) {
  if (layers.sparse()) {
    add_to_sparse_film(layers, batch, estimates, sample_weight);
    return;
  }
  const std::size_t light_count = layers.layers.size();
  tbb::parallel_for(std::size_t{0}, light_count, [&](std::size_t light) {
    add_hits(layers.layers[light], light, light_count, batch.hits, estimates, sample_weight);
  });
  for (const SeenEmission& seen : batch.emission) {
    layers.layers[seen.light].radiance[seen.pixel] += seen.radiance;
    layers.layers[seen.light].illuminance[seen.pixel] += seen.illuminance;
  }
}

}  // namespace photile
