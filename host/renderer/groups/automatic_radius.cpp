#include "groups/automatic_radius.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/value_range.hpp"
#include "geometry/box.hpp"
#include "geometry/radix_sort.hpp"
#include "photile/errors.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::groups {

namespace {

constexpr int bits_of_axis = 10;
constexpr std::size_t boxes_at_a_time = 256;

struct CodedPhoton {
  std::uint32_t code, photon;
};

std::vector<CodedPhoton> along_curve(const std::vector<glm::vec3>& positions) {
  geometry::Box bounds;
  for (const glm::vec3& position : positions) bounds.extend(position);
  const glm::vec3 extent =
      glm::max(bounds.upper - bounds.lower, glm::vec3(std::numeric_limits<float>::min()));
  std::vector<CodedPhoton> coded(positions.size());
  tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t i) {
    const glm::vec3 fraction = glm::clamp((positions[i] - bounds.lower) / extent, 0.0f, 1.0f);
    const glm::uvec3 cell(fraction * static_cast<float>((1 << bits_of_axis) - 1));
    coded[i] = {static_cast<std::uint32_t>(geometry::morton_code(cell)),
                static_cast<std::uint32_t>(i)};
  });
  geometry::radix_sort(coded, 3 * bits_of_axis,
                       [](const CodedPhoton& photon) { return photon.code; });
  return coded;
}

/// The m-th smallest, m from 0 on; infinite where there are fewer.
float smallest(std::vector<float>& values, std::size_t m) {
  if (m >= values.size()) return std::numeric_limits<float>::infinity();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(m);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

PhotonBlocks::PhotonBlocks(const std::vector<glm::vec3>& positions, std::size_t most) {
  const std::size_t size = std::min(positions.size(), most);
  std::vector<glm::vec3> taken(size);
  for (std::size_t i = 0; i < size; ++i) {
    taken[i] = positions[spread_index(i, size, positions.size())];
  }
  const std::vector<CodedPhoton> coded = along_curve(taken);
  position_on_curve_.resize(size);
  for (std::size_t i = 0; i < size; ++i)
    position_on_curve_[coded[i].photon] = static_cast<std::uint32_t>(i);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float>& values = coordinate_[axis];
    for (const CodedPhoton& photon : coded) values.push_back(taken[photon.photon][axis]);
    for (std::size_t block = 0; block * block_size < size; ++block) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(block * block_size);
      const auto last = values.begin() + static_cast<std::ptrdiff_t>(end_of(block));
      const auto [low, high] = std::minmax_element(first, last);
      low_[axis].push_back(*low);
      high_[axis].push_back(*high);
    }
  }
}

float PhotonBlocks::squared_distance(std::size_t i, std::size_t m,
                                     std::vector<float>& scratch) const {
  const std::size_t own = position_on_curve_[i];
  const glm::vec3 query(coordinate_[0][own], coordinate_[1][own], coordinate_[2][own]);
  // No farther than the m-th of those near on the curve.
  const std::size_t window = 2 * m + block_size;
  scratch.clear();
  append_distances(query, own - std::min(own, window), std::min(own + window, size()), scratch);
  const float bound = smallest(scratch, m) * (1 + 1e-5f);  // room for rounding
  scratch.clear();
  const std::size_t blocks = low_[0].size();
  for (std::size_t first = 0; first < blocks; first += boxes_at_a_time) {
    std::array<float, boxes_at_a_time> gaps;
    const std::size_t count = std::min(boxes_at_a_time, blocks - first);
    find_squared_gaps(query, first, std::span(gaps).first(count));
    for (std::size_t j = 0; j < count; ++j) {
      if (!(gaps[j] <= bound)) continue;
      append_distances(query, (first + j) * block_size, end_of(first + j), scratch);
    }
  }
  return smallest(scratch, m);
}

void PhotonBlocks::find_squared_gaps(const glm::vec3& query, std::size_t first,
                                     std::span<float> gaps) const {
  std::fill(gaps.begin(), gaps.end(), 0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const float *low = low_[axis].data() + first, *high = high_[axis].data() + first;
    const float coordinate = query[axis];
    for (std::size_t j = 0; j < gaps.size(); ++j) {
      const float gap = std::max(low[j] - coordinate, coordinate - high[j]);
      gaps[j] += gap * std::max(0.0f, gap);
    }
  }
}

void PhotonBlocks::append_distances(const glm::vec3& query, std::size_t first, std::size_t last,
                                    std::vector<float>& distances) const {
  const float *x = coordinate_[0].data(), *y = coordinate_[1].data(), *z = coordinate_[2].data();
  const std::size_t before = distances.size();
  distances.resize(before + (last - first));
  float* const squared = distances.data() + before;
  for (std::size_t i = first; i < last; ++i) {
    const float dx = x[i] - query.x, dy = y[i] - query.y, dz = z[i] - query.z;
    squared[i - first] = dx * dx + dy * dy + dz * dz;
  }
}

}  // namespace photile::groups

namespace photile {

// The automatic search radius.
//
// Exact distances to the k-th of millions of photons would cost more than the default is worth. So
// the photons are thinned to a subsample, regularly over their order by oriented face, which keeps
// the share of every surface; in it the m-th nearest photon stands for the k-th, m = k x kept
// share. Photons on a surface are locally a Poisson process: pi rho r_k^2 has the distribution
// Gamma(k), so r_k^2 = r_m^2 x share x median of Gamma(k) / median of Gamma(m).
// With no more photons than the subsample holds, m = k and the distances are exact.
//
// Side and normal are not looked at: beside edges and on thin plates this finds a somewhat smaller
// distance than the estimate will, which the factor over the median covers.

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
  const double fraction =
      static_cast<double>(subsample.size()) / static_cast<double>(photons.total());
  const double rank =
      std::clamp(std::round(k * fraction), 1.0, static_cast<double>(subsample.size() - 1));
  // With fewer than k others this extrapolates from the farthest, as if its density went on.
  const double squared = median_squared_distance(subsample, static_cast<std::size_t>(rank)) *
                         fraction * gamma_median(k) / gamma_median(rank);
  if (!(squared > 0)) {
    throw UsageError(fmt::format(
        "automatic radius: most of the {} stored photons lie at the same points; give a radius",
        photons.total()));
  }
  return defaults::radius_over_median_kth_distance * std::sqrt(squared);
}

}  // namespace photile
