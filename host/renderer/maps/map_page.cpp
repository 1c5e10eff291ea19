#include "maps/map_page.hpp"

namespace photile::maps {

std::uint32_t bytes_per_light(const SceneNeeds& needs) {
  if (!needs.several_lights()) return 0;
  return needs.light_count <= 256 ? 1 : 2;
}

std::uint32_t bytes_per_record(const SceneNeeds& needs) {
  constexpr std::uint32_t vector = 3 * sizeof(float);  // position, flux, direction
  return 2 * vector + sizeof(std::uint32_t) + bytes_per_light(needs) + (needs.glossy ? vector : 0);
}

void set_record_defines(device::Defines& defines, const SceneNeeds& needs) {
  if (const std::uint32_t bytes = bytes_per_light(needs); bytes > 0) {
    defines.set("LIGHT_BYTES", static_cast<long long>(bytes));
  }
  if (needs.glossy) defines.set("GLOSSY");
}

}  // namespace photile::maps
