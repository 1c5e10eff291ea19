// The radiance estimate: k nearest photons of each primary hit, on the device.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/density_kernel.hpp"
#include "photile/estimate_tuning.hpp"
#include "photile/photon_maps.hpp"
#include "photile/primary_hits.hpp"
#include "photile/surface_index.hpp"

namespace photile {

/// What a density estimate divides by.
enum class AreaMode {
  disc,    ///< the disc through the k-th photon (Jensen 2001): dark at borders and in corners
  clipped  ///< the part of it that is surface which light reaches, near the hit's plane
};

/// "disc", "clipped".
std::string_view name_of(AreaMode area);
inline constexpr std::array all_area_modes = {AreaMode::disc, AreaMode::clipped};

struct EstimateParameters {
  int neighbours = defaults::neighbours;  ///< k
  /// Metres; 0 = the maps' radius. No neighbour is farther.
  double radius = 0;
  /// How uniform grids are queried; none = shipped_tuning of the device.
  std::optional<EstimateTuning> tuning = std::nullopt;
  /// Kernels are compiled for k up to this; 0 = `neighbours`. Estimators with different k share
  /// them; what they compute does not depend on it.
  int compiled_neighbours = 0;
  /// Naive maps, whose photons are those of one triangle, take the disc in any case.
  AreaMode area = AreaMode::clipped;
  /// What each photon counts; with one neighbour, 1.
  DensityKernel kernel = DensityKernel::constant;
  /// For clipped areas: of the scene, for the radius of the maps or a larger one and the angle of
  /// their groups. Estimators share it; none = the estimator makes its own.
  std::shared_ptr<const SurfaceIndex> surface = nullptr;
};

/// Estimates of a batch of hits, each light at power 1. Row-major [hit][light]; with more than
/// max_dense_lights lights only of those whose photons a hit found, at most min(k, lights).
struct Estimates {
  std::vector<glm::vec3> irradiance;  ///< W/m2 or lm/m2, linear RGB
  /// Reflected radiance towards the eye. Where it is empty, as photon maps leave it unless the
  /// scene is glossy, radiance is albedo / pi x irradiance.
  std::vector<glm::vec3> radiance;
  /// Luminance of irradiance by the normal, to first order: a plane of unit normal n there gets
  /// dot(xyz, n) + w. Only of nodes that rays value, in scenes with smooth shading.
  std::vector<glm::vec4> by_normal;

  // With many lights, else empty:
  std::vector<std::uint64_t> first;  ///< hit h's estimates are [first[h], first[h + 1])
  std::vector<std::uint16_t> light;  ///< of each estimate; each once per hit, in no order

  /// Appends the estimates of the hits that follow.
  void append(Estimates part);
};

/// Neighbours of a batch of hits: photon indices, ascending, `none` beyond the last.
struct NeighbourLists {
  int k = 0;
  std::vector<std::uint32_t> photons;  ///< hits x k
  std::vector<float> squared_radius;   ///< square of the estimate's radius, per hit
};

/// Runs the estimate kernels over photon maps. With k photons or more within the radius the
/// estimate is sum of the flux of the k - 1 nearest over the area of the disc through the k-th
/// (unbiased under constant density); with fewer, all of them over the disc of the full radius.
/// With a kernel each photon is weighted, and the area is the integral of the kernel over the disc.
/// Clipped areas: see docs/density.md.
class Estimator {
 public:
  /// Errors: UsageError when k, the radius or the tuning is out of range.
  Estimator(const PhotonMaps& maps, const Scene& scene, const EstimateParameters& parameters);
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  /// Radiance estimates; none depends on the other hits, in any bit. Hits in the order of their
  /// maps (trace_primary_hits with PhotonMaps::map_of) need not be sorted.
  Estimates estimate(const PrimaryHits& hits);

  /// The same for hits [first, first + count) alone.
  Estimates estimate(const PrimaryHits& hits, std::size_t first, std::size_t count);

  /// The neighbours themselves, for tests and inspection.
  NeighbourLists nearest(const PrimaryHits& hits);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile
