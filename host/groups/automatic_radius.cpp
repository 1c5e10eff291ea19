// The automatic search radius.
//
// Exact distances to the k-th of millions of photons would cost more than the default is worth. So
// the photons are thinned to a subsample, regularly over their order by sided triangle, which keeps
// the share of every surface; in it the m-th nearest photon stands for the k-th, m = k x kept
// share. Photons on a surface are locally a Poisson process: pi rho r_k^2 has the distribution
// Gamma(k), so r_k^2 = r_m^2 x share x median of Gamma(k) / median of Gamma(m).
// With no more photons than the subsample holds, m = k and the distances are exact.
//
// Side and normal are not looked at: beside edges and on thin plates this finds a somewhat smaller
// distance than the estimate will, which the factor over the median covers.
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile {
namespace {

constexpr std::size_t max_queries = 1024;        ///< photons whose k-th neighbour is looked for
constexpr std::size_t max_subsample = 1u << 18;  ///< photons looked at for each

/// Median of the Gamma distribution of shape k and scale 1 (Choi 1994; 0.9% low for k = 1, less for
/// others).
double gamma_median(double k) { return k - 1.0 / 3.0 + 8.0 / (405.0 * k); }

/// Index of the i-th of `count` samples spread over `size` elements, each in the middle of its
/// share.
std::size_t spread_index(std::size_t i, std::size_t count, std::size_t size) {
  return (2 * i + 1) * size / (2 * count);
}

/// Structure of arrays, so that the distance loop runs in vectors.
struct Subsample {
  std::vector<float> x, y, z;
  std::size_t size() const { return x.size(); }
};

Subsample thin(const std::vector<glm::vec3>& positions) {
  const std::size_t size = std::min(positions.size(), max_subsample);
  Subsample result;
  for (std::vector<float>* axis : {&result.x, &result.y, &result.z}) axis->resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const glm::vec3& p = positions[spread_index(i, size, positions.size())];
    result.x[i] = p.x, result.y[i] = p.y, result.z[i] = p.z;
  }
  return result;
}

void squared_distances(const Subsample& photons, const glm::vec3& query, std::vector<float>& out) {
  const float *x = photons.x.data(), *y = photons.y.data(), *z = photons.z.data();
  float* squared = out.data();
  const std::size_t size = photons.size();
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = x[i] - query.x, dy = y[i] - query.y, dz = z[i] - query.z;
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
}

/// The m-th smallest value, m from 1 on. A few values are kept in a heap: most of the others are
/// then refused by one comparison.
float mth_smallest(std::vector<float>& values, std::size_t m) {
  constexpr std::size_t largest_heap = 4096;
  if (m > largest_heap) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(m - 1),
                     values.end());
    return values[m - 1];
  }
  const auto heap_end = values.begin() + static_cast<std::ptrdiff_t>(m);
  std::make_heap(values.begin(), heap_end);
  for (auto value = heap_end; value != values.end(); ++value) {
    if (*value >= values.front()) continue;
    std::pop_heap(values.begin(), heap_end);
    *std::prev(heap_end) = *value;
    std::push_heap(values.begin(), heap_end);
  }
  return values.front();
}

/// Median over the queries of the squared distance to the m-th other photon of the subsample. The
/// queries are members of the subsample: each is its own nearest.
double median_squared_distance(const Subsample& photons, std::size_t m) {
  std::vector<float> squared(std::min(photons.size(), max_queries));
  tbb::enumerable_thread_specific<std::vector<float>> scratch(photons.size());
  tbb::parallel_for(std::size_t{0}, squared.size(), [&](std::size_t i) {
    const std::size_t query = spread_index(i, squared.size(), photons.size());
    std::vector<float>& distances = scratch.local();
    squared_distances(photons, {photons.x[query], photons.y[query], photons.z[query]}, distances);
    squared[i] = mth_smallest(distances, m + 1);
  });
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  return *middle;
}

}  // namespace

double automatic_radius(const Photons& photons, int k) {
  if (k < 1 || k > limits::max_neighbours) {
    throw UsageError(
        fmt::format("neighbours: {} is out of range; give 1 to {}", k, limits::max_neighbours));
  }
  if (photons.size() < 2) {
    throw UsageError(
        fmt::format("automatic radius: {} photons were stored, at least 2 are needed; "
                    "emit more photons or give a radius",
                    photons.size()));
  }
  const Subsample subsample = thin(photons.position);
  const double share = static_cast<double>(subsample.size()) / static_cast<double>(photons.size());
  const double rank =
      std::clamp(std::round(k * share), 1.0, static_cast<double>(subsample.size() - 1));
  // With fewer than k others this extrapolates from the farthest, as if its density went on.
  const double squared = median_squared_distance(subsample, static_cast<std::size_t>(rank)) *
                         share * gamma_median(k) / gamma_median(rank);
  if (!(squared > 0)) {
    throw UsageError(
        fmt::format("automatic radius: most of the {} stored photons lie in the same "
                    "points; give a radius",
                    photons.size()));
  }
  return defaults::radius_over_median_kth_distance * std::sqrt(squared);
}

}  // namespace photile
