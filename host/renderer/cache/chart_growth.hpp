// Which sided triangles share a chart of the light maps.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/scene.hpp"

namespace photile::cache {

struct ChartGrowth {
  /// Per sided triangle; none where the material stores no photons. Numbered in the order in which
  /// the charts were grown.
  std::vector<std::uint32_t> chart_of;
  std::vector<std::uint32_t> seed;  ///< per chart: the sided triangle whose plane it has
};

/// Charts grow from the largest triangles over shared edges, as far as the surface stays near the
/// plane of the first one and folds little, on the same sheet: the two sides of a plate, and plates
/// that lie on each other, are charts of their own. Charts of one sheet in one plane that touch
/// along edges only, as tiles do, are joined. Triangles that coincide share a chart. A rule of
/// geometry alone.
///   spacing         metres, > 0: how far a chart may leave its plane
///   angle_degrees   largest angle between the normals of neighbours on a sheet
ChartGrowth grow_charts(const Scene& scene, double spacing, double angle_degrees);

}  // namespace photile::cache
