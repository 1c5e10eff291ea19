// How the estimate narrows from photon pass to photon pass.
#pragma once

namespace photile {

/// How one photon pass is estimated.
struct PassEstimate {
  double radius = 0;   ///< metres
  int neighbours = 0;  ///< k
};

/// The estimate of pass `pass` (from 0), given that of the first.
///
/// The mean of passes is consistent where both its bias and its variance vanish. Knaus and Zwicker,
/// "Progressive photon mapping: a probabilistic approach" (2011), shrink the radius by
/// R_{i+1}^2 = R_i^2 (i + alpha) / (i + 1), i = 1, 2, ...; then after n passes the bias is
/// O(n^{alpha - 1}) and the variance O(n^{-alpha}). The disc of k nearest of equally many photons
/// has an area in proportion to k, so that k shrinks by the same factor; it ends at
/// defaults::least_pass_neighbours (or the first k, where that is less), from where on only the
/// radius shrinks.
PassEstimate estimate_of_pass(int pass, const PassEstimate& first);

}  // namespace photile
