// Whether the light of two places may be the same but for noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cache/gathered_irradiance.hpp"
#include "photile/defaults.hpp"

namespace photile::cache {

/// What may be noise.
struct NoiseTolerance {
  /// Differences of so many standard errors count less by e.
  double errors = defaults::tolerated_errors;
  /// Where one standard error is larger than this many times the other, the two count less, by the
  /// square of what is more: they do not see the same light.
  double ratio = std::numeric_limits<double>::infinity();
  /// But only where the smaller error is at most this share of the light it is of: a point that few
  /// rays brought light to, or none, does not know its error.
  double known = defaults::known_error;
};

/// The light of one point with its standard errors: of each layer, and of all at their powers.
class KnownLight {
 public:
  explicit KnownLight(std::span<const double> layer_powers)
      : layer_powers_(layer_powers), layers_(layer_powers.size()) {}

  /// Keeps a reference until the next call.
  void read(const GatheredIrradiance& irradiance, std::size_t point);

  const GatheredIrradiance::Total& all() const { return all_; }
  const GatheredIrradiance::Total& of_layer(std::size_t layer) const { return layers_[layer]; }
  /// Of all together at these powers.
  GatheredIrradiance::Total at_powers(std::span<const double> layer_powers) const {
    return irradiance_->total(point_, layer_powers);
  }
  std::span<const std::uint16_t> lit() const { return lit_; }  ///< layers that the point has

 private:
  std::span<const double> layer_powers_;
  const GatheredIrradiance* irradiance_ = nullptr;
  std::size_t point_ = 0;
  std::vector<GatheredIrradiance::Total> layers_;  ///< at power 1
  GatheredIrradiance::Total all_;
  std::vector<std::uint16_t> lit_;
};

/// How alike the layers of two places are, in [0, 1]. One light's border is no reason to part the
/// others: a layer whose own difference exceeds its noise is judged by itself; all others together,
/// for what many lamps show is surer than what one does.
class Likeness {
 public:
  explicit Likeness(std::span<const double> layer_powers)
      : layer_powers_(layer_powers), different_(layer_powers.size()) {}

  void compare(const KnownLight& a, const KnownLight& b, const NoiseTolerance& tolerated);

  double of_layer(std::size_t layer) const {
    return different_[layer] > 0 ? different_[layer] : of_others_;
  }
  /// Of layers that neither place has.
  double of_others() const { return of_others_; }

 private:
  std::span<const double> layer_powers_;
  std::vector<double> different_, others_powers_;
  std::vector<std::uint16_t> parted_;
  double of_others_ = 1;
};

}  // namespace photile::cache
