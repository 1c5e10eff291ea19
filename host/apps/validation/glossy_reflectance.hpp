// How much of uniform light a glossy surface reflects, for the BSDF of photile/device/bsdf.h.
#pragma once

namespace photile::validation {

/// Luminance along the normal over the luminance of uniform surroundings: the integral of
/// f (n.i) over the hemisphere, for albedo and F0 of one channel, F90 = 1 and GGX `alpha`. Relative
/// error below 1e-5.
double glossy_reflectance(double albedo, double f0, double alpha);

}  // namespace photile::validation
