#include "cache/irradiance_filter.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numeric>
#include <utility>

#include "light/light_at_points.hpp"
#include "photile/scene.hpp"

namespace photile::cache {

namespace {

using Total = LightTable::Total;

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t known_points_per_task = 256;

std::vector<std::size_t> all_rows(std::size_t count) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

/// The square of the difference in tolerated errors.
double squared_difference(const Total& a, const Total& b, const NoiseTolerance& tolerated) {
  const double difference = a.luminance - b.luminance;
  if (difference == 0) return 0;
  const double variance = a.error * a.error + b.error * b.error;
  return difference * difference / (tolerated.errors * tolerated.errors * variance);
}

/// The weight that is left where errors differ too much.
double similarity_of_errors(const Total& a, const Total& b, const NoiseTolerance& tolerated) {
  const auto [calm, noisy] = a.error < b.error ? std::pair(a, b) : std::pair(b, a);
  if (!(tolerated.ratio * calm.error < noisy.error)) return 1;
  if (!(calm.error < tolerated.known * calm.luminance)) return 1;
  const double part = tolerated.ratio * calm.error / noisy.error;
  return part * part;
}

/// The factor on the weights of a point and of those around it, so that the mean of points that are
/// all alike is that of a plane through them, at the point. Where they lie around it evenly that is
/// 1. Their similarity does not count here: beyond an edge there is surface, too.
class PlaneThroughPoints {
 public:
  /// References are kept.
  PlaneThroughPoints(const KnownPoints& points, std::span<const glm::vec3> positions,
                     std::span<const double> layer_powers)
      : points_(points), positions_(positions), layer_powers_(layer_powers) {}

  /// For this point and those around it.
  void fit(std::size_t own, std::span<const std::uint32_t> others);

  double of_own() const { return 1 + slope_ * middle_; }
  double of_other(std::size_t i) const { return std::max(0.0, 1 + slope_ * (middle_ - along_[i])); }

 private:
  double share_of_slope(std::size_t own, std::span<const std::uint32_t> others, double spread);

  const KnownPoints& points_;
  std::span<const glm::vec3> positions_;
  std::span<const double> layer_powers_;
  std::vector<double> along_;              ///< the others, from the point towards the middle of all
  std::vector<double> change_, variance_;  ///< of each layer
  double middle_ = 0;                      ///< of all points, in metres from the point itself
  double slope_ = 0;                       ///< of what multiplies weights, 1/m
};

void PlaneThroughPoints::fit(std::size_t own, std::span<const std::uint32_t> others) {
  const auto offset = [&](std::uint32_t other) {
    return glm::dvec3(positions_[other]) - glm::dvec3(positions_[own]);
  };
  slope_ = 0;
  along_.assign(others.size(), 0.0);
  const double count = static_cast<double>(others.size() + 1);
  glm::dvec3 middle(0.0);
  for (const std::uint32_t other : others) middle += offset(other) / count;
  middle_ = glm::length(middle);
  if (!(middle_ > 0)) return;
  double spread = middle_ * middle_ / count, farthest = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    along_[i] = glm::dot(offset(others[i]), middle) / middle_;
    spread += (along_[i] - middle_) * (along_[i] - middle_) / count;
    farthest = std::max(farthest, along_[i] - middle_);
  }
  // No weight may be negative.
  slope_ = std::min(share_of_slope(own, others, spread) * middle_ / spread, 1 / farthest);
}

/// The fraction of a slope that is kept: of the square of the change of the mean by the slope, the
/// part that exceeds noise, as James and Stein shrink a mean.
double PlaneThroughPoints::share_of_slope(std::size_t own, std::span<const std::uint32_t> others,
                                          double spread) {
  change_.assign(layer_powers_.size(), 0.0);
  variance_.assign(layer_powers_.size(), 0.0);
  const auto add = [&](std::size_t point, double along) {
    const double part = middle_ * (along - middle_) / (spread * double(others.size() + 1));
    points_.for_each_layer(point, [&](std::size_t layer, const Total& light) {
      const double factor = part * layer_powers_[layer];
      change_[layer] += factor * light.luminance;
      variance_[layer] += factor * factor * light.error * light.error;
    });
  };
  add(own, 0.0);
  for (std::size_t i = 0; i < others.size(); ++i) add(others[i], along_[i]);
  double squared = 0, of_noise = 0;
  for (std::size_t layer = 0; layer < layer_powers_.size(); ++layer) {
    squared += change_[layer] * change_[layer];
    of_noise += variance_[layer];
  }
  return squared > of_noise ? 1 - of_noise / squared : 0;
}

}  // namespace

