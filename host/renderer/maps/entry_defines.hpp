// The symbols by which kernels know what the photon records of a scene hold.
#pragma once

#include <cstdint>

#include "device/context.hpp"
#include "photile/scene_needs.hpp"

namespace photile::maps {

/// Bytes of an entry's light: 0 with one light, 1 up to 256, else 2.
std::uint32_t bytes_per_light(const SceneNeeds& needs);

/// Bytes of an entry in all of its buffers, but for the normals of mixed maps: docs/kernels.md,
/// "Records".
std::uint32_t bytes_per_entry(const SceneNeeds& needs);

/// LIGHT_BYTES and GLOSSY, each where the scene needs it.
void set_entry_defines(device::Defines& defines, const SceneNeeds& needs);

}  // namespace photile::maps
