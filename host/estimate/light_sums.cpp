#include "estimate/light_sums.hpp"

#include <algorithm>
#include <bit>

namespace photile::estimate {
namespace {

/// Places of the hash table that finds a light's slot: half of them stay empty, unless each light
/// has its own.
std::uint32_t light_table(const SceneNeeds& needs, std::uint32_t neighbours) {
  return std::bit_ceil(std::min(2 * estimates_per_hit(needs, neighbours), needs.light_count));
}

}  // namespace

std::uint32_t estimates_per_hit(const SceneNeeds& needs, std::uint32_t neighbours) {
  return needs.many_lights() ? std::min(neighbours, needs.light_count) : needs.light_count;
}

void set_sum_defines(device::Defines& defines, const SceneNeeds& needs, std::uint32_t neighbours) {
  if (needs.many_lights()) {
    defines.set("MANY_LIGHTS");
    defines.set("LIGHT_SLOTS", static_cast<long long>(estimates_per_hit(needs, neighbours)));
    defines.set("LIGHT_TABLE", static_cast<long long>(light_table(needs, neighbours)));
  } else if (needs.several_lights()) {
    defines.set("LIGHT_COUNT", static_cast<long long>(needs.light_count));
  }
}

std::size_t private_sum_bytes(const SceneNeeds& needs, std::uint32_t neighbours) {
  if (needs.many_lights()) return light_table(needs, neighbours) * sizeof(std::uint16_t);
  return needs.light_count * 3 * sizeof(float) * (needs.glossy ? 2 : 1);
}

}  // namespace photile::estimate
