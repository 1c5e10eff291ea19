// Primary hits in batches: pixel by pixel; those of a pixel by photon map and along a Morton curve.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/index_rows.hpp"
#include "geometry/box.hpp"
#include "photile/ray_scene.hpp"
#include "trace/eye_path.hpp"

namespace photile::trace {

/// The elements that belong to each of a range of pixels, in order.
template <class PixelOf>
IndexRows by_pixel(std::size_t elements, std::size_t first_pixel, std::size_t pixels,
                   const PixelOf& pixel_of) {
  return rows_of(pixels, [&](const auto& put) {
    for (std::uint32_t i = 0; i < elements; ++i) put(pixel_of(i) - first_pixel, i);
  });
}

/// The cells of a box, equally many along each axis, by which hits on one map are sorted.
class HitCells {
 public:
  /// Code and map, which is below 2^30 (limits::max_triangles), then fit 64 bits together.
  static constexpr int bits_per_axis = 11;

  explicit HitCells(const geometry::Box& box);

  /// The position along the Morton curve. Positions outside count as on the border.
  std::uint64_t morton_code(const glm::vec3& position) const;

 private:
  glm::vec3 low_;
  glm::vec3 cells_per_metre_{0.0f};  ///< 0 along an axis where the box is flat
};

/// The hits of all records, one record after the other.
PrimaryHits hits_of(std::span<const EyeRecord> records);

/// The hits of all rows in the order of PrimaryHits, and the emission by layer instead of by light.
/// Does not depend on how samples are split into rows.
///   rows     each with separate pixels, one pixel after the other
///   runs     of a pixel: see PrimaryHitParameters
///   map_of   as in trace_primary_hits
PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows, int runs,
                         std::span<const std::uint32_t> map_of);

/// The part of trace_primary_hits, with the same samples, that comes by a mirror, by glass that
/// bends or reflects it, or by a glossy lobe: hits behind those unchanged, hits that are seen
/// directly (or through panes of thin glass) with their lobe alone, and lights seen directly not at
/// all. This part and the part left out add up to the whole.
PrimaryHitBatch trace_reflected_hits(const RayScene& scene, const Camera& camera,
                                     const PrimaryHitParameters& parameters, int first_row,
                                     int last_row, std::span<const std::uint32_t> map_of = {});

}  // namespace photile::trace
