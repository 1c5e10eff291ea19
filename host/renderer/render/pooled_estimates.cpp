#include "render/pooled_estimates.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "estimate/reflected_radiance.hpp"
#include "photile/scene.hpp"

namespace photile {
namespace {

constexpr std::size_t hits_per_task = 1024;

/// The sums of one hit, with room for every layer.
struct Sums {
  std::vector<glm::vec3> irradiance, radiance;
  std::vector<std::uint8_t> is_lit;

  explicit Sums(std::size_t layers) : irradiance(layers), radiance(layers), is_lit(layers) {}

  void clear() {
    std::fill(irradiance.begin(), irradiance.end(), glm::vec3(0.0f));
    std::fill(radiance.begin(), radiance.end(), glm::vec3(0.0f));
    std::fill(is_lit.begin(), is_lit.end(), std::uint8_t{0});
  }
};

void sum_hit(const LightPooling& pooling, const Estimates& estimates, std::size_t hit, Sums& sums) {
  sums.clear();
  estimate::for_each_estimate(estimates, hit, pooling.layer_of.size(),
                              [&](std::size_t light, std::size_t i) {
                                const std::uint32_t layer = pooling.layer_of[light];
                                const float scale = pooling.scale[light];
                                sums.irradiance[layer] += scale * estimates.irradiance[i];
                                if (!estimates.radiance.empty())
                                  sums.radiance[layer] += scale * estimates.radiance[i];
                                sums.is_lit[layer] = 1;
                              });
}

template <class Work>
void for_each_hit(std::size_t hits, std::size_t layers, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hits, hits_per_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      Sums sums(layers);
                      for (std::size_t hit = range.begin(); hit < range.end(); ++hit) {
                        work(hit, sums);
                      }
                    });
}

/// Where each hit's layers lie among those that any light reaches.
void place_layers(const LightPooling& pooling, const Estimates& estimates, std::size_t hits,
                  Estimates& result) {
  result.first.assign(hits + 1, 0);
  for_each_hit(hits, pooling.layers.size(), [&](std::size_t hit, Sums& sums) {
    sum_hit(pooling, estimates, hit, sums);
    result.first[hit + 1] = static_cast<std::uint64_t>(
        std::count(sums.is_lit.begin(), sums.is_lit.end(), std::uint8_t{1}));
  });
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.light.resize(result.first.back());
}

}  // namespace

Estimates pooled(const LightPooling& pooling, const Estimates& estimates, std::size_t hits) {
  const std::size_t layers = pooling.layers.size();
  const bool sparse = layers > max_dense_lights, glossy = !estimates.radiance.empty();
  Estimates result;
  if (sparse) place_layers(pooling, estimates, hits, result);
  result.irradiance.resize(sparse ? result.light.size() : hits * layers);
  if (glossy) result.radiance.resize(result.irradiance.size());
  for_each_hit(hits, layers, [&](std::size_t hit, Sums& sums) {
    sum_hit(pooling, estimates, hit, sums);
    std::size_t next = sparse ? static_cast<std::size_t>(result.first[hit]) : hit * layers;
    for (std::size_t layer = 0; layer < layers; ++layer) {
      if (sparse && sums.is_lit[layer] == 0) continue;
      if (sparse) result.light[next] = static_cast<std::uint16_t>(layer);
      result.irradiance[next] = sums.irradiance[layer];
      if (glossy) result.radiance[next] = sums.radiance[layer];
      ++next;
    }
  });
  return result;
}

void pool_emission(const LightPooling& pooling, PrimaryHitBatch& batch) {
  for (SeenEmission& seen : batch.emission) {
    const float scale = pooling.scale[seen.light];
    seen.radiance *= scale;
    seen.illuminance *= scale;
    seen.light = pooling.layer_of[seen.light];
  }
}

}  // namespace photile
