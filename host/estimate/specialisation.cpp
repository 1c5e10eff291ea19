#include "estimate/specialisation.hpp"

#include <algorithm>
#include <bit>

namespace photile::estimate {

device::Defines Specialisation::defines() const {
  device::Defines defines;
  defines.set("VECTOR_WIDTH", static_cast<long long>(vector_width));
  defines.set("CAPACITY", static_cast<long long>(capacity));
  if (multiple_lights) defines.set("MULTIPLE_LIGHTS");
  if (glossy) defines.set("GLOSSY");
  return defines;
}

Specialisation specialise(const DeviceInfo& device, const SceneNeeds& needs, int neighbours) {
  // A block holds about 4 / pi x 1.2 x k candidates and the overhang of its cells. 16 KiB of
  // private memory at most: CPU runtimes keep it on the stack.
  constexpr unsigned least = 128, most = 4096;
  Specialisation choice;
  choice.vector_width = device.type == DeviceType::cpu ? 16 : 1;
  choice.capacity = static_cast<int>(std::bit_ceil(
      std::clamp(3u * static_cast<unsigned>(std::min(neighbours, 4096)), least, most)));
  choice.multiple_lights = needs.light_count > 1;
  choice.glossy = needs.glossy;
  return choice;
}

}  // namespace photile::estimate
