// The light that rays find where they end: photon estimates that ends in one cell share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gather/batch_sums.hpp"
#include "gather/end_cells.hpp"
#include "photile/estimator.hpp"
#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"
#include "render/map_estimators.hpp"
#include "trace/hemisphere_rays.hpp"

namespace photile::gathering {

/// Photon estimates at some of the ends of rays.
struct EndEstimates {
  PrimaryHits hits;
  Estimates estimates;  ///< of each hit
};

/// Where the rays of a run of points end, and which estimate counts there.
struct IndirectLight {
  trace::HemisphereRays rays;
  std::vector<std::uint32_t> estimate;  ///< of each end: a cell, or one of its own (own_estimate)
  std::vector<glm::vec3> weight;        ///< of each end: of the cell's irradiance, or of radiance
  EndEstimates own;                     ///< of the run

  /// Marks estimates of an end alone; other numbers are cells.
  static constexpr std::uint32_t own_estimate = 0x8000'0000u;
};

/// Irradiance in cells where rays end, looked up when the first ends there.
class CellLight {
 public:
  /// References are kept.
  ///   side   of the largest cells, metres
  CellLight(const RayScene& rays, MapEstimators& photons, double side)
      : rays_(rays), photons_(photons), side_(side) {}

  /// Finds an estimate for each end.
  ///   points, first   the points and the first of the run that the rays left
  /// Errors: as DeviceEstimators.
  IndirectLight look_up(trace::HemisphereRays rays, const PrimaryHits& points, std::size_t first);

  /// Adds what the rays of a point of the run see, its batches having so many rays each.
  void add_point(const IndirectLight& light, std::size_t point, std::uint32_t batches,
                 std::uint32_t rays_per_batch, BatchSums& sums) const;

  /// What all calls took so far.
  struct Costs {
    double cell_seconds = 0;      ///< finding cells
    double estimate_seconds = 0;  ///< looking photons up
    std::uint64_t rays = 0;       ///< traced; those along mirrors and glass included
    std::uint64_t ends = 0;
    std::uint64_t estimated = 0;  ///< ends where photons were looked up
  };
  const Costs& costs() const { return costs_; }

 private:
  void classify(IndirectLight& light, const PrimaryHits& points, std::size_t first,
                std::vector<CellKey>& keys, std::vector<std::uint8_t>& has_own) const;
  EndEstimates estimates_at(const trace::EyeRecord& ends, std::span<const std::uint32_t> chosen);

  const RayScene& rays_;
  MapEstimators& photons_;
  double side_;
  EndCells cells_;
  Estimates irradiance_;  ///< of each cell
  Costs costs_;
};

}  // namespace photile::gathering
