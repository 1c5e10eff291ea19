#include "render/film.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "light/light_at_points.hpp"
#include "light/pixel_light.hpp"
#include "light/row_sum.hpp"
#include "photile/scene.hpp"
#include "trace/hit_batch.hpp"

namespace photile {

namespace {

/// What a light gives to a pixel: values, or references to those of planes.
template <class Radiance, class Illuminance>
struct PixelLight {
  Radiance radiance;
  Illuminance illuminance;

  void add(const glm::vec3& seen, float arriving) {
    radiance += seen;
    illuminance += arriving;
  }
};
using PixelSums = light::RowSum<PixelLight<glm::vec3, float>>;

/// A pixel of dense layers, whose sums are its values themselves.
struct PixelOfPlanes {
  PixelLight<glm::vec3&, float&> of(std::size_t light) {
    return {layers[light].radiance[pixel], layers[light].illuminance[pixel]};
  }

  std::span<LightLayers::Layer> layers;
  std::size_t pixel;
};

/// Calls change(x, sums) for each pixel of a row, with what each light gives to it, and keeps what
/// the sums are then.
template <class Change>
void change_row(LightLayers& layers, std::size_t y, const Change& change) {
  const auto width = static_cast<std::size_t>(layers.width);
  if (!layers.sparse()) {
    PixelOfPlanes sums{layers.layers, y * width};
    for (std::size_t x = 0; x < width; ++x, ++sums.pixel) change(x, sums);
    return;
  }
  PixelSums sums(layers.layers.size());
  LightLayers::Row row;
  row.first.push_back(0);
  for (std::size_t x = 0; x < width; ++x) {
    for_each_light(layers, x, y,
                   [&](std::size_t light, float illuminance, const glm::vec3& radiance) {
                     sums.of(light).add(radiance, illuminance);
                   });
    change(x, sums);
    sums.take_lit([&](std::uint16_t light, const auto& sum) {
      row.light.push_back(light);
      row.radiance.push_back(sum.radiance);
      row.illuminance.push_back(sum.illuminance);
    });
    row.first.push_back(static_cast<std::uint32_t>(row.light.size()));
  }
  row.light.shrink_to_fit();
  row.radiance.shrink_to_fit();
  row.illuminance.shrink_to_fit();
  layers.rows[y] = std::move(row);
}

template <class Sums>
void add_hit(const PrimaryHits& hits, std::size_t hit, const LightTable& estimates,
             float sample_weight, Sums& sums) {
  const float weight = hits.fraction.empty() ? sample_weight : sample_weight * hits.fraction[hit];
  estimates.for_each(hit, [&](std::size_t light, std::size_t i) {
    sums.of(light).add(hits.throughput[hit] * light::reflected_radiance(hits, hit, estimates, i),
                       weight * static_cast<float>(luminance(estimates.irradiance[i])));
  });
}

}  // namespace

void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const LightTable& estimates,
                 float sample_weight) {
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
  tbb::parallel_for(first_row, end_row, [&](std::size_t y) {
    change_row(layers, y, [&](std::size_t x, auto& sums) {
      const std::size_t pixel = (y - first_row) * width + x;
      for (const std::uint32_t hit : hits.of(pixel)) {
        add_hit(batch.hits, hit, estimates, sample_weight, sums);
      }
      for (const std::uint32_t i : emission.of(pixel)) {
        const VisibleEmission& seen = batch.emission[i];
        sums.of(seen.light).add(seen.radiance, seen.illuminance);
      }
    });
  });
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
  tbb::parallel_for(std::size_t{0}, sums.size() / width, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      for_each_light(layers, x, y, [&](std::size_t light, float, const glm::vec3& radiance) {
        sums[y * width + x] += static_cast<float>(powers[light]) * radiance;
      });
    }
  });
  return sums;
}

void add_weighted(LightLayers& layers, int row, const LightLayers& from,
                  const RowWeights& weights) {
  const auto width = static_cast<std::size_t>(from.width);
  PixelSums found(layers.layers.size());
  change_row(layers, static_cast<std::size_t>(row), [&](std::size_t x, auto& sums) {
    for (std::uint32_t i = weights.first[x]; i < weights.first[x + 1]; ++i) {
      for_each_light(from, weights.pixel[i] % width, weights.pixel[i] / width,
                     [&](std::size_t light, float, const glm::vec3& radiance) {
                       found.of(light).add(weights.weight[i] * radiance, 0.0f);
                     });
    }
    found.take_lit([&](std::uint16_t light, const auto& mean) {
      sums.of(light).add(mean.radiance, mean.illuminance);
    });
  });
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

}  // namespace

void add_sample_errors(LightLayers& errors, const LightLayers& runs) {
  const auto count = static_cast<std::size_t>(runs.width / errors.width);
  if (count < 2) return;
  tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(errors.height), [&](std::size_t y) {
    light::RowSum<Scatter> scatter(errors.layers.size());
    change_row(errors, y, [&](std::size_t x, auto& sums) {
      for (std::size_t run = x * count; run < (x + 1) * count; ++run) {
        for_each_light(runs, run, y,
                       [&](std::size_t light, float illuminance, const glm::vec3& radiance) {
                         scatter.of(light).add(radiance, illuminance);
                       });
      }
      scatter.take_lit([&](std::uint16_t light, const Scatter& its) {
        // Standard errors of two sources that have nothing to do with each other, as one.
        auto&& error = sums.of(light);
        const glm::dvec4 own(error.radiance, error.illuminance);
        const glm::dvec4 both = glm::sqrt(own * own + its.variance(static_cast<double>(count)));
        error.radiance = glm::vec3(both);
        error.illuminance = static_cast<float>(both.w);
      });
    });
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
