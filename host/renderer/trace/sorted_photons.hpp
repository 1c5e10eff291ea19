// Photons of many runs, brought into the order of their sided triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "photile/photons.hpp"
#include "trace/photon_path.hpp"

namespace photile::trace {

/// Photons of lights of one layer.
struct LayerRun {
  PhotonRun* photons;
  std::uint16_t layer;
};

/// Photons in the order of their sided triangles, those of one triangle in the order of the runs.
/// The runs are emptied on the way: beside them only the result exists, one array after the other.
///   tell_layers   fill Photons::light
Photons sorted_photons(std::span<const LayerRun> runs, bool tell_layers,
                       std::size_t sided_triangle_count);

}  // namespace photile::trace
