// Light measured at chosen points, as a photometer would, by photon maps or by paths.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// How a sensor in the air weighs light by where it comes from.
enum class SensorResponse {
  planar,       ///< cosine to the normal: illuminance of a plane
  cylindrical,  ///< sine to the normal over pi: illuminance of a small upright cylinder, the mean
                ///< of all planes that contain the normal (EN 12464-1)
  /// (1 + cos alpha) sine over pi, alpha being the angle round the normal to `facing`: the half
  /// cylinder that faces that direction (EN 13201-3)
  semi_cylindrical
};

/// A point where light is measured.
struct Sensor {
  glm::dvec3 position{0.0};          ///< metres
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit; also the direction from which radiance is measured
  /// `gather` only. False: light directly from lights within the scene, or through panes, is left
  /// out: what remains is indirect light, and that of sun and sky.
  bool sees_lights = true;
  std::optional<SensorResponse> response = std::nullopt;  ///< `gather` only; none = its own
  glm::dvec3 facing{1.0, 0.0, 0.0};  ///< of half a cylinder: unit, at a right angle to `normal`
};

/// A sensor of the file's world in the scene's own coordinates.
Sensor in_scene(const Scene& scene, Sensor sensor);

/// The light at sensors on opaque surfaces that face their normals, within a millimetre, by
/// `render`: the result's layers are one row high, sensor i is pixel i.
/// `parameters.film` is ignored. Errors: those of `render`; InputError that names a sensor
/// without an opaque surface.
RenderResult measure(const Scene& scene, std::span<const Sensor> sensors, std::span<Device> devices,
                     const RenderParameters& parameters, Progress& progress = Progress::none());

/// Measures the sensors by `trace_paths`, from `paths` paths of each sensor.
PathTracerResult measure_by_paths(const Scene& scene, std::span<const Sensor> sensors, int paths,
                                  std::uint64_t seed, Progress& progress = Progress::none());

struct GatherParameters {
  SensorResponse response = SensorResponse::planar;
  int rays = defaults::measuring_rays;  ///< of each sensor
};

/// The light at sensors anywhere, on a surface or in the air: lights by rays to them, reflected
/// light by rays to the surfaces around, whose radiance `render` estimates (final gather: Jensen,
/// "Realistic image synthesis using photon mapping", 2001, chapter 9). The result's layers are one
/// pixel wide, sensor i is row i: `radiance` is irradiance / pi, W/(m2 sr) or cd/m2 of a white
/// plate there, and `illuminance` the luminance of irradiance. What mirrors and refracting glass
/// throw onto a sensor from point, spot and directional lights is missing, see has_hidden_caustics.
/// `parameters.film` is ignored. Errors: those of `render`; UsageError for rays out of
/// limits.hpp.
RenderResult gather(const Scene& scene, std::span<const Sensor> sensors,
                    const GatherParameters& gathering, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress = Progress::none());

/// Gathers by `trace_paths`: unbiased, one path from each ray's end.
PathTracerResult gather_by_paths(const Scene& scene, std::span<const Sensor> sensors,
                                 const GatherParameters& gathering, std::uint64_t seed,
                                 Progress& progress = Progress::none());

/// A value and the standard deviation that it would have over measurements like this one.
struct Measured {
  double value = 0;
  double standard_error = 0;
};

struct MeasuringParameters {
  GatherParameters gathering;
  int repeats = defaults::measuring_repeats;  ///< >= 2, each with its own seed
  bool by_paths = false;                      ///< instead of by photon maps
  RenderParameters photons;  ///< of each repeat; their seeds are derived from this one
  double maintenance = defaults::maintenance_factor;  ///< factor of all values
};

/// The readings of one light, or of all together.
struct LightIlluminance {
  std::string light;              ///< "" for all together
  std::vector<Measured> sensors;  ///< lux, in the order of the sensors
};

/// What `photile measure` prints: `gather`, or gather_by_paths, repeated with different random
/// numbers; the mean is the value, and the scatter gives the standard error.
///   sensors   in the scene file's world
///   mix       powers of all lights of the scene
///   devices   may be empty for paths
/// Returns all lights together first, then each one of the mix. Errors: those of `gather`;
/// UsageError for fewer than two repeats; InputError naming a light whose lux overflows.
std::vector<LightIlluminance> measure_illuminance(const Scene& scene,
                                                  std::span<const Sensor> sensors,
                                                  const LightMix& mix, std::span<Device> devices,
                                                  const MeasuringParameters& parameters,
                                                  Progress& progress = Progress::none());

}  // namespace photile
