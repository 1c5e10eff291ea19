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

#include "common/value_range.hpp"
#include "groups/photon_blocks.hpp"
#include "photile/errors.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile {
namespace {

constexpr std::size_t max_queries = 1024;  ///< photons whose k-th neighbour is looked for

/// Median of the Gamma distribution of shape k and scale 1 (Choi 1994; 0.9% low for k = 1, less for
/// others).
double gamma_median(double k) { return k - 1.0 / 3.0 + 8.0 / (405.0 * k); }

/// Median over the queries of the squared distance to the m-th other photon of the subsample. The
/// queries are members of the subsample: each is its own nearest.
double median_squared_distance(const groups::PhotonBlocks& photons, std::size_t m) {
  std::vector<float> squared(std::min(photons.size(), max_queries));
  tbb::enumerable_thread_specific<std::vector<float>> scratch;
  tbb::parallel_for(std::size_t{0}, squared.size(), [&](std::size_t i) {
    squared[i] = photons.squared_distance(groups::spread_index(i, squared.size(), photons.size()),
                                          m, scratch.local());
  });
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  return *middle;
}

}  // namespace

double automatic_radius(const Photons& photons, int k) {
  check_setting("neighbours", setting_value(k));
  if (photons.total() < 2) {
    throw UsageError(
        fmt::format("automatic radius: {} photons were stored, at least 2 are needed; "
                    "emit more photons or give a radius",
                    photons.total()));
  }
  const groups::PhotonBlocks subsample(photons.of_all ? photons.of_all->spread : photons.position,
                                       groups::max_subsample);
  const double share = static_cast<double>(subsample.size()) / static_cast<double>(photons.total());
  const double rank =
      std::clamp(std::round(k * share), 1.0, static_cast<double>(subsample.size() - 1));
  // With fewer than k others this extrapolates from the farthest, as if its density went on.
  const double squared = median_squared_distance(subsample, static_cast<std::size_t>(rank)) *
                         share * gamma_median(k) / gamma_median(rank);
  if (!(squared > 0)) {
    throw UsageError(
        fmt::format("automatic radius: most of the {} stored photons lie in the same "
                    "points; give a radius",
                    photons.total()));
  }
  return defaults::radius_over_median_kth_distance * std::sqrt(squared);
}

}  // namespace photile
