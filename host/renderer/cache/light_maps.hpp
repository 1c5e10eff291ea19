// Light maps: irradiance stored at nodes on the surface, and interpolated between them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "cache/charts.hpp"
#include "cache/node_batch.hpp"
#include "cache/node_source.hpp"
#include "cache/tiles.hpp"
#include "photile/communicator.hpp"
#include "photile/defaults.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile::trace {
struct SurfaceLocation;
}

namespace photile::cache {

struct LightMapParameters {
  double spacing = defaults::light_map_spacing;  ///< metres, > 0: of the coarsest nodes, at most
  int levels = defaults::light_map_levels;       ///< the finest is spacing / 2^(levels - 1)
  /// The number of coarsest levels that are split everywhere and have no nodes. The next level then
  /// counts as the coarsest, and points have the same numbers as with fewer skipped levels and
  /// correspondingly fewer levels.
  int skipped_levels = 0;
  double angle_degrees = defaults::group_angle_degrees;  ///< of neighbours in a smooth component
  /// Cells are split where their corners differ by this part of the brightest, and by its noise.
  double contrast = defaults::light_map_contrast;
  /// Where the source knows the distance of the surroundings: cells larger than this fraction of it
  /// are split at a quarter of the contrast.
  double near = defaults::light_map_near;
  double neighbours = defaults::neighbours;  ///< noise is 1 / sqrt of this many photons ...
  /// ... and of fewer below this irradiance at the lights' powers, where fewer are found.
  double sparse_irradiance = 0;
  std::vector<double> powers;  ///< per layer of the scene, at which cells are compared
  /// Processes that fill the same light maps, each for its own hits; every process has all nodes.
  /// Null: this process alone.
  Communicator* processes = nullptr;
};

/// Light maps for photons of this density: nodes lie as far apart as the photons that a typical
/// estimate takes, at the coarsest level, in steps of two.
///   neighbours   k
///   radius       of the photon maps, metres. One so small that estimates find no photon makes
///                nodes no closer than photons
///   spacing      metres, > 0: of the coarsest nodes; 0 = by the photons
///   detail       metres, > 0: spacing of the finest nodes, at most; 0 = an eighth of the coarsest
///   powers       per layer of the scene
LightMapParameters light_map_parameters(const Scene& scene, const Photons& photons, int neighbours,
                                        double radius, double angle_degrees, double spacing,
                                        double detail, std::span<const double> powers);

struct LightMapStatistics {
  std::uint64_t nodes = 0;
  std::uint64_t tiles = 0;        ///< of 8 x 8 cells
  std::uint64_t cells = 0;        ///< compared
  std::uint64_t charts = 0;       ///< planes, each with its lattice
  std::uint64_t value_bytes = 0;  ///< of the nodes' light
  std::uint64_t index_bytes = 0;  ///< of all that is used to find it
};

/// Irradiance of every light at the nodes of lattices in the planes of the surface, finer where it
/// varies. Nodes are filled when points first need them. The positions and values of nodes, and
/// which cells are split, depend on the scene, the parameters and the source alone, and not on
/// earlier queries: see docs/method/light-maps.md.
///
/// A chart continues under objects that stand on it, and behind what is set into it. Nodes there
/// hold the light of their own position, which does not reach the visible surface beside them:
/// nodes that are hidden from a point do not count at that point.
class LightMaps {
 public:
  /// For which points the visibility of the nodes around them is tested.
  enum class Visibility {
    of_points,  ///< for each point around which nodes differ so much that it matters
    of_cells    ///< for the points of cells whose middle does not see all nodes; of one level
  };

  /// Finds the charts. References are kept.
  ///   source   fills nodes
  /// Errors: UsageError for parameters out of range.
  LightMaps(const RayScene& rays, const LightMapParameters& parameters, NodeSource& source,
            Visibility visibility = Visibility::of_points);

  /// Fills all nodes that these hits on opaque surfaces need, or those of the next `rounds` levels
  /// that each of them lacks. With fewer `levels`, only that many of the coarsest are used. Errors:
  /// those of the source, after which the light maps are unchanged; Interrupted.
  void fill(const PrimaryHits& hits, const Progress& progress, int rounds = all_rounds,
            int levels = all_levels);
  static constexpr int all_rounds = 1 << 30, all_levels = 1 << 30;

  /// The nodes around a point of an opaque surface. Thread-safe between fills. Where nodes are not
  /// filled yet it returns false, and the nodes of the finest level that exists; the first is
  /// `none` where no level is.
  bool find(std::uint32_t oriented_face, const glm::vec3& position, BilinearWeights& bilinear,
            int levels = all_levels) const;

  /// Leaves out the nodes that something hides from the point, or covers and not the point: their
  /// weight becomes 0, and the others' weights are scaled to sum to 1. Returns false where none is
  /// left; then the weights are unchanged. Depends on the point and its nodes alone. Thread-safe;
  /// the caller's thread must flush denormals (ray_query.hpp).
  ///   position   of an opaque surface, metres
  ///   bilinear   of `find`, which found all nodes
  bool keep_visible(std::uint32_t oriented_face, const glm::vec3& position,
                    BilinearWeights& bilinear) const;

