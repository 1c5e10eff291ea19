#include "photile/photon_maps.hpp"

#include <fmt/format.h>

#include <cmath>

#include "maps/build_uniform_grid.hpp"
#include "maps/uniform_grid.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"

namespace photile {
namespace {

void check(const Photons& photons, const NeighbourGroups& groups,
           const PhotonMapParameters& parameters) {
  if (!(parameters.radius > 0) || !std::isfinite(parameters.radius)) {
    throw UsageError(fmt::format("radius {} m: must be a positive number", parameters.radius));
  }
  if (parameters.radius > groups.radius) {
    throw UsageError(fmt::format("radius {} m is larger than the neighbour groups' {} m",
                                 parameters.radius, groups.radius));
  }
  if (!(parameters.photons_per_cell > 0) || !std::isfinite(parameters.photons_per_cell)) {
    throw UsageError(
        fmt::format("photons per cell {}: must be a positive number", parameters.photons_per_cell));
  }
  if (photons.size() > limits::max_stored_photons) {
    throw UsageError(fmt::format("{} stored photons; at most {} can be indexed", photons.size(),
                                 limits::max_stored_photons));
  }
}

}  // namespace

PhotonMaps::PhotonMaps(Device& device, const Scene& scene, const Photons& photons,
                       const NeighbourGroups& groups, const PhotonMapParameters& parameters,
                       Progress& progress)
    : grid_(std::make_unique<maps::UniformGrid>()) {
  check(photons, groups, parameters);
  const Stopwatch stopwatch;
  progress.begin("build photon maps", 0, "references");
  grid_->device = &device;
  grid_->needs = needs_of(scene);
  grid_->parameters = parameters;
  maps::build_uniform_grid(*grid_, scene, photons, groups, progress);
  grid_->statistics.seconds = stopwatch.seconds();
  progress.end();
}

PhotonMaps::~PhotonMaps() = default;
PhotonMaps::PhotonMaps(PhotonMaps&&) noexcept = default;
PhotonMaps& PhotonMaps::operator=(PhotonMaps&&) noexcept = default;

const PhotonMapStatistics& PhotonMaps::statistics() const { return grid_->statistics; }
const PhotonMapParameters& PhotonMaps::parameters() const { return grid_->parameters; }
Device& PhotonMaps::device() const { return *grid_->device; }

}  // namespace photile
