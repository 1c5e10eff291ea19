#include "render/film.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "light/light_at_points.hpp"
#include "light/row_sum.hpp"
#include "photile/scene.hpp"
#include "trace/hit_batch.hpp"

namespace photile {

namespace {

/// What a light gives to a pixel.
struct PixelLight {
  glm::vec3 radiance{0.0f};
  float illuminance = 0;

  void add(const glm::vec3& seen, float arriving) {
    radiance += seen;
    illuminance += arriving;
  }
};
using PixelSums = light::RowSum<PixelLight>;

/// Appends the pixel to a row; the next one begins.
void end_pixel(PixelSums& sums, LightLayers::Row& row) {
  sums.take_lit([&](std::uint16_t light, const PixelLight& sum) {
    row.light.push_back(light);
    row.radiance.push_back(sum.radiance);
    row.illuminance.push_back(sum.illuminance);
  });
  row.first.push_back(static_cast<std::uint32_t>(row.light.size()));
}

void add_row(const LightLayers::Row& row, std::size_t x, PixelSums& sums) {
  for (std::uint32_t i = row.first[x]; i < row.first[x + 1]; ++i) {
    sums.of(row.light[i]).add(row.radiance[i], row.illuminance[i]);
  }
}

/// The weight of a hit in the illuminance of its pixel.
float illuminance_weight(const PrimaryHits& hits, std::size_t hit, float sample_weight) {
  return hits.fraction.empty() ? sample_weight : sample_weight * hits.fraction[hit];
}

void add_hit(const PrimaryHits& hits, std::size_t hit, const LightTable& estimates,
             float sample_weight, PixelSums& sums) {
  const float weight = illuminance_weight(hits, hit, sample_weight);
  estimates.for_each(hit, [&](std::size_t light, std::size_t i) {
    sums.of(light).add(hits.throughput[hit] * light::reflected_radiance(hits, hit, estimates, i),
                       weight * static_cast<float>(luminance(estimates.irradiance[i])));
  });
}

/// Adds to layers of many lights; threads take rows of the picture.
void add_to_sparse_film(LightLayers& layers, const PrimaryHitBatch& batch,
                        const LightTable& estimates, float sample_weight) {
  std::uint32_t lowest = none, highest = 0;
  const auto widen = [&](std::uint32_t pixel) {
    lowest = std::min(lowest, pixel);
    highest = std::max(highest, pixel);
  };
  for (const std::uint32_t pixel : batch.hits.pixel) widen(pixel);
  for (const VisibleEmission& seen : batch.emission) widen(seen.pixel);
  if (lowest > highest) return;

  const auto width = static_cast<std::size_t>(layers.width);
  const std::size_t first_row = lowest / width, end_row = highest / width + 1;
  const std::size_t first_pixel = first_row * width, pixels = (end_row - first_row) * width;
  const IndexRows hits = trace::by_pixel(batch.hits.size(), first_pixel, pixels,
                                         [&](std::size_t i) { return batch.hits.pixel[i]; });
  const IndexRows emission =
      trace::by_pixel(batch.emission.size(), first_pixel, pixels,
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
        const VisibleEmission& seen = batch.emission[i];
        sums.of(seen.light).add(seen.radiance, seen.illuminance);
      }
      end_pixel(sums, row);
    }
    row.light.shrink_to_fit();
    row.radiance.shrink_to_fit();
    row.illuminance.shrink_to_fit();
    layers.rows[y] = std::move(row);
  });
}

/// Adds the hits whose pixel lies in [first, last), each with all of its lights, in their order.
void add_hits(LightLayers& layers, std::size_t first, std::size_t last, const PrimaryHits& hits,
              const LightTable& estimates, float sample_weight) {
  const std::size_t light_count = layers.layers.size();
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const std::size_t pixel = hits.pixel[hit];
    if (pixel < first || pixel >= last) continue;
    const float weight = illuminance_weight(hits, hit, sample_weight);
    for (std::size_t light = 0; light < light_count; ++light) {
      const std::size_t index = hit * light_count + light;
      LightLayers::Layer& layer = layers.layers[light];
      layer.radiance[pixel] +=
          hits.throughput[hit] * light::reflected_radiance(hits, hit, estimates, index);
      layer.illuminance[pixel] +=
          weight * static_cast<float>(luminance(estimates.irradiance[index]));
    }
  }
}

}  // namespace