  /// The nodes that count at points, and whether a point sees any of its own: 1, else 0.
  struct Around {
    std::vector<BilinearWeights> nodes;
    std::vector<std::uint8_t> seen;
  };
  /// Fills what the points need, and finds the nodes that count at each. Errors: those of `fill`.
  Around around(const PrimaryHits& points, const Progress& progress, int levels = all_levels);

  /// Whether nothing stands between two positions, metres, on the plane of a triangle's side.
  bool sees(std::uint32_t oriented_face, const glm::vec3& from, const glm::vec3& to) const;

  /// Whether something that lies on the surface covers `there`, closer than `reach`, but not
  /// `here`: the slit behind it sees the surface beside it, but no light.
  bool is_in_slit(const trace::SurfaceLocation& here, const trace::SurfaceLocation& there,
                  float reach) const;

  /// Standard error of the light of all lights between nodes, relative; 0 where the source does not
  /// know it, or without light. Errors of neighbours are assumed to be equal.
  double relative_error(const BilinearWeights& bilinear) const;

  /// Whether what stands between a position and its nodes matters: they differ by more than the
  /// contrast, or all are dark, or something is close to one.
  bool uneven(const BilinearWeights& bilinear) const;

  /// Harmonic mean of the distances to what sends light to a node, metres; infinite where the
  /// source does not know it.
  float distance(std::uint32_t node) const;

  /// The point of the surface that a node stands for.
  struct NodePoint {
    glm::vec3 position;  ///< metres
    std::uint32_t oriented_face;
  };
  const NodePoint& point(std::uint32_t node) const { return points_[node]; }

  /// The light of the nodes: a row for each.
  const LightTable& values() const { return values_; }

  /// The contents now; `settings` are left empty.
  LightMapContents contents() const;
  /// Takes in what light maps of the same scene and parameters held. Nothing was filled before.
  /// Errors: InputError where it does not fit them; then this object must not be used.
  void restore(LightMapContents contents);

  /// Discards all but the cells whose corner of least column and row is to be kept, and what is
  /// coarser there. Nodes get other numbers, in the same order; what is discarded is filled again
  /// when it is needed, to the same bits.
  ///   keep   per node
  /// Returns the former numbers of the nodes that are left.
  std::vector<std::uint32_t> forget(std::span<const std::uint8_t> keep);

  LightMapStatistics statistics() const;
  /// Bytes of the nodes and of what is used to find them.
  std::uint64_t bytes() const;

  NodeSource& source() const { return source_; }
  const Charts& charts() const { return charts_; }
  const Tiles& tiles() const { return tiles_; }
  /// The processes that fill the same light maps; null where this one is alone.
  Communicator* processes() const { return parameters_.processes; }

 private:
  /// Cells that the hits need next, each once, ascending; leaves those hits in `pending`.
  std::vector<MissingCell> missing_cells(const PrimaryHits& hits,
                                         std::vector<std::uint32_t>& pending, int levels) const;
  /// Numbers of the nodes at the corners of cells; new ones are appended to `added`.
  void number_corners(std::span<const std::pair<std::uint32_t, std::uint32_t>> cells,
                      std::vector<NodeCoordinates>& added);
  /// Releases the numbers of nodes.
  void take_back(std::span<const std::pair<std::uint32_t, std::uint32_t>> cells,
                 std::span<const NodeCoordinates> added);
  void value(std::span<const NodeCoordinates> nodes, const Progress& progress);
  void append(LightTable light, const PrimaryHits& at, std::span<const NodeCoordinates> nodes);
  bool differ(const std::array<std::uint32_t, 4>& nodes, double spacing) const;
  bool is_dark(double light) const;
  bool differ_by_photons(double high, double low) const;
  bool is_open(const BilinearWeights& cell) const;
  bool is_in_slit(const trace::SurfaceLocation& here, std::uint32_t node) const;

  /// What is visible from the middle of a cell; unknown until a point needs it.
  enum SeenByMiddle : std::uint8_t { unknown, all_nodes, not_all };

  const RayScene& rays_;
  const Scene& scene_;
  const LightMapParameters parameters_;
  NodeSource& source_;
  const Visibility visibility_;
  Charts charts_;
  const int levels_;
  const int skipped_levels_;  ///< of them
  Tiles tiles_;
  NodeIndex node_at_;
  std::vector<NodeCoordinates> coordinates_;  ///< of nodes
  LightTable values_;                         ///< of nodes
  /// Per node: luminance of all lights at their powers.
  std::vector<float> together_;
  std::vector<float> error_, distance_;  ///< per node, where the source tells: see NodeValues
  std::vector<NodePoint> points_;        ///< of nodes
  /// Per node: of the cell whose first corner it is, where visibility is that of cells.
  mutable std::vector<std::uint8_t> seen_by_middle_;
  std::uint64_t cells_ = 0;
};

/// Whether nothing stands between two points of one surface. The caller's thread must flush
/// denormals (ray_query.hpp).
bool sees(const RayScene& rays, const trace::SurfaceLocation& from,
          const trace::SurfaceLocation& to);

}  // namespace photile::cache
