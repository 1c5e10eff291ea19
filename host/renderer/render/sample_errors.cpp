#include "render/sample_errors.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>

namespace photile {
namespace {

/// The scatter of the sums of a pixel's runs: red, green, blue, illuminance.
struct Scatter {
  glm::dvec4 sum{0.0}, squares{0.0};

  void add(const glm::vec3& radiance, float illuminance) {
    const glm::dvec4 value(radiance, illuminance);
    sum += value;
    squares += value * value;
  }
  /// Variance of `sum` over so many runs, those that were not added being black: of independent
  /// runs, less what comes of their being strata of one sequence.
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

}  // namespace photile
