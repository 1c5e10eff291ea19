// Takes noise from irradiance at points that see much the same.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "gather/gathered_irradiance.hpp"
#include "photile/defaults.hpp"

namespace photile {

/// Which points are neighbours on one surface, in compressed sparse rows: point i is linked to
/// to[first[i] .. first[i + 1]). Who links says what one surface is.
struct PointLinks {
  std::vector<std::uint32_t> first;  ///< one more than there are points
  std::vector<std::uint32_t> to;

  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(to).subspan(first[point], first[point + 1] - first[point]);
  }
};

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

struct IrradianceFilterParameters {
  int rounds = 8;  ///< light spreads over one link a round
  NoiseTolerance tolerated = {};
};

/// In [0, 1]: whether what two places differ by may be noise.
double likeness(const GatheredIrradiance::Total& a, const GatheredIrradiance::Total& b,
                const NoiseTolerance& tolerated);

/// Replaces each point's light by the mean of it and its neighbours', weighted by exp(-d^2 / (9
/// (se_a^2 + se_b^2))), d the difference of the luminance of all lights at `layer_powers` and se
/// its standard errors, and less where these differ more than is tolerated, a few times over. All
/// lights and batches have the same weights, so that layers stay exactly linear in the powers and
/// errors are known afterwards, too. Points of no error stay what they are, but for equal ones.
/// Does not depend on threads.
GatheredIrradiance filter_irradiance(GatheredIrradiance irradiance, const PointLinks& links,
                                     std::span<const double> layer_powers,
                                     const IrradianceFilterParameters& parameters = {});

}  // namespace photile
