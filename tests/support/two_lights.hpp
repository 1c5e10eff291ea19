// A mix of two lights, for tests of what powers do.
#pragma once

#include <string>

#include "photile/layered_picture.hpp"

namespace photile::test {

/// Powers in lumens.
inline LightMix two_lights(const std::string& first, double first_power, const std::string& second,
                           double second_power) {
  LightMix mix;
  mix.lights.resize(2);
  mix.lights[0].name = first;
  mix.lights[0].power = first_power;
  mix.lights[1].name = second;
  mix.lights[1].power = second_power;
  return mix;
}

}  // namespace photile::test
