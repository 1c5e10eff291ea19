#include "estimate/specialisation.hpp"

#include <algorithm>

namespace photile::estimate {

device::Defines Specialisation::defines() const {
  device::Defines defines;
  defines.set("VECTOR_WIDTH", static_cast<long long>(vector_width));
  defines.set("CAPACITY", static_cast<long long>(capacity));
  defines.set("HITS_PER_ITEM", static_cast<long long>(hits_per_item));
  if (multiple_lights) defines.set("MULTIPLE_LIGHTS");
  if (glossy) defines.set("GLOSSY");
  return defines;
}

Specialisation specialise(const DeviceInfo& device, const SceneNeeds& needs, int neighbours) {
  // A block holds about 4 / pi x 1.2 x k candidates and the overhang of its cells. Counts of what
  // is kept share 32 bits in threes, hence the upper limit.
  constexpr int least = 128, most = 1008, vector = 16;
  Specialisation choice;
  choice.vector_width = device.type == DeviceType::cpu ? 16 : 1;
  const int wanted = std::min(neighbours, most) * 3;
  choice.capacity = std::clamp((wanted + vector - 1) / vector * vector, least, most);
  choice.hits_per_item = device.type == DeviceType::cpu ? 16 : 1;
  choice.multiple_lights = needs.light_count > 1;
  choice.glossy = needs.glossy;
  return choice;
}

}  // namespace photile::estimate