KnownPoints::KnownPoints(const LightTable& irradiance, std::vector<std::size_t> rows,
                         std::span<const double> layer_powers)
    : irradiance_(irradiance), rows_(std::move(rows)) {
  std::size_t estimates = 0;
  for (const std::size_t row : rows_) {
    first_.push_back(estimates);
    irradiance.for_each(row, [&](std::size_t, std::size_t) { ++estimates; });
  }
  all_.resize(rows_.size());
  layers_.resize(estimates);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows_.size(), known_points_per_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const trace::FlushDenormals flush_denormals;
                      for (std::size_t point = range.begin(); point < range.end(); ++point) {
                        all_[point] = irradiance.total(rows_[point], layer_powers);
                        std::size_t next = first_[point];
                        irradiance.for_each(rows_[point], [&](std::size_t, std::size_t i) {
                          const glm::dvec3 mean(irradiance.irradiance[i]);
                          layers_[next++] = {luminance(mean), irradiance.scatter(i)};
                        });
                      }
                    });
}

KnownPoints::KnownPoints(const LightTable& irradiance, std::span<const double> layer_powers)
    : KnownPoints(irradiance, all_rows(irradiance.rows()), layer_powers) {}

void KnownLight::read(const KnownPoints& points, std::size_t point) {
  for (const std::uint16_t layer : lit_) layers_[layer] = {};
  lit_.clear();
  points_ = &points;
  point_ = point;
  points.for_each_layer(point, [&](std::size_t layer, const Total& light) {
    layers_[layer] = light;
    lit_.push_back(static_cast<std::uint16_t>(layer));
  });
}

void Similarity::compare(const KnownLight& a, const KnownLight& b,
                         const NoiseTolerance& tolerated) {
  for (const std::uint16_t layer : different_layers_) different_[layer] = 0;
  different_layers_.clear();
  const double errors = similarity_of_errors(a.all(), b.all(), tolerated);
  for (const KnownLight* point : {&a, &b}) {
    for (const std::uint16_t layer : point->lit()) {
      const double squared = squared_difference(a.of_layer(layer), b.of_layer(layer), tolerated);
      if (squared <= defaults::parting_difference || different_[layer] > 0) continue;
      // Below the smallest number there would be no difference.
      different_[layer] = std::max(errors * std::exp(-squared), std::numeric_limits<double>::min());
      different_layers_.push_back(layer);
    }
  }
  double squared = 0;
  if (different_layers_.empty()) {
    squared = squared_difference(a.all(), b.all(), tolerated);
  } else if (different_layers_.size() < layer_powers_.size()) {
    others_powers_.assign(layer_powers_.begin(), layer_powers_.end());
    for (const std::uint16_t layer : different_layers_) others_powers_[layer] = 0;
    squared =
        squared_difference(a.at_powers(others_powers_), b.at_powers(others_powers_), tolerated);
  }
  of_others_ = errors * std::exp(-squared);
}

LightTable filter_irradiance(LightTable irradiance, const PointLinks& links,
                             std::span<const double> layer_powers,
                             const IrradianceFilterParameters& parameters) {
  for (int round = 0; round < parameters.rounds; ++round) {
    const KnownPoints points(irradiance, layer_powers);
    tbb::enumerable_thread_specific<PlaneThroughPoints> planes(points, std::span(links.position),
                                                               layer_powers);
    irradiance =
        means_of(irradiance, links.first.size() - 1, layer_powers, [&](std::size_t i, auto& light) {
          PlaneThroughPoints& plane = planes.local();
          const std::span<const std::uint32_t> others = links.of(i);
          plane.fit(i, others);
          light.add_own(points, i, plane.of_own());
          for (std::size_t j = 0; j < others.size(); ++j) {
            light.add_other(points, others[j], parameters.tolerated, plane.of_other(j));
          }
        });
  }
  return irradiance;
}

}  // namespace photile::cache
