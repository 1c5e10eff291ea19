// The channels that every layered picture of photile has, rendered or relit.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "photile/image.hpp"

namespace photile::image {

/// Planes of one light, at the mix's power.
struct LightPlanes {
  std::array<std::vector<float>, 3> rgb;
  std::vector<float> illuminance;  ///< lux; empty where it is not known
};

/// Appends root R G B A, then each light's planes in order. The root is the float sum of the planes
/// in order; `alpha` is its A.
void set_layered_channels(Image& image, const std::vector<std::string>& lights,
                          std::vector<LightPlanes> planes, std::vector<float> alpha);

}  // namespace photile::image
