// Measures all grids of a run, several times.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "measuring/measurement.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/device.hpp"
#include "photile/illuminance.hpp"

namespace photile::measuring {

/// The readings of all grids' sensors, one grid after the other. Errors: those of `gather`.
Readings measure_grids(const Scene& scene, std::span<const SensorGrid> grids, const LightMix& mix,
                       std::span<Device> devices, const MeasuringParameters& parameters,
                       Progress& progress);

/// Scene::portals of the rooms of the grids, where light comes from beyond the scene.
///   asked   as SceneLoadOptions::portals
/// Errors: those of portals_asked_for.
std::vector<Portal> portals_of_grids(const Scene& scene, std::span<const SensorGrid> grids,
                                     std::span<const std::string> asked);

/// Sensors with a surface less than a centimetre in front of them: most are in furniture, or just
/// below a top.
std::size_t covered_sensors(const Scene& scene, std::span<const SensorGrid> grids);

}  // namespace photile::measuring
