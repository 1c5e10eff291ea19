#include "maps/entry_defines.hpp"

namespace photile::maps {

std::uint32_t bytes_per_light(const SceneNeeds& needs) {
  if (needs.light_count <= 1) return 0;
  return needs.light_count <= 256 ? 1 : 2;
}

void set_entry_defines(device::Defines& defines, const SceneNeeds& needs) {
  if (const std::uint32_t bytes = bytes_per_light(needs); bytes > 0) {
    defines.set_word("LIGHT_INDEX", bytes == 1 ? "uchar" : "ushort");
  }
  if (needs.glossy) defines.set("GLOSSY");
}

}  // namespace photile::maps
