#include "measuring/grid_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace photile::measuring {
namespace {

/// Which sensors the figures of a grid are about.
struct Extremes {
  std::size_t darkest, brightest;

  static Extremes of(std::span<const double> values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {static_cast<std::size_t>(low - values.begin()),
            static_cast<std::size_t>(high - values.begin())};
  }
};

/// The figures of one set of values.
struct Figures {
  double mean = 0, minimum, maximum;

  Figures(std::span<const double> values, const Extremes& extremes)
      : minimum(values[extremes.darkest]), maximum(values[extremes.brightest]) {
    for (const double value : values) mean += value;
    mean /= static_cast<double>(values.size());
  }
  // A dark grid is uniform in no useful sense.
  double uniformity() const { return mean > 0 ? minimum / mean : 0; }
  double diversity() const { return maximum > 0 ? minimum / maximum : 0; }
};

/// Spread of the values of leaving one repeat out each, scaled to that of the whole.
template <class Of>
double jackknife_error(std::span<const Figures> without, const Of& of) {
  const auto count = static_cast<double>(without.size());
  double mean = 0, squares = 0;
  for (const Figures& each : without) mean += of(each) / count;
  for (const Figures& each : without) squares += std::pow(of(each) - mean, 2);
  return std::sqrt((count - 1) / count * squares);
}

}  // namespace

std::vector<Measured> means_of(std::span<const std::vector<float>> repeats) {
  const auto count = static_cast<double>(repeats.size());
  std::vector<Measured> result(repeats.front().size());
  for (std::size_t sensor = 0; sensor < result.size(); ++sensor) {
    double mean = 0, squares = 0;
    for (const auto& repeat : repeats) mean += static_cast<double>(repeat[sensor]) / count;
    for (const auto& repeat : repeats) {
      squares += std::pow(static_cast<double>(repeat[sensor]) - mean, 2);
    }
    result[sensor] = {mean, std::sqrt(squares / (count - 1) / count)};
  }
  return result;
}

GridStatistics statistics_of(std::span<const std::vector<float>> repeats, std::size_t first,
                             std::size_t count) {
  const auto number = static_cast<double>(repeats.size());
  std::vector<double> sums(count);
  for (const auto& repeat : repeats) {
    for (std::size_t i = 0; i < count; ++i) sums[i] += static_cast<double>(repeat[first + i]);
  }
  std::vector<double> means(sums);
  for (double& mean : means) mean /= number;
  const Extremes extremes = Extremes::of(means);
  const Figures all(means, extremes);

  GridStatistics result;
  std::vector<Figures> without;
  std::vector<double> others(count);
  for (const auto& repeat : repeats) {
    for (std::size_t i = 0; i < count; ++i) {
      others[i] = (sums[i] - static_cast<double>(repeat[first + i])) / (number - 1);
    }
    without.emplace_back(others, extremes);
    const Extremes seen = Extremes::of(others);
    result.minimum_at_most += static_cast<double>(repeat[first + seen.darkest]) / number;
    result.maximum_at_least += static_cast<double>(repeat[first + seen.brightest]) / number;
  }
  const auto measured = [&](auto of) { return Measured{of(all), jackknife_error(without, of)}; };
  result.mean = measured([](const Figures& f) { return f.mean; });
  result.minimum = measured([](const Figures& f) { return f.minimum; });
  result.maximum = measured([](const Figures& f) { return f.maximum; });
  result.uniformity = measured([](const Figures& f) { return f.uniformity(); });
  result.diversity = measured([](const Figures& f) { return f.diversity(); });
  return result;
}

}  // namespace photile::measuring
