// Takes noise from irradiance at points that see much the same: whether the light of two points may
// differ by noise alone, and means with weights of each layer.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "light/row_sum.hpp"
#include "photile/defaults.hpp"
#include "trace/ray_query.hpp"

namespace photile::cache {

/// The differences that count as noise.
struct NoiseTolerance {
  /// At differences of this many standard errors the weight falls to 1 / e.
  double errors = defaults::tolerated_errors;
  /// Where one standard error is larger than this many times the other, the two count less, by the
  /// square of what is more: they do not see the same light.
  double ratio = std::numeric_limits<double>::infinity();
  /// The ratio counts only where the smaller error is at most this fraction of the light it is of:
  /// where few rays or none found light, the error is unknown.
  double known = defaults::known_error;
};

/// Points with their light and its standard errors, of each layer and of all at their powers: each
/// point is compared with many others, and its errors are found once.
class KnownPoints {
 public:
  /// Keeps a reference.
  ///   rows   the points of `irradiance`, which are counted in this order
  KnownPoints(const LightTable& irradiance, std::vector<std::size_t> rows,
              std::span<const double> layer_powers);
  /// All points of `irradiance`.
  KnownPoints(const LightTable& irradiance, std::span<const double> layer_powers);

  const LightTable& irradiance() const { return irradiance_; }
  std::size_t row(std::size_t point) const { return rows_[point]; }
  const LightTable::Total& all(std::size_t point) const { return all_[point]; }
  /// Calls visit(layer, its light at power 1) for the layers that a point has.
  template <class Visit>
  void for_each_layer(std::size_t point, const Visit& visit) const {
    std::size_t next = first_[point];
    irradiance_.for_each(rows_[point],
                         [&](std::size_t layer, std::size_t) { visit(layer, layers_[next++]); });
  }

 private:
  const LightTable& irradiance_;
  std::vector<std::size_t> rows_, first_;
  std::vector<LightTable::Total> all_, layers_;
};

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

/// Which points are neighbours on one surface, in compressed sparse rows: point i is linked to
/// to[first[i] .. first[i + 1]). The caller decides what one surface is.
struct PointLinks {
  std::vector<std::uint32_t> first;  ///< one more than there are points
  std::vector<std::uint32_t> to;
  std::vector<glm::vec3> position;  ///< of each point

  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(to).subspan(first[point], first[point + 1] - first[point]);
  }
};

struct IrradianceFilterParameters {
  int rounds = 8;  ///< light spreads over one link a round
  NoiseTolerance tolerated = {};
};

/// Replaces each point's light by the mean of it and its neighbours', weighted by
/// exp(-d^2 / (t^2 (se_a^2 + se_b^2))), d the difference of luminance, se its standard errors and t
/// those that are tolerated, and less where these differ more than is tolerated, a few times over.
/// Where a layer differs by more than its own noise, that is its weight alone: the sun's border
/// would leave the noise of lights in their layers. All others have that of their sum at
/// `layer_powers`. Where neighbours lie to one side, as where surface ends, those that are nearer
/// weigh more, as far as light changes along it: their mean is then that of a plane through them,
/// at the point (a regression of the first order, as Bitterli et al. 2016 have for pixels). All
/// batches of a layer have the same weights, so that errors are known afterwards, too. Points
/// without error change only by points that are equal. Does not depend on threads, nor on whether
/// they flush denormal numbers.
LightTable filter_irradiance(LightTable irradiance, const PointLinks& links,
                             std::span<const double> layer_powers,
                             const IrradianceFilterParameters& parameters = {});

}  // namespace photile::cache
