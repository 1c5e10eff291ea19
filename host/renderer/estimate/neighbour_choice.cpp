#include "estimate/neighbour_choice.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "photile/scene.hpp"

namespace photile::estimate {
namespace {

/// Levels differ by this factor in k.
constexpr int level_factor = 4;

/// Differences of more than this many standard deviations of their noise are bias. A larger number
/// would let blur through, a smaller one noise.
constexpr double tolerated_deviations = 3.0;

/// The part of a LightTable that belongs to one hit.
struct Row {
  std::size_t first, count;
};

Row row_of(const LightTable& estimates, std::size_t hit, std::size_t lights) {
  if (estimates.first.empty()) return {hit * lights, lights};
  return {estimates.first[hit], estimates.first[hit + 1] - estimates.first[hit]};
}

double luminance_of(const LightTable& estimates, const Row& row, std::span<const double> weights) {
  double sum = 0;
  for (std::size_t i = 0; i < row.count; ++i) {
    const std::size_t light = estimates.light.empty() ? i : estimates.light[row.first + i];
    sum += weights[light] * luminance(glm::dvec3(estimates.irradiance[row.first + i]));
  }
  return sum;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, const Row& row) {
  if (from.empty()) return;
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(row.first);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(row.count));
}

}  // namespace

std::vector<int> neighbour_levels(int least, int most) {
  std::vector<int> levels{most};
  while (levels.back() / level_factor >= least) levels.push_back(levels.back() / level_factor);
  std::reverse(levels.begin(), levels.end());
  return levels;
}

std::size_t least_error_level(std::span<const double> values, std::span<const int> neighbours) {
  // An estimate is in proportion to 1 / r_k^2, whose logarithm has the variance 1 / (k - 1) and,
  // unlike itself, hardly any skew: choices by noise would else prefer what is too bright. The
  // photons of a smaller k are among those of a larger one, so the variance of a difference is the
  // difference of the variances. The cone and Epanechnikov's kernel have more noise, and levels
  // that hang together more: between neighbouring levels the difference has the same variance.
  const auto variance = [&](std::size_t level) { return 1.0 / std::max(neighbours[level] - 1, 1); };
  for (std::size_t level = 1; level < values.size(); ++level) {
    for (std::size_t before = 0; before < level; ++before) {
      if (values[level] == values[before]) continue;
      const double deviations = std::abs(std::log(values[level] / values[before])) /
                                std::sqrt(variance(before) - variance(level));
      if (!(deviations <= tolerated_deviations)) return level - 1;
    }
  }
  return values.size() - 1;
}

LightTable estimates_of_least_error(std::vector<LightTable> levels, std::span<const int> neighbours,
                                    std::span<const double> weights) {
  const bool sparse = !levels.front().first.empty();
  const std::size_t lights = weights.size();
  const std::size_t hits =
      sparse ? levels.front().first.size() - 1 : levels.front().irradiance.size() / lights;
  std::vector<std::uint8_t> chosen(hits);
  tbb::parallel_for(std::size_t{0}, hits, [&](std::size_t hit) {
    std::vector<double> values;
    for (const LightTable& level : levels) {
      values.push_back(luminance_of(level, row_of(level, hit, lights), weights));
    }
    chosen[hit] = static_cast<std::uint8_t>(least_error_level(values, neighbours));
  });
  LightTable result(lights, sparse);
  for (std::size_t hit = 0; hit < hits; ++hit) {
    const LightTable& level = levels[chosen[hit]];
    const Row row = row_of(level, hit, lights);
    append(result.irradiance, level.irradiance, row);
    append(result.radiance, level.radiance, row);
    append(result.light, level.light, row);
    if (sparse) result.first.push_back(result.irradiance.size());
  }
  return result;
}

std::vector<double> layer_powers(const Scene& scene) {
  std::vector<double> powers;
  for (const LightGroup& group : light_groups_of(scene).groups) powers.push_back(group.power);
  if (std::all_of(powers.begin(), powers.end(), [](double power) { return power == 0; })) {
    std::fill(powers.begin(), powers.end(), 1.0);
  }
  return powers;
}

}  // namespace photile::estimate
