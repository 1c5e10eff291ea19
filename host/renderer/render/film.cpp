#include "render/film.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <vector>

#include "estimate/reflected_radiance.hpp"
#include "trace/hit_batch.hpp"

namespace photile {
namespace {

/// The sums of one pixel, with room for every light.
class PixelSums {
 public:
  explicit PixelSums(std::size_t lights)
      : radiance_(lights, glm::vec3(0.0f)), illuminance_(lights), is_lit_(lights) {}

  void add(std::uint32_t light, const glm::vec3& radiance, float illuminance) {
    if (!is_lit_[light]) {
      is_lit_[light] = 1;
      lit_.push_back(static_cast<std::uint16_t>(light));
    }
    radiance_[light] += radiance;
    illuminance_[light] += illuminance;
  }

  /// Appends the lights that were added to a row, and forgets them.
  void move_to(LightLayers::Row& row) {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t light : lit_) {
      row.light.push_back(light);
      row.radiance.push_back(radiance_[light]);
      row.illuminance.push_back(illuminance_[light]);
      radiance_[light] = glm::vec3(0.0f);
      illuminance_[light] = 0.0f;
      is_lit_[light] = 0;
    }
    lit_.clear();
    row.first.push_back(static_cast<std::uint32_t>(row.light.size()));
  }

 private:
  std::vector<glm::vec3> radiance_;
  std::vector<float> illuminance_;
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

void add_row(const LightLayers::Row& row, std::size_t x, PixelSums& sums) {
  for (std::uint32_t i = row.first[x]; i < row.first[x + 1]; ++i) {
    sums.add(row.light[i], row.radiance[i], row.illuminance[i]);
  }
}

/// What a hit counts in the illuminance of its pixel.
float illuminance_weight(const PrimaryHits& hits, std::size_t hit, float sample_weight) {
  return hits.share.empty() ? sample_weight : sample_weight * hits.share[hit];
}

void add_hit(const PrimaryHits& hits, std::size_t hit, const Estimates& estimates,
             float sample_weight, PixelSums& sums) {
  const float weight = illuminance_weight(hits, hit, sample_weight);
  for (std::uint64_t i = estimates.first[hit]; i < estimates.first[hit + 1]; ++i) {
    sums.add(estimates.light[i],
             hits.throughput[hit] * estimate::reflected_radiance(hits, hit, estimates, i),
             weight * static_cast<float>(luminance(estimates.irradiance[i])));
  }
}

/// For layers and estimates of many lights: work is shared by rows.
void add_to_sparse_film(LightLayers& layers, const PrimaryHitBatch& batch,
                        const Estimates& estimates, float sample_weight) {
  std::uint32_t lowest = none, highest = 0;
  const auto widen = [&](std::uint32_t pixel) {
    lowest = std::min(lowest, pixel);
    highest = std::max(highest, pixel);
  };
  for (const std::uint32_t pixel : batch.hits.pixel) widen(pixel);
  for (const SeenEmission& seen : batch.emission) widen(seen.pixel);
  if (lowest > highest) return;

  const auto width = static_cast<std::size_t>(layers.width);
  const std::size_t first_row = lowest / width, end_row = highest / width + 1;
  const std::size_t first_pixel = first_row * width, pixels = (end_row - first_row) * width;
  const trace::ByPixel hits(batch.hits.size(), first_pixel, pixels,
                            [&](std::size_t i) { return batch.hits.pixel[i]; });
  const trace::ByPixel emission(batch.emission.size(), first_pixel, pixels,
                                [&](std::size_t i) { return batch.emission[i].pixel; });
  tbb::enumerable_thread_specific<PixelSums> sums_of_threads(layers.layers.size());
  tbb::parallel_for(first_row, end_row, [&](std::size_t y) {
    PixelSums& sums = sums_of_threads.local();
    LightLayers::Row row;
    row.first.push_back(0);
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t pixel = (y - first_row) * width + x;
      add_row(layers.rows[y], x, sums);
      for (const std::uint32_t hit : hits.of(pixel)) {
        add_hit(batch.hits, hit, estimates, sample_weight, sums);
      }
      for (const std::uint32_t i : emission.of(pixel)) {
        const SeenEmission& seen = batch.emission[i];
        sums.add(seen.light, seen.radiance, seen.illuminance);
      }
      sums.move_to(row);
    }
    row.light.shrink_to_fit();
    row.radiance.shrink_to_fit();
    row.illuminance.shrink_to_fit();
    layers.rows[y] = std::move(row);
  });
}

/// Adds the hits whose pixel lies in [first, last), each with all of its lights, in their order.
void add_hits(LightLayers& layers, std::size_t first, std::size_t last, const PrimaryHits& hits,
              const Estimates& estimates, float sample_weight) {
  const std::size_t light_count = layers.layers.size();
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const std::size_t pixel = hits.pixel[hit];
    if (pixel < first || pixel >= last) continue;
    const float weight = illuminance_weight(hits, hit, sample_weight);
    for (std::size_t light = 0; light < light_count; ++light) {
      const std::size_t index = hit * light_count + light;
      LightLayers::Layer& layer = layers.layers[light];
      layer.radiance[pixel] +=
          hits.throughput[hit] * estimate::reflected_radiance(hits, hit, estimates, index);
      layer.illuminance[pixel] +=
          weight * static_cast<float>(luminance(estimates.irradiance[index]));
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

void raise_to_zero(LightLayers& layers) {
  const auto raise = [](std::vector<glm::vec3>& radiance) {
    for (glm::vec3& value : radiance) value = glm::max(value, glm::vec3(0.0f));
  };
  for (LightLayers::Layer& layer : layers.layers) raise(layer.radiance);
  for (LightLayers::Row& row : layers.rows) raise(row.radiance);
}

}  // namespace photile
