// The radiance estimate: k nearest photons of each primary hit, on the device.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/device.hpp"
#include "photile/light_table.hpp"
#include "photile/photon_maps.hpp"
#include "photile/ray_scene.hpp"
#include "photile/surface_index.hpp"

namespace photile {

/// How the k nearest photons are selected. All find the same neighbours.
enum class EstimateStrategy {
  select,  ///< distances of a block of cells in one pass, the k-th by radix selection; no list
  lanes    ///< as `select`, by a group of work-items that are the lanes of a vector: for GPUs
};

inline constexpr std::array all_estimate_strategies = {EstimateStrategy::select,
                                                       EstimateStrategy::lanes};

/// "select", "lanes".
std::string_view name_of(EstimateStrategy strategy);

/// Which kernel an estimate runs, and how wide. Only the speed depends on it, and, through the
/// order of float sums, the last bits of a picture.
struct EstimateTuning {
  EstimateStrategy strategy = EstimateStrategy::select;
  int vector_width = 1;  ///< floats per vector: 1, 4, 8 or 16; of `lanes` 16, 32 or 64 work-items
  /// Neighbouring hits that a work-item, or a group of `lanes`, estimates in turn.
  int hits_per_item = 1;
  /// Work-items; fewer where their private memory would be too much. That of `lanes` is the width.
  int work_group_size = 64;
  /// `lanes` of 16 or 32 on devices with shuffles: whether they exchange values by these instead of
  /// local memory and barriers. Results have the same bits.
  bool shuffles = false;

  friend bool operator==(const EstimateTuning&, const EstimateTuning&) = default;
};

/// The tuning that estimators use by default: vector width 16 on every CPU, whatever its native
/// width, so that pictures agree in every bit between CPUs; elsewhere `lanes`: of 16 work-items
/// where the device has shuffles, else of as many as it runs in lockstep, or of 32 where that is
/// unknown.
EstimateTuning shipped_tuning(const DeviceInfo& device);

/// The default tuning of a strategy, in the width that suits it on the device.
EstimateTuning shipped_tuning(const DeviceInfo& device, EstimateStrategy strategy);

/// The weight of a photon at distance d, where the k-th lies at r (Silverman, "Density Estimation
/// for Statistics and Data Analysis", 1986; Jensen, "Global Illumination using Photon Maps", 1996).
/// The estimate divides by the integral of the kernel over the area; see docs/method/density.md.
enum class DensityKernel {
  constant,  ///< 1: less noise
  cone       ///< 1 - d / r: less blur
};

/// "constant", "cone".
std::string_view name_of(DensityKernel kernel);
inline constexpr std::array all_density_kernels = {DensityKernel::constant, DensityKernel::cone};

/// The weight of a photon, given its squared distance over that of the k-th photon.
inline double kernel_weight(DensityKernel kernel, double relative_squared) {
  switch (kernel) {
    case DensityKernel::constant:
      return 1;
    case DensityKernel::cone:
      return 1 - std::sqrt(relative_squared);
  }
  return 0;
}

/// Mean square over squared mean of the weights on a disc: the factor by which a kernel raises the
/// variance of an estimate.
inline double kernel_spread(DensityKernel kernel) {
  switch (kernel) {
    case DensityKernel::constant:
      return 1;
    case DensityKernel::cone:
      return 3.0 / 2;
  }
  return 0;
}

/// The kernel that is used with k neighbours: a single photon lies at r, where the other kernels
/// are 0.
inline DensityKernel kernel_used(DensityKernel kernel, int neighbours) {
  return neighbours > 1 ? kernel : DensityKernel::constant;
}

/// The kernel of caustics, whose photons fill their paths evenly: the estimate of a kernel that
/// vanishes at its border then has little noise, and does not depend on where the k-th photon
/// happens to lie.
inline constexpr DensityKernel caustic_kernel = DensityKernel::cone;

/// The area that a density estimate divides by.
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
  /// How the photon maps are queried; none = shipped_tuning of the device.
  std::optional<EstimateTuning> tuning = std::nullopt;
  /// Kernels are compiled for k up to this; 0 = `neighbours`. Estimators with different k share
  /// them; what they compute does not depend on it.
  int compiled_neighbours = 0;
  /// Naive maps, whose photons are those of one triangle, always use the disc.
  AreaMode area = AreaMode::clipped;
  /// The weight of each photon; with one neighbour, 1.
  DensityKernel kernel = DensityKernel::constant;
  /// For clipped areas: the index of the scene, for the radius of the maps or a larger one, and the
  /// angle of their groups. Estimators may share it; null = the estimator makes its own.
  std::shared_ptr<const SurfaceIndex> surface = nullptr;
};

/// The order in which a list of neighbours is requested.
enum class ListOrder {
  ascending,  ///< by photon index: the same on every device
  any         ///< not sorted, which takes half of the time
};

/// Neighbours of a batch of hits: photon indices, `none` beyond the last.
struct NeighbourLists {
  int k = 0;
  std::vector<std::uint32_t> photons;  ///< hits x k
  std::vector<float> squared_radius;   ///< square of the estimate's radius, per hit
};

/// Runs the estimate kernels over photon maps. With k photons or more within the radius the
/// estimate is sum of the flux of the k - 1 nearest over the area of the disc through the k-th
/// (unbiased under constant density); with fewer, all of them over the disc of the full radius.
/// With a kernel each photon is weighted, and the area is the integral of the kernel over the disc.
/// Clipped areas: see docs/method/density.md.
class Estimator {
 public:
  /// Errors: UsageError when k, the radius or the tuning is out of range.
  Estimator(const PhotonMaps& maps, const Scene& scene, const EstimateParameters& parameters);
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  /// Radiance estimates, none of which depends on the other hits in any bit. Hits may be in any
  /// order: the kernels process them map by map.
  LightTable estimate(const PrimaryHits& hits);

  /// Estimates hits [first, first + count) alone.
  LightTable estimate(const PrimaryHits& hits, std::size_t first, std::size_t count);

  /// The neighbours themselves, for tests and inspection.
  NeighbourLists nearest(const PrimaryHits& hits, ListOrder order = ListOrder::ascending);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile
