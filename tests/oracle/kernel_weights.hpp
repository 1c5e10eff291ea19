// The kernels of the density estimate, written down afresh in double precision.
#pragma once

#include "photile/estimator.hpp"

namespace photile::reference {

/// What a photon counts at `distance`, over the radius, in [0, 1].
inline double weight_at(DensityKernel kernel, double distance) {
  if (kernel == DensityKernel::cone) return 1 - distance;
  return 1;
}

/// The squared coefficient of variation of the weights over the whole disc.
inline double squared_variation(DensityKernel kernel) {
  if (kernel == DensityKernel::cone) return 0.5;  // means of 1/6 for the square and 1/3
  return 0;
}

/// The mean of the weights over the whole disc.
inline double mean_weight(DensityKernel kernel) {
  if (kernel == DensityKernel::cone) return 1.0 / 3;
  return 1;
}

}  // namespace photile::reference
