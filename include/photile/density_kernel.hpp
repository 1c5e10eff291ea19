// The kernel of the density estimate: what a photon counts, by its distance.
#pragma once

#include <array>
#include <string_view>

namespace photile {

/// The weight of a photon at distance d, where the k-th lies at r (Silverman, "Density Estimation
/// for Statistics and Data Analysis", 1986; Jensen, "Global Illumination using Photon Maps", 1996).
/// The estimate divides by the integral of the kernel over the area; see docs/density.md.
enum class DensityKernel {
  constant,     ///< 1: least noise
  cone,         ///< 1 - d / r: least blur
  epanechnikov  ///< 1 - (d / r)^2: between the two
};

/// "constant", "cone", "epanechnikov".
std::string_view name_of(DensityKernel kernel);
inline constexpr std::array all_density_kernels = {DensityKernel::constant, DensityKernel::cone,
                                                   DensityKernel::epanechnikov};

/// The kernel in use with k neighbours: one photon alone lies at r, where the others are 0.
inline DensityKernel kernel_used(DensityKernel kernel, int neighbours) {
  return neighbours > 1 ? kernel : DensityKernel::constant;
}

}  // namespace photile
