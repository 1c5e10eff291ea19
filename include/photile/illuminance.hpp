// Illuminance at points, in lux, with its standard errors.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "photile/light_mix.hpp"
#include "photile/sensors.hpp"

namespace photile {

/// A value and the standard deviation that it would have over measurements like this one.
struct Measured {
  double value = 0;
  double standard_error = 0;
};

struct MeasuringParameters {
  GatherParameters gathering;
  int repeats = defaults::measuring_repeats;  ///< >= 2, each with its own seed
  bool by_paths = false;                      ///< and not by photon maps
  RenderParameters photons;                   ///< of each repeat, whose seeds follow from this one
  double maintenance = defaults::maintenance_factor;  ///< factor of all values
};

/// What one light, or all together, give.
struct LightIlluminance {
  std::string light;              ///< "" for all together
  std::vector<Measured> sensors;  ///< lux, in the order of the sensors
};

/// What `photile measure` prints: `gather`, or gather_by_paths, repeated with random numbers of
/// their own, whose mean is the value and whose scatter tells the standard error.
///   sensors   in the scene file's world
///   mix       powers of all lights of the scene
///   devices   may be empty for paths
/// Returns all lights together first, then each one of the mix. Errors: those of `gather`;
/// UsageError for fewer than two repeats; InputError naming a light whose lux no number holds.
std::vector<LightIlluminance> measure_illuminance(const Scene& scene,
                                                  std::span<const Sensor> sensors,
                                                  const LightMix& mix, std::span<Device> devices,
                                                  const MeasuringParameters& parameters,
                                                  Progress& progress = Progress::none());

}  // namespace photile
