#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>

#include "cache/surface_cache.hpp"
#include "photile/defaults.hpp"
#include "photile/scene.hpp"
#include "trace/hit_batch.hpp"

namespace photile::cache {
namespace {

/// Hits of a pixel that are compared with each other, at most.
constexpr std::size_t most_compared = 64;

/// The relative noise of photons in a pixel's reflections that is not visible: about that which
/// rays of lobes leave. Less than that of 100 photons, so that what mirrors of metal show is clean.
constexpr double tolerated_noise = 0.09;

/// Estimates on surface nearer to the reflecting surface than this, in widths of the estimate,
/// would show their blur there, as on a bright wall behind a sconce of brass. A reflection that is
/// less than this part of all light of a pixel does not show.
constexpr double near_widths = 2, faint_reflection = 0.4;

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t pixels_per_task = 64;

/// The weight of the light at a hit, if all surfaces receive the same.
double weight_of(const PrimaryHits& hits, std::size_t hit) {
  return luminance(glm::dvec3(hits.throughput[hit] * hits.diffuse_albedo[hit]));
}

double sum_of_weights(const PrimaryHits& hits, std::span<const std::uint32_t> chosen) {
  double sum = 0;
  for (const std::uint32_t hit : chosen) sum += weight_of(hits, hit);
  return sum;
}

/// The variance of the weighted mean over some hits, of those of one hit: 1 where all err
/// alike, less where they lie farther apart.
double relative_variance(const PrimaryHits& hits, std::span<const std::uint32_t> chosen,
                         double width) {
  const std::size_t step = (chosen.size() + most_compared - 1) / most_compared;
  double weights = 0, variance = 0;
  for (std::size_t i = 0; i < chosen.size(); i += step) {
    const double own = weight_of(hits, chosen[i]);
    weights += own;
    for (std::size_t j = 0; j < chosen.size(); j += step) {
      const double apart = glm::distance(hits.position[chosen[i]], hits.position[chosen[j]]);
      variance += own * weight_of(hits, chosen[j]) * std::max(0.0, 1 - apart / width);
    }
  }
  return weights > 0 ? variance / (weights * weights) : 0.0;
}

/// Whether one of these lies within this distance of a position.
bool any_near(const PrimaryHits& hits, std::span<const std::uint32_t> chosen,
              const glm::vec3& position, double near) {
  return std::any_of(chosen.begin(), chosen.end(), [&](std::uint32_t hit) {
    return double{glm::distance(hits.position[hit], position)} < near;
  });
}

}  // namespace

std::vector<std::uint8_t> suits_photons(const PrimaryHits& seen, const PrimaryHits& reflected,
                                        int runs, const PhotonNoise& noise) {
  std::vector<std::uint8_t> suits(reflected.size(), 0);
  if (reflected.size() == 0) return suits;
  const auto [low, high] = std::minmax_element(reflected.pixel.begin(), reflected.pixel.end());
  const auto count = static_cast<std::size_t>(runs);
  const std::size_t first = *low / count, pixels = *high / count - first + 1;
  const IndexRows hits_of = trace::by_pixel(
      reflected.size(), first, pixels, [&](std::size_t i) { return reflected.pixel[i] / count; });
  const IndexRows seen_of = rows_of(pixels, [&](const auto& put) {
    for (std::uint32_t hit = 0; hit < seen.size(); ++hit) {
      const std::size_t pixel = seen.pixel[hit] / count;
      if (pixel >= first && pixel < first + pixels) put(pixel - first, hit);
    }
  });
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, pixels, pixels_per_task),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
          const std::span<const std::uint32_t> hits = hits_of.of(pixel);
          const std::span<const std::uint32_t> shown_by = seen_of.of(pixel);
          const double weight = sum_of_weights(reflected, hits);
          const double all = weight + sum_of_weights(seen, shown_by);
          const double tolerated = tolerated_noise * all;
          const double of_estimates = weight * noise.noise;
          if (of_estimates > tolerated &&
              of_estimates * std::sqrt(relative_variance(reflected, hits, noise.width)) >
                  tolerated) {
            continue;
          }
          const double near = weight > faint_reflection * all ? near_widths * noise.width : 0.0;
          for (const std::uint32_t hit : hits) {
            suits[hit] = any_near(seen, shown_by, reflected.position[hit], near) ? 0 : 1;
          }
        }
      });
  return suits;
}

}  // namespace photile::cache
