// The order of primary hits: by photon map, then along a Morton curve.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.hpp"
#include "trace/eye_path.hpp"

namespace photile::trace {

/// The cells of a box, equally many along each axis, by which hits on one map are sorted.
class HitCells {
 public:
  /// So that code and map together, which is below 2^30 (limits::max_triangles), fit 64 bits.
  static constexpr int bits_per_axis = 11;

  explicit HitCells(const geometry::Box& box);

  /// Along the Morton curve. Positions outside count as on the border.
  std::uint64_t morton_code(const glm::vec3& position) const;

 private:
  glm::vec3 low_;
  glm::vec3 cells_per_metre_{0.0f};  ///< 0 along an axis where the box is flat
};

/// One of the hits of several records.
struct HitPlace {
  std::uint32_t record;
  std::uint32_t index;  ///< into EyeRecord::hits
};

/// All hits in the order map, Morton code of their cell of `box`, place.
///   map_of   per sided triangle, `none`, which is the last, where it has no map; empty where a
///            sided triangle is the map itself
std::vector<HitPlace> sorted_places(std::span<const EyeRecord> records, const geometry::Box& box,
                                    std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
