#include "cache/irradiance_filter.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "light/light_at_points.hpp"
#include "light/row_sum.hpp"
#include "photile/scene.hpp"
#include "trace/ray_query.hpp"

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

/// One point of those.
class KnownLight {
 public:
  explicit KnownLight(std::size_t lights) : layers_(lights) {}

  /// Keeps a reference until the next call.
  void read(const KnownPoints& points, std::size_t point);

  const LightTable::Total& all() const { return points_->all(point_); }
  const LightTable::Total& of_layer(std::size_t layer) const { return layers_[layer]; }
  /// The light of all layers together at these powers.
  LightTable::Total at_powers(std::span<const double> layer_powers) const {
    return points_->irradiance().total(points_->row(point_), layer_powers);
  }
  std::span<const std::uint16_t> lit() const { return lit_; }  ///< layers that the point has

 private:
  const KnownPoints* points_ = nullptr;
  std::size_t point_ = 0;
  std::vector<LightTable::Total> layers_;  ///< at power 1
  std::vector<std::uint16_t> lit_;
};

/// The similarity of the layers of two points, in [0, 1]. One light's border is no reason to
/// separate the others: a layer whose own difference exceeds its noise is judged by itself; all
/// others together, for what many lights show is surer than what one does.
class Similarity {
 public:
  explicit Similarity(std::span<const double> layer_powers)
      : layer_powers_(layer_powers), different_(layer_powers.size()) {}

  void compare(const KnownLight& a, const KnownLight& b, const NoiseTolerance& tolerated);

  double of_layer(std::size_t layer) const {
    return different_[layer] > 0 ? different_[layer] : of_others_;
  }
  /// The weight of layers that neither point has.
  double of_others() const { return of_others_; }

 private:
  std::span<const double> layer_powers_;
  std::vector<double> different_, others_powers_;
  std::vector<std::uint16_t> different_layers_;
  double of_others_ = 1;
};

/// Weighted means of points, written one after another.
class WeightedPoints {
 public:
  /// The reference is kept.
  ///   like   batches, and form, of all points
  ///   to     without rows
  WeightedPoints(const LightTable& like, LightTable& to)
      : to_(to),
        shared_(!like.shared_variance.empty()),
        batches_(static_cast<std::size_t>(like.batches)),
        sums_(like.lights),
        batch_(like.lights * batches_, 0.0) {}

  /// Adds a point to the mean.
  ///   weight_of   of a layer, by its number
  ///   of_none     weight that it would give to a layer that no point so far has
  template <class Weight>
  void add(const LightTable& from, std::size_t point, double of_none, const Weight& weight_of) {
    from.for_each(point, [&](std::size_t layer, std::size_t) {
      const bool known = sums_.has(layer);
      Sums& sums = sums_.of(layer);
      if (!known) sums.weights = of_none_;
    });
    smooth_ = smooth_ || !from.by_normal.empty();
    for (const std::uint16_t layer : sums_.lit()) {
      Sums& sums = sums_.of(layer);
      sums.weight = weight_of(layer);
      sums.weights += sums.weight;
    }
    from.for_each(point, [&](std::size_t layer, std::size_t i) {
      Sums& sums = sums_.of(layer);
      sums.irradiance += sums.weight * glm::dvec3(from.irradiance[i]);
      if (smooth_) sums.by_normal += sums.weight * glm::dvec4(from.by_normal[i]);
      for (std::size_t b = 0; b < batches_; ++b) {
        batch_[layer * batches_ + b] += sums.weight * double{from.batch[i * batches_ + b]};
      }
      // Photons of caustics may be the same at all points: errors add up.
      if (shared_) sums.error += sums.weight * std::sqrt(double{from.shared_variance[i]});
    });
    of_none_ += of_none;
  }

  void end_point() {
    sums_.end_row(to_, [&](std::size_t layer, const Sums& sums) {
      to_.irradiance.emplace_back(sums.irradiance / sums.weights);
      if (smooth_) to_.by_normal.emplace_back(sums.by_normal / sums.weights);
      for (std::size_t b = 0; b < batches_; ++b) {
        double& sum = batch_[layer * batches_ + b];
        to_.batch.push_back(static_cast<float>(sum / sums.weights));
        sum = 0;
      }
      if (!shared_) return;
      const double error = sums.error / sums.weights;
      to_.shared_variance.push_back(static_cast<float>(error * error));
    });
    of_none_ = 0;
  }

