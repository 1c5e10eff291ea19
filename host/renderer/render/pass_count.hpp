// Into how many passes photons are split where they do not fit in memory at once.
#pragma once

#include <cstdint>

#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// Bytes installed, or the limit of the process's control group where that is less: the same on
/// every run, whatever else is running. The largest number where nothing is known.
std::uint64_t installed_host_bytes();

/// Host memory that one stored photon takes at most at a time: while it is traced and sorted, or
/// while its maps are built, a few references each. An estimate: references depend on the mesh.
std::uint64_t bytes_per_stored_photon(const SceneNeeds& needs);

/// Passes so that the photons of one take at most half of `memory_bytes`, and are not more than
/// can be indexed; at least 1.
///   stored_per_path   photons that a path leaves
int passes_within(std::uint64_t paths, double stored_per_path, std::uint64_t bytes_per_photon,
                  std::uint64_t memory_bytes);

/// Passes for `memory` bytes of all hosts together. Traces a few paths to know what one leaves;
/// says so in one line where there is more than one pass. Errors: UsageError where there would be
/// more than limits::max_passes.
int automatic_passes(const RayScene& rays, const PhotonTracerParameters& parameters,
                     Progress& progress, std::uint64_t memory);

}  // namespace photile
