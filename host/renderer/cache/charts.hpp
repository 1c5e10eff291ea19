// Charts of the light maps: planes with lattices, the surface that lies under each, and which
// oriented faces share one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "common/index_rows.hpp"
#include "geometry/box_tree.hpp"
#include "photile/scene.hpp"
#include "scene/coincident_faces.hpp"
#include "trace/surface.hpp"

namespace photile::cache {

/// A plane with a lattice over the oriented faces of a chart. Lattice positions are counted in
/// cells of the coarsest level; the triangles' projections lie in [0, columns] x [0, rows].
struct Chart {
  glm::dvec3 origin{0.0};               ///< of the lattice, metres
  glm::dvec3 across{0.0}, along{0.0};   ///< unit, orthogonal, in the plane
  glm::dvec2 spacing{0.0};              ///< of the coarsest nodes, metres
  std::uint32_t columns = 1, rows = 1;  ///< cells of the coarsest level
  std::uint32_t first_root = 0;         ///< its tiles of the coarsest level: [first_root ..)
  std::uint32_t root_columns() const { return (columns + 7) / 8; }
  std::uint32_t root_rows() const { return (rows + 7) / 8; }
  /// The shorter side of its rectangle, metres.
  double width() const { return std::min(columns * spacing.x, rows * spacing.y); }
};

/// The lattice position of a point, for queries: a float each, in cells of the coarsest level.
struct LatticeCoordinates {
  glm::vec3 across{0.0f};
  float across_offset = 0;
  glm::vec3 along{0.0f};
  float along_offset = 0;

  glm::vec2 of(const glm::vec3& position) const {
    return {glm::dot(across, position) + across_offset, glm::dot(along, position) + along_offset};
  }
};

/// A node: a position of the finest lattice of a chart, which all coarser ones share.
struct NodeCoordinates {
  std::uint32_t chart, x, y;  ///< x, y in cells of the finest level
  friend bool operator==(const NodeCoordinates&, const NodeCoordinates&) = default;
};

/// The charts of a scene, by a rule of geometry alone.
///
/// The frame of a chart is the one that encloses it most tightly, among the directions of its first
/// triangle's edges and of the axes, and the spacing divides the sides of that rectangle evenly:
/// the borders of a rectangular wall, and the corners of a triangle smaller than the spacing, are
/// nodes.
class Charts {
 public:
  ///   spacing         metres, > 0: of the coarsest nodes, at most
  ///   angle_degrees   largest angle between the normals of neighbours in a smooth component
  /// Where this would give too many lattices, the spacing is larger.
  Charts(const Scene& scene, double spacing, double angle_degrees);

  std::size_t size() const { return charts_.size(); }
  const Chart& operator[](std::size_t chart) const { return charts_[chart]; }
  /// Per oriented face; none where no photons are stored.
  std::span<const std::uint32_t> chart_of() const { return chart_of_; }
  const LatticeCoordinates& lattice(std::size_t chart) const { return lattices_[chart]; }
  double spacing() const { return spacing_; }
  const scene::CoincidentFaces& coincident() const { return coincident_; }
  std::uint32_t roots() const { return roots_; }
  std::uint64_t bytes() const;

  /// Makes `support` of nodes on this chart quick. Two threads must not call it for the same chart.
  void prepare(std::uint32_t chart);

  struct Support {
    trace::TriangleHit where;
    std::uint32_t side;
  };
  /// The surface that a node stands for: the triangle of the chart whose projection is nearest to
  /// it, the lowest of several at one distance, and the nearest point of that, moved a little
  /// towards its middle, because at an edge it would be undefined on which side of a wall the node
  /// is. So a node beyond an edge, or in a hole, stands for the surface at the edge. `prepare` must
  /// have been called.
  ///   levels   of refinement: spacing / 2^(levels - 1) is the finest
  Support support(const NodeCoordinates& node, int levels) const;
  /// The surface that any position of the chart stands for.
  ///   position   the position, metres from its origin, across and along
  ///   reach   metres: surface within this distance is found fastest
  Support support(std::uint32_t chart, const glm::dvec2& position, double reach) const;

  /// The cell of the coarsest lattice that a position lies in, or the nearest one.
  glm::uvec2 cell_at(std::uint32_t chart, const glm::vec2& position) const {
    const auto along = [](float at, std::uint32_t cells) {
      return std::min(static_cast<std::uint32_t>(std::max(at, 0.0f)), cells - 1);
    };
    return {along(position.x, charts_[chart].columns), along(position.y, charts_[chart].rows)};
  }

 private:
  void frame(std::uint32_t chart, std::uint32_t seed);
  glm::dvec2 in_plane(const Chart& chart, const glm::vec3& point) const;

  const Scene& scene_;
  scene::CoincidentFaces coincident_;
  double spacing_;
  std::vector<std::uint32_t> chart_of_;
  IndexRows members_;  ///< oriented faces of the charts
  std::vector<Chart> charts_;
  std::vector<LatticeCoordinates> lattices_;
  std::vector<std::unique_ptr<geometry::BoxTree>>
      trees_;  ///< of charts of many triangles, prepared
  std::uint32_t roots_ = 0;
};

struct ChartGrowth {
  /// Per oriented face; none where the material stores no photons. Numbered in the order in which
  /// the charts were grown.
  std::vector<std::uint32_t> chart_of;
  std::vector<std::uint32_t> seed;  ///< per chart: the oriented face whose plane it has
};

/// Charts grow from the largest triangles over shared edges, as far as the surface stays near the
/// plane of the first one and folds little, and over edges that run along each other, like those of
/// tiles, where it does not fold: the two sides of a plate, and plates that lie on each other, are
/// separate charts. Triangles that coincide share a chart. A rule of geometry alone.
///   spacing         metres, > 0: how far a chart may leave its plane
///   angle_degrees   largest angle between the normals of neighbours in a smooth component
ChartGrowth grow_charts(const Scene& scene, double spacing, double angle_degrees);

}  // namespace photile::cache