void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const LightTable& estimates,
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
  for (const VisibleEmission& seen : batch.emission) {
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

std::vector<glm::vec3> mixed(const LightLayers& layers, std::span<const double> powers) {
  const auto width = static_cast<std::size_t>(layers.width);
  std::vector<glm::vec3> sums(width * static_cast<std::size_t>(layers.height), glm::vec3(0.0f));
  tbb::parallel_for(0, layers.height, [&](int y) {
    const std::size_t begin = static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x) {
      if (layers.sparse()) {
        const LightLayers::Row& row = layers.rows[static_cast<std::size_t>(y)];
        for (std::uint32_t i = row.first[x]; i < row.first[x + 1]; ++i) {
          sums[begin + x] += static_cast<float>(powers[row.light[i]]) * row.radiance[i];
        }
        continue;
      }
      for (std::size_t light = 0; light < powers.size(); ++light) {
        sums[begin + x] +=
            static_cast<float>(powers[light]) * layers.layers[light].radiance[begin + x];
      }
    }
  });
  return sums;
}

void add_weighted(LightLayers& layers, int row, const LightLayers& from,
                  const RowWeights& weights) {
  const auto y = static_cast<std::size_t>(row), width = static_cast<std::size_t>(layers.width);
  if (!layers.sparse()) {
    for (std::size_t light = 0; light < layers.layers.size(); ++light) {
      const std::vector<glm::vec3>& radiance = from.layers[light].radiance;
      for (std::size_t x = 0; x < width; ++x) {
        glm::vec3 sum(0.0f);
        for (std::uint32_t i = weights.first[x]; i < weights.first[x + 1]; ++i) {
          sum += weights.weight[i] * radiance[weights.pixel[i]];
        }
        layers.layers[light].radiance[y * width + x] += sum;
      }
    }
    return;
  }
  const auto from_width = static_cast<std::size_t>(from.width);
  PixelSums sums(layers.layers.size());
  LightLayers::Row with;
  with.first.push_back(0);
  for (std::size_t x = 0; x < width; ++x) {
    add_row(layers.rows[y], x, sums);
    for (std::uint32_t i = weights.first[x]; i < weights.first[x + 1]; ++i) {
      const LightLayers::Row& other = from.rows[weights.pixel[i] / from_width];
      const std::size_t column = weights.pixel[i] % from_width;
      for (std::uint32_t j = other.first[column]; j < other.first[column + 1]; ++j) {
        sums.of(other.light[j]).add(weights.weight[i] * other.radiance[j], 0.0f);
      }
    }
    end_pixel(sums, with);
  }
  layers.rows[y] = std::move(with);
}

namespace {

/// The scatter of the sums of a pixel's runs: red, green, blue, illuminance.
struct Scatter {
  glm::dvec4 sum{0.0}, squares{0.0};

