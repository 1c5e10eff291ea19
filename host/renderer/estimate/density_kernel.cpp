#include "photile/estimator.hpp"

namespace photile {

std::string_view name_of(DensityKernel kernel) {
  switch (kernel) {
    case DensityKernel::constant:
      return "constant";
    case DensityKernel::cone:
      return "cone";
    case DensityKernel::epanechnikov:
      return "epanechnikov";
  }
  return "unknown";
}

}  // namespace photile
