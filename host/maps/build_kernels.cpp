#include "maps/build_kernels.hpp"

#include "maps/entry_defines.hpp"

namespace photile::maps {

device::KernelSet build_kernels(const MapStore& store, bool patches) {
  device::Defines defines;
  set_entry_defines(defines, store.needs);
  if (patches) defines.set("PATCHES");
  return {device::context_of(*store.device), "grid/build.cl", std::move(defines)};
}

device::KernelSet tile_kernels(const MapStore& store) {
  return {device::context_of(*store.device), "grid/build_tiles.cl", {}};
}

}  // namespace photile::maps
