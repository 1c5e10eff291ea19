#include "estimate/light_sums.hpp"

#include <algorithm>
#include <bit>

namespace photile::estimate {

LightSums::LightSums(const SceneNeeds& needs, std::uint32_t neighbours)
    : lights(needs.light_count),
      many_lights(needs.many_lights()),
      glossy(needs.glossy),
      per_hit(many_lights ? std::min(neighbours, lights) : lights),
      table(many_lights ? std::bit_ceil(std::min(2 * per_hit, lights)) : 0) {}

void LightSums::set_defines(device::Defines& defines) const {
  if (many_lights) {
    defines.set("LIGHT_SLOTS", static_cast<long long>(per_hit));
    defines.set("LIGHT_TABLE", static_cast<long long>(table));
  } else if (lights > 1) {
    defines.set("LIGHT_COUNT", static_cast<long long>(lights));
  }
}

std::size_t LightSums::table_bytes() const { return table * sizeof(std::uint16_t); }

std::size_t LightSums::private_bytes() const {
  if (many_lights) return table_bytes();
  return std::size_t{lights} * 3 * sizeof(float) * (glossy ? 2 : 1);
}

EstimateBytes LightSums::bytes_per_hit() const {
  const std::uint64_t largest = std::uint64_t{per_hit} * 3 * sizeof(float);
  std::uint64_t together = glossy ? 2 * largest : largest;
  if (many_lights) together += per_hit * sizeof(std::uint16_t) + sizeof(std::uint32_t);
  return {largest, together};
}

}  // namespace photile::estimate
