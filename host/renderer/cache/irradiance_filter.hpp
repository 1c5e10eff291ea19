// Takes noise from irradiance at points that see much the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cache/gathered_irradiance.hpp"
#include "cache/likeness.hpp"

namespace photile::cache {

/// Which points are neighbours on one surface, in compressed sparse rows: point i is linked to
/// to[first[i] .. first[i + 1]). Who links says what one surface is.
struct PointLinks {
  std::vector<std::uint32_t> first;  ///< one more than there are points
  std::vector<std::uint32_t> to;

  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(to).subspan(first[point], first[point + 1] - first[point]);
  }
};

struct IrradianceFilterParameters {
  int rounds = 8;  ///< light spreads over one link a round
  NoiseTolerance tolerated = {};
};

/// Replaces each point's light by the mean of it and its neighbours', weighted by exp(-d^2 / (9
/// (se_a^2 + se_b^2))), d the difference of luminance and se its standard errors, and less where
/// these differ more than is tolerated, a few times over. Where a layer differs by more than its
/// own noise, that is its weight alone: the sun's border would leave the noise of lamps in their
/// layers. All others have that of their sum at `layer_powers`. All batches of a layer have the
/// same weights, so that errors are known afterwards, too. Points of no error stay what they are,
/// but for equal ones. Does not depend on threads.
GatheredIrradiance filter_irradiance(GatheredIrradiance irradiance, const PointLinks& links,
                                     std::span<const double> layer_powers,
                                     const IrradianceFilterParameters& parameters = {});

}  // namespace photile::cache