 private:
  /// The sums of one layer, weighted.
  struct Sums {
    glm::dvec3 irradiance{0.0};
    glm::dvec4 by_normal{0.0};
    double error = 0;  ///< that all batches share
    double weights = 0;
    double weight = 0;  ///< of the point that is being added
  };

  LightTable& to_;
  bool shared_;
  bool smooth_ = false;  ///< once a point tells light by the normal, as all do that have light
  std::size_t batches_;
  light::RowSum<Sums> sums_;
  std::vector<double> batch_;  ///< [layer][batch], weighted
  double of_none_ = 0;
};

/// A point and those around it, of which it becomes the mean.
class MeanOfPoints {
 public:
  MeanOfPoints(std::span<const double> layer_powers, const LightTable& like, LightTable& to)
      : sums_(like, to),
        own_(layer_powers.size()),
        other_(layer_powers.size()),
        similarity_(layer_powers) {}

  /// Adds the point itself, with the weight of `weight` points.
  void add_own(const KnownPoints& from, std::size_t point, double weight = 1) {
    own_.read(from, point);
    sums_.add(from.irradiance(), from.row(point), weight, [&](std::size_t) { return weight; });
  }
  /// Adds one that may have the same light as the point itself, with the weight of `weight` points.
  void add_other(const KnownPoints& from, std::size_t point, const NoiseTolerance& tolerated,
                 double weight = 1) {
    other_.read(from, point);
    similarity_.compare(own_, other_, tolerated);
    sums_.add(from.irradiance(), from.row(point), weight * similarity_.of_others(),
              [&](std::size_t layer) { return weight * similarity_.of_layer(layer); });
  }
  void end_point() { sums_.end_point(); }

 private:
  WeightedPoints sums_;
  KnownLight own_, other_;
  Similarity similarity_;
};

/// The means of `count` points, each made by add(i, mean); `like` has their batches and form.
template <class Add>
LightTable means_of(const LightTable& like, std::size_t count, std::span<const double> layer_powers,
                    const Add& add) {
  // Large enough to make a task's cost vanish, small enough to share work.
  constexpr std::size_t per_task = 256;
  LightTable none(like.lights, like.sparse());
  none.batches = like.batches;
  const auto write = [&](std::size_t first, std::size_t last, LightTable& rows) {
    // A point with 1e-40 of light is compared otherwise than one with none, and a library that the
    // program loads may have changed what threads make of such numbers.
    const trace::FlushDenormals flush_denormals;
    MeanOfPoints mean(layer_powers, like, rows);
    for (std::size_t i = first; i < last; ++i) {
      add(i, mean);
      mean.end_point();
    }
  };
  return light::rows_by_tasks(count, per_task, none, write);
}

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

LightTable filter_irradiance(LightTable irradiance, const PointLinks& links,
                             std::span<const double> layer_powers,
                             const IrradianceFilterParameters& parameters) {
  for (int round = 0; round < parameters.rounds; ++round) {
    const KnownPoints points(irradiance, layer_powers);
    tbb::enumerable_thread_specific<PlaneThroughPoints> planes(points, std::span(links.position),
                                                               layer_powers);
    irradiance = means_of(irradiance, links.size(), layer_powers, [&](std::size_t i, auto& light) {
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

LightTable means_with_neighbours(const LightTable& irradiance, std::span<const std::uint32_t> rows,
                                 const PointLinks& links, std::span<const std::uint32_t> chosen,
                                 std::span<const double> layer_powers,
                                 const NoiseTolerance& tolerated) {
  const KnownPoints points(irradiance, {rows.begin(), rows.end()}, layer_powers);
  return means_of(irradiance, chosen.size(), layer_powers, [&](std::size_t i, auto& mean) {
    mean.add_own(points, chosen[i]);
    for (const std::uint32_t other : links.of(chosen[i])) mean.add_other(points, other, tolerated);
  });
}

}  // namespace photile::cache
