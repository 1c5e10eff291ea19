// How lights share what is drawn from all of them.
#pragma once

#include <vector>

#include "photile/photons.hpp"

namespace photile::trace {

/// Share of each light, summing to 1 up to rounding; above 0 unless `quota` is `power`.
std::vector<double> light_shares(const std::vector<Light>& lights, PhotonQuota quota);

}  // namespace photile::trace
