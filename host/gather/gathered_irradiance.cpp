#include "gather/gathered_irradiance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "photile/scene.hpp"
#include "render/reflected_radiance.hpp"

namespace photile {
namespace {

/// Of the mean of independent values.
template <class T>
double squared_error_of_mean(std::span<const T> values) {
  const auto count = static_cast<double>(values.size());
  if (values.size() < 2) return 0;
  double mean = 0, squares = 0;
  for (const T value : values) mean += static_cast<double>(value) / count;
  for (const T value : values) {
    const double difference = static_cast<double>(value) - mean;
    squares += difference * difference;
  }
  return squares / (count * (count - 1));
}

template <class T>
void append_rows(std::vector<T>& to, const std::vector<T>& from, std::size_t first,
                 std::size_t count) {
  if (from.empty()) return;
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

double GatheredIrradiance::error(std::size_t estimate) const {
  const auto count = static_cast<std::size_t>(batches);
  const double shared = shared_variance.empty() ? 0.0 : double{shared_variance[estimate]};
  return std::sqrt(squared_error_of_mean(std::span(batch).subspan(estimate * count, count)) +
                   shared);
}

GatheredIrradiance::Total GatheredIrradiance::total(std::size_t point,
                                                    std::span<const double> layer_powers) const {
  const auto count = static_cast<std::size_t>(batches);
  std::vector<double> sums(count, 0.0);
  double luminance_sum = 0, shared = 0;
  for_each_estimate(mean, point, layer_powers.size(), [&](std::size_t layer, std::size_t i) {
    const double power = layer_powers[layer];
    luminance_sum += power * luminance(glm::dvec3(mean.irradiance[i]));
    for (std::size_t b = 0; b < count; ++b) sums[b] += power * double{batch[i * count + b]};
    // The same photons, or neighbours, may err in all lights alike.
    if (!shared_variance.empty()) shared += power * std::sqrt(double{shared_variance[i]});
  });
  return {luminance_sum,
          std::sqrt(squared_error_of_mean(std::span<const double>(sums)) + shared * shared)};
}

void GatheredIrradiance::append(const GatheredIrradiance& other, std::size_t point,
                                std::size_t lights) {
  const bool sparse = !other.mean.first.empty();
  const std::size_t first = sparse ? other.mean.first[point] : point * lights;
  const std::size_t count = sparse ? other.mean.first[point + 1] - first : lights;
  const auto in_row = static_cast<std::size_t>(other.batches);
  batches = other.batches;
  append_rows(mean.irradiance, other.mean.irradiance, first, count);
  append_rows(batch, other.batch, first * in_row, count * in_row);
  append_rows(shared_variance, other.shared_variance, first, count);
  if (!sparse) return;
  if (mean.first.empty()) mean.first.push_back(0);
  append_rows(mean.light, other.mean.light, first, count);
  mean.first.push_back(mean.irradiance.size());
}

}  // namespace photile
