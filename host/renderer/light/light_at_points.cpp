#include "light/light_at_points.hpp"

#include <algorithm>

#include "photile/light_layers.hpp"

namespace photile::light {

std::vector<double> layer_powers(const Scene& scene) {
  std::vector<double> powers;
  for (const LightGroup& group : light_groups_of(scene).groups) powers.push_back(group.power);
  if (std::all_of(powers.begin(), powers.end(), [](double power) { return power == 0; })) {
    std::fill(powers.begin(), powers.end(), 1.0);
  }
  return powers;
}

}  // namespace photile::light