  void add(const glm::vec3& radiance, float illuminance) {
    const glm::dvec4 value(radiance, illuminance);
    sum += value;
    squares += value * value;
  }
  /// Variance of `sum` over `runs` runs, where those that were not added are black: that of
  /// independent runs, less the part that is due to their being strata of one sequence.
  glm::dvec4 variance(double runs) const {
    const glm::dvec4 independent =
        glm::max(squares - sum * sum / runs, glm::dvec4(0.0)) * (runs / (runs - 1));
    return independent / std::sqrt(runs);
  }
};

/// Standard errors of two sources that have nothing to do with each other, as one.
void combine(glm::vec3& radiance, float& illuminance, const glm::dvec4& variance) {
  const glm::dvec4 own(radiance, illuminance);
  const glm::dvec4 both = glm::sqrt(own * own + variance);
  radiance = glm::vec3(both);
  illuminance = static_cast<float>(both.w);
}

void add_to_layer(LightLayers::Layer& errors, const LightLayers::Layer& runs, std::size_t count) {
  for (std::size_t pixel = 0; pixel < errors.radiance.size(); ++pixel) {
    Scatter scatter;
    for (std::size_t i = pixel * count; i < (pixel + 1) * count; ++i) {
      scatter.add(runs.radiance[i], runs.illuminance[i]);
    }
    combine(errors.radiance[pixel], errors.illuminance[pixel],
            scatter.variance(static_cast<double>(count)));
  }
}

/// A row of sparse layers: of each pixel the lights that either has.
LightLayers::Row with_scatter(const LightLayers::Row& errors, const LightLayers::Row& runs,
                              std::size_t count) {
  LightLayers::Row row;
  row.first.push_back(0);
  std::map<std::uint16_t, Scatter> scatter;
  for (std::size_t x = 0; x + 1 < errors.first.size(); ++x) {
    scatter.clear();
    for (std::uint32_t i = errors.first[x]; i < errors.first[x + 1]; ++i) scatter[errors.light[i]];
    for (std::uint32_t i = runs.first[x * count]; i < runs.first[(x + 1) * count]; ++i) {
      scatter[runs.light[i]].add(runs.radiance[i], runs.illuminance[i]);
    }
    std::uint32_t next = errors.first[x];
    for (const auto& [light, its] : scatter) {
      const bool known = next < errors.first[x + 1] && errors.light[next] == light;
      glm::vec3 radiance = known ? errors.radiance[next] : glm::vec3(0.0f);
      float illuminance = known ? errors.illuminance[next] : 0.0f;
      next += known ? 1 : 0;
      combine(radiance, illuminance, its.variance(static_cast<double>(count)));
      row.light.push_back(light);
      row.radiance.push_back(radiance);
      row.illuminance.push_back(illuminance);
    }
    row.first.push_back(static_cast<std::uint32_t>(row.light.size()));
  }
  return row;
}

}  // namespace

void add_sample_errors(LightLayers& errors, const LightLayers& runs) {
  const auto count = static_cast<std::size_t>(runs.width / errors.width);
  if (count < 2) return;
  if (errors.sparse()) {
    tbb::parallel_for(std::size_t{0}, errors.rows.size(), [&](std::size_t y) {
      errors.rows[y] = with_scatter(errors.rows[y], runs.rows[y], count);
    });
    return;
  }
  tbb::parallel_for(std::size_t{0}, errors.layers.size(), [&](std::size_t layer) {
    add_to_layer(errors.layers[layer], runs.layers[layer], count);
  });
}

namespace {

constexpr std::size_t hits_per_task = 1024;

}  // namespace

LightTable pooled(const LayerMixdown& mixdown, const LightTable& light) {
  const std::size_t layers = mixdown.layers.size();
  const bool glossy = !light.radiance.empty();
  const LightTable none(layers, layers > max_dense_lights);
  const auto write = [&](std::size_t first, std::size_t last, LightTable& rows) {
    light::RowSum<light::Reflection> sums(layers);
    for (std::size_t hit = first; hit < last; ++hit) {
      light.for_each(hit, [&](std::size_t from, std::size_t i) {
        const float scale = mixdown.scale[from];
        sums.of(mixdown.layer_of[from])
            .add(scale * light.irradiance[i], glossy ? scale * light.radiance[i] : glm::vec3(0.0f));
      });
      light::end_row(sums, rows, glossy);
    }
  };
  return light::rows_by_tasks(light.rows(), hits_per_task, none, write);
}

void pool_emission(const LayerMixdown& mixdown, PrimaryHitBatch& batch) {
  for (VisibleEmission& seen : batch.emission) {
    const float scale = mixdown.scale[seen.light];
    seen.radiance *= scale;
    seen.illuminance *= scale;
    seen.light = mixdown.layer_of[seen.light];
  }
}

}  // namespace photile
