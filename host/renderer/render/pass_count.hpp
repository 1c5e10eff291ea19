// Into how many passes photons are split where they do not fit in memory at once, and how the
// estimate narrows from pass to pass.
#pragma once

#include <cstdint>

#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// The parameters of the estimate in one photon pass.
struct PassEstimate {
  double radius = 0;   ///< metres
  int neighbours = 0;  ///< k
};

/// The estimate of pass `pass` (from 0), given that of the first.
///
/// The mean of passes is consistent where both its bias and its variance vanish. Knaus and Zwicker,
/// "Progressive photon mapping: a probabilistic approach" (2011), shrink the radius by
/// R_{i+1}^2 = R_i^2 (i + alpha) / (i + 1), i = 1, 2, ...; then after n passes the bias is
/// O(n^{alpha - 1}) and the variance O(n^{-alpha}). The disc of k nearest of equally many photons
/// has an area in proportion to k, so that k shrinks by the same factor; it ends at
/// defaults::least_pass_neighbours (or the first k, where that is less), from where on only the
/// radius shrinks.
PassEstimate estimate_of_pass(int pass, const PassEstimate& first);

/// Bytes installed, or the limit of the process's control group where that is less: the same on
/// every run, whatever else is running. The largest number where it is unknown.
std::uint64_t installed_host_bytes();

/// The most host memory that one stored photon takes at a time: while it is traced and sorted, or
/// while its maps are built, a few references each. An estimate: references depend on the mesh.
std::uint64_t bytes_per_stored_photon(const SceneNeeds& needs);

/// The number of passes for which the photons of one take at most half of `memory_bytes`, and are
/// not more than can be indexed; at least 1.
///   stored_per_path   photons that a path stores
int passes_within(std::uint64_t paths, double stored_per_path, std::uint64_t bytes_per_photon,
                  std::uint64_t memory_bytes);

/// The number of passes for `memory` bytes of all hosts together. Traces a few paths to find out
/// how many photons one stores; reports in one line where there is more than one pass. Errors:
/// UsageError where there would be more than limits::max_passes.
int automatic_passes(const RayScene& rays, const PhotonTracerParameters& parameters,
                     Progress& progress, std::uint64_t memory);

/// Reports the memory of a picture that takes more than a gigabyte. Errors: UsageError for one that
/// takes more than is installed.
void check_picture_memory(int width, int height, std::size_t lights, double bytes,
                          Progress& progress);
/// The same before anything is traced for it, where each pixel has all lights of the scene.
void check_picture_memory(int width, int height, const Scene& scene, Progress& progress);

}  // namespace photile
