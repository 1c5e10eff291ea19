// How light of the sky's patches reaches sensors, directly and over surface in cells: rays, and the
// coefficients that are summed from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/sensors.hpp"
#include "trace/portals.hpp"
#include "trace/random_stream.hpp"
#include "trace/sensors.hpp"
#include "weather/sky_patches.hpp"

namespace photile::daylight {

/// Lux at the point for each cd/m2 of a patch, by linear RGB.
struct VisiblePatch {
  std::uint32_t patch;  ///< the ground is the one after the sky's
  std::uint32_t batch;
  bool straight;  ///< through panes and cutouts at most
  glm::vec3 weight;
};

/// Lux at the point for each lux on a surface that reflects light to it.
struct VisibleSurface {
  trace::SurfacePoint point;
  std::uint32_t batch;
  float distance;     ///< metres along the ray
  float reflectance;  ///< all that the surface reflects towards the ray, of the brightest channel
  glm::vec3 weight;
};

struct VisibleByRays {
  std::vector<VisiblePatch> patches;
  std::vector<VisibleSurface> surfaces;
};

struct SkyRayParameters {
  int batches = 4;         ///< independent of each other
  std::uint64_t seed = 1;  ///< of the first batch
  int max_specular_depth;  ///< mirrors, glass and lobes that a ray follows
};

/// Half of a point's rays follow its cosine (the response of a sensor), half go through portals;
/// each counts by the density of both together (the balance heuristic of Veach and Guibas, 1995).
/// They go on by mirrors, glass and glossy lobes, and end on a surface's base or in the sky. At a
/// surface each ray keeps what the surface reflects, whichever way it goes: with weights that
/// differ by direction, rows of few rays would reflect more light than they get.
class SkyRays {
 public:
  /// References are kept.
  SkyRays(const RayScene& rays, const weather::PatchFinder& patches,
          const SkyRayParameters& parameters);

  /// What the rays of a point meet, in their order. Depends on the point, its number and the
  /// parameters only.
  ///   points   one, or several points of a surface, which take turns
  ///   number   of the point, below 2^31; no other point has it
  ///   rays     of each batch
  VisibleByRays from(std::span<const trace::Photometer> places, std::uint64_t number,
                     int rays) const;

 private:
  void follow(trace::RayOrigin origin, glm::vec3 direction, glm::vec3 weight, std::uint32_t batch,
              const trace::RandomStream& random, VisibleByRays& seen) const;

  const RayScene& rays_;
  const weather::PatchFinder& patches_;
  SkyRayParameters parameters_;
  trace::Portals portals_;
};

/// A point, as a row of the system E = D L + F E of radiosity (Goral et al. 1984), whose
/// coefficients rays find.
struct TransportRow {
  struct OfPatch {
    std::uint32_t patch;
    glm::vec3 all{0.0f}, straight{0.0f};  ///< lux for each cd/m2
  };
  struct OfCell {
    std::uint32_t cell, batch;
    glm::vec3 weight;  ///< lux for each lux on the cell
  };
  std::vector<OfPatch> patches;  ///< ascending
  /// By cell, then batch. Those of a cell's row sum to no more than the reflectance of the
  /// brightest surface that its rays end on.
  std::vector<OfCell> cells;
  std::vector<glm::vec3> mean_sky;  ///< lux under the mean sky, by batch
};

struct LightTransport {
  std::vector<TransportRow> sensors, cells;
  std::size_t patches = 0;  ///< those of the sky, then the ground
  int batches = 0;
  bool coloured = false;  ///< whether channels differ
};

struct TransportParameters {
  int rays = 256;  ///< of a sensor and batch
  SkyRayParameters sky;
  SensorResponse response = SensorResponse::planar;
  std::vector<double> mean_luminance;  ///< cd/m2 of the patches and the ground
};

/// Rays from the sensors end in cells; rays from these ends, in turn, tell what lights them.
///   sensors   in the scene's coordinates
LightTransport light_transport(const RayScene& rays, std::span<const Sensor> sensors,
                               const weather::PatchFinder& patches,
                               const TransportParameters& parameters, Progress& progress);

/// Lux for each cd/m2, by sensor, then patch: solved for all patches at once.
/// Errors: InputError where light between cells does not fade.
std::vector<float> lux_of_patches(const LightTransport& transport);

/// Lux under the mean sky, by batch, then sensor: what the rays of one batch alone find, to first
/// order in their difference from all rays. Errors: as above.
std::vector<std::vector<double>> lux_of_batches(const LightTransport& transport);

}  // namespace photile::daylight
