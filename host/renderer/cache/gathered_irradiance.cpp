#include "cache/gathered_irradiance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "estimate/light_at_points.hpp"
#include "photile/scene.hpp"

namespace photile::cache {

namespace {

/// The variance of the mean of independent values.
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

std::uint64_t GatheredIrradiance::bytes() const {
  return mean.irradiance.size() * sizeof(glm::vec3) + mean.first.size() * sizeof(std::uint64_t) +
         mean.light.size() * sizeof(std::uint16_t) + mean.by_normal.size() * sizeof(glm::vec4) +
         (batch.size() + shared_variance.size()) * sizeof(float);
}

double GatheredIrradiance::error(std::size_t estimate) const { return error(estimate, 1.0); }

double GatheredIrradiance::scatter(std::size_t estimate) const {
  return error(estimate, defaults::aimed_noise);
}

double GatheredIrradiance::error(std::size_t estimate, double of_shared) const {
  const auto count = static_cast<std::size_t>(batches);
  const double shared = shared_variance.empty() ? 0.0 : double{shared_variance[estimate]};
  return std::sqrt(squared_error_of_mean(std::span(batch).subspan(estimate * count, count)) +
                   of_shared * of_shared * shared);
}

GatheredIrradiance::Total GatheredIrradiance::total(std::size_t point,
                                                    std::span<const double> layer_powers) const {
  const auto count = static_cast<std::size_t>(batches);
  std::array<double, max_batches> sums{};
  double luminance_sum = 0, shared = 0;
  estimate::for_each_estimate(mean, point, layer_powers.size(),
                              [&](std::size_t layer, std::size_t i) {
                                const double power = layer_powers[layer];
                                luminance_sum += power * luminance(glm::dvec3(mean.irradiance[i]));
                                for (std::size_t b = 0; b < count; ++b)
                                  sums[b] += power * double{batch[i * count + b]};
                                // Photons, or neighbours, that lights share may err in all of them
                                // alike.
                                if (!shared_variance.empty())
                                  shared += power * std::sqrt(double{shared_variance[i]});
                              });
  shared *= defaults::aimed_noise;
  return {luminance_sum,
          std::sqrt(squared_error_of_mean(std::span<const double>(sums).first(count)) +
                    shared * shared)};
}

void GatheredIrradiance::append(const GatheredIrradiance& other, std::size_t point,
                                std::size_t lights) {
  const bool sparse = !other.mean.first.empty();
  const std::size_t first = sparse ? other.mean.first[point] : point * lights;
  const std::size_t count = sparse ? other.mean.first[point + 1] - first : lights;
  const auto in_row = static_cast<std::size_t>(other.batches);
  batches = other.batches;
  append_rows(mean.irradiance, other.mean.irradiance, first, count);
  append_rows(mean.by_normal, other.mean.by_normal, first, count);
  append_rows(batch, other.batch, first * in_row, count * in_row);
  append_rows(shared_variance, other.shared_variance, first, count);
  if (!sparse) return;
  if (mean.first.empty()) mean.first.push_back(0);
  append_rows(mean.light, other.mean.light, first, count);
  mean.first.push_back(mean.irradiance.size());
}

void GatheredIrradiance::append(GatheredIrradiance other) {
  batches = other.batches;
  mean.append(std::move(other.mean));
  batch.insert(batch.end(), other.batch.begin(), other.batch.end());
  shared_variance.insert(shared_variance.end(), other.shared_variance.begin(),
                         other.shared_variance.end());
}

GatheredIrradiance sum_of(const GatheredIrradiance& a, const GatheredIrradiance& b,
                          std::size_t lights, float share_a, float share_b) {
  GatheredIrradiance sum;
  sum.batches = a.batches;
  const bool sparse = !a.mean.first.empty();
  const bool shared = !a.shared_variance.empty() || !b.shared_variance.empty();
  const bool smooth = !a.mean.by_normal.empty() || !b.mean.by_normal.empty();
  const auto count = static_cast<std::size_t>(a.batches);
  if (sparse) sum.mean.first.push_back(0);
  std::vector<std::size_t> index_of(lights);
  const std::size_t points = a.points(lights);
  for (std::size_t point = 0; point < points; ++point) {
    const std::size_t first = sum.mean.irradiance.size();
    index_of.assign(lights, first + lights);  // of none
    for (const auto& [part, share] : {std::pair(&a, share_a), std::pair(&b, share_b)}) {
      estimate::for_each_estimate(
          part->mean, point, lights,
          [&, part = part, share = share](std::size_t layer, std::size_t i) {
            if (index_of[layer] == first + lights) {
              index_of[layer] = sum.mean.irradiance.size();
              sum.mean.irradiance.emplace_back(0.0f);
              if (smooth) sum.mean.by_normal.emplace_back(0.0f);
              sum.batch.resize(sum.batch.size() + count, 0.0f);
              if (sparse) sum.mean.light.push_back(static_cast<std::uint16_t>(layer));
              if (shared) sum.shared_variance.push_back(0);
            }
            const std::size_t to = index_of[layer];
            sum.mean.irradiance[to] += share * part->mean.irradiance[i];
            if (smooth) sum.mean.by_normal[to] += share * part->mean.by_normal[i];
            for (std::size_t b = 0; b < count; ++b) {
              sum.batch[to * count + b] += share * part->batch[i * count + b];
            }
            if (!part->shared_variance.empty()) {
              sum.shared_variance[to] += share * share * part->shared_variance[i];
            }
          });
    }
    if (sparse) sum.mean.first.push_back(sum.mean.irradiance.size());
  }
  return sum;
}

BatchSums::BatchSums(const SceneNeeds& needs, int batches, bool caustics,
                     GatheredIrradiance& result)
    : sparse_(needs.many_lights()),
      caustics_(caustics),
      smooth_(needs.smooth_shading),
      batches_(static_cast<std::size_t>(batches)),
      result_(result),
      sums_(needs.light_count * batches_, glm::vec3(0.0f)),
      by_normal_(needs.smooth_shading ? needs.light_count : 0, glm::vec4(0.0f)),
      shared_variance_(needs.light_count, 0.0),
      lit_(needs.light_count) {
  result_.batches = batches;
  if (sparse_) result_.mean.first.push_back(0);
}

void BatchSums::add_to_all(std::uint32_t layer, const glm::vec3& irradiance,
                           double relative_variance) {
  lit_.add(layer);
  for (std::size_t b = 0; b < batches_; ++b) sums_[layer * batches_ + b] += irradiance;
  const double value = luminance(glm::dvec3(irradiance));
  shared_variance_[layer] += relative_variance * value * value;
  if (smooth_) by_normal_[layer].w += static_cast<float>(value * static_cast<double>(batches_));
}

/// Irradiance goes with the cosine to the normal n, so that light L from w counts L (w . n) for it.
///   even   fraction of what is lost when w sinks below the horizon that other light, which rises
///          above it, makes good: half of light that is the same from all sides, for a plane that
///          is turned by t gets (1 + cos t) / 2 of it and not cos t
void BatchSums::add_by_normal(std::uint32_t layer, const glm::vec3& irradiance,
                              const glm::vec3& direction, float even, float most_inverse_cosine) {
  const auto light = static_cast<float>(luminance(glm::dvec3(irradiance)));
  const float cosine = glm::dot(direction, normal_);
  glm::vec3 along = normal_;
  if (cosine > 0.0f) {
    along += std::min(1.0f / cosine, most_inverse_cosine) * (direction - cosine * normal_);
  }
  by_normal_[layer] += light * glm::vec4(along - even * normal_, even);
}

void BatchSums::end_point() {
  if (sparse_) {
    for (const std::uint16_t layer : lit_.sorted()) {
      write(layer);
      result_.mean.light.push_back(layer);
    }
    result_.mean.first.push_back(result_.mean.irradiance.size());
  } else {
    for (std::uint32_t layer = 0; layer < shared_variance_.size(); ++layer) write(layer);
  }
  for (const std::uint16_t layer : lit_.sorted()) {
    std::fill_n(sums_.begin() + static_cast<std::ptrdiff_t>(layer * batches_), batches_,
                glm::vec3(0.0f));
    shared_variance_[layer] = 0;
    if (smooth_) by_normal_[layer] = glm::vec4(0.0f);
  }
  lit_.clear();
}

void BatchSums::write(std::uint32_t layer) {
  glm::vec3 sum(0.0f);
  for (std::size_t b = 0; b < batches_; ++b) {
    const glm::vec3& value = sums_[layer * batches_ + b];
    sum += value;
    result_.batch.push_back(static_cast<float>(luminance(glm::dvec3(value))));
  }
  result_.mean.irradiance.push_back(sum / static_cast<float>(batches_));
  if (smooth_) {
    result_.mean.by_normal.push_back(by_normal_[layer] / static_cast<float>(batches_));
  }
  if (caustics_) {
    result_.shared_variance.push_back(static_cast<float>(shared_variance_[layer]));
  }
}

}  // namespace photile::cache
