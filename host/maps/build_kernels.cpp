#include "maps/build_kernels.hpp"

#include "maps/entry_defines.hpp"

namespace photile::maps {

device::KernelSet build_kernels(const MapStore& store) {
  device::Defines defines;
  set_entry_defines(defines, store.needs);
  if (!store.map_of.empty()) defines.set("PATCHES");
  return {store.device->context(), "grid/build.cl", std::move(defines)};
}

}  // namespace photile::maps
