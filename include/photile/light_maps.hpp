// Light maps: irradiance kept where it falls, at nodes on the surface, and read between them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "photile/communicator.hpp"
#include "photile/defaults.hpp"
#include "photile/estimator.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Whether the light of matt surfaces is read from light maps.
enum class LightMapMode {
  off,       ///< an estimate at each hit: the method of the paper
  on,        ///< nodes, which the photon estimate values
  automatic  ///< on for pictures, but where rays gather, with naive maps and with several passes
};

/// "off", "on", "auto".
std::string_view name_of(LightMapMode mode);
inline constexpr std::array all_light_map_modes = {LightMapMode::off, LightMapMode::on,
                                                   LightMapMode::automatic};

namespace cache {
class Charts;  // host/renderer/cache/charts.hpp
class Tiles;   // host/renderer/cache/tiles.hpp
}  // namespace cache

/// Nodes of light maps that are valued together.
struct NodeBatch {
  /// Where they are. Beyond the first `nodes` points follow positions that lie around them: see
  /// NodeSource::surroundings.
  PrimaryHits points;
  std::size_t nodes = 0;
  std::vector<std::uint64_t> number;  ///< of each point: by its position alone, below 2^48
  std::vector<std::uint8_t> coarse;   ///< of each point: whether the coarsest lattice has it
  /// Point i of the coarsest lattice, or node i, is linked to neighbour[first_neighbour[i] ..
  /// first_neighbour[i + 1]), others to none. Empty without surroundings.
  std::vector<std::uint32_t> first_neighbour, neighbour;
};

/// The light of a batch's nodes.
struct NodeValues {
  LightTable light;  ///< a row for each; radiance is not looked at
  /// Per node: standard error of the luminance of all lights at their powers; empty where it is
  /// that of k photons.
  std::vector<float> error;
  /// Per node: mean distance of what sends light there, metres; empty with `error`.
  std::vector<float> distance;
};

/// The source of the light of nodes. The light of a node must depend on its position alone.
class NodeSource {
 public:
  virtual ~NodeSource() = default;

  /// Values may depend on positions around the node in its chart, in the coarsest lattice that has
  /// it.
  struct Surroundings {
    int window = 0;  ///< positions on each side that a position of the coarsest level is linked to
    int rounds = 0;  ///< links from one such position to the next
    int fine_window = 0;  ///< positions on each side that a node of a finer level is linked to
  };
  virtual Surroundings surroundings() const { return {}; }

  virtual NodeValues value(const NodeBatch& batch, const Progress& progress) = 0;

  /// Bytes that the source keeps for nodes; `forget` releases them.
  virtual std::uint64_t bytes() const { return 0; }
  virtual void forget() {}
};

struct LightMapParameters {
  double spacing = defaults::light_map_spacing;  ///< metres, > 0: of the coarsest nodes, at most
  int levels = defaults::light_map_levels;       ///< the finest is spacing / 2^(levels - 1)
  /// The number of coarsest levels that are split everywhere and have no nodes. The next level then
  /// counts as the coarsest, and points have the same numbers as with fewer skipped levels and as
  /// many fewer levels.
  int skipped_levels = 0;
  double angle_degrees = defaults::group_angle_degrees;  ///< of neighbours in a smooth component
  /// Cells are split where their corners differ by this part of the brightest, and by its noise.
  double contrast = defaults::light_map_contrast;
  /// Where the source knows how far away the surroundings are: cells larger than this part of it
  /// are split at a quarter of the contrast.
  double near = defaults::light_map_near;
  double neighbours = defaults::neighbours;  ///< noise is 1 / sqrt of this many photons ...
  /// ... and of fewer below this irradiance at the lights' powers, where fewer are found.
  double sparse_irradiance = 0;
  std::vector<double> powers;  ///< per layer of the scene, at which cells are compared
  /// Processes that fill the same light maps, each for its own hits: all of them have all nodes.
  /// Null: this process alone.
  Communicator* processes = nullptr;
};

struct LightMapStatistics {
  std::uint64_t nodes = 0;
  std::uint64_t tiles = 0;        ///< of 8 x 8 cells
  std::uint64_t cells = 0;        ///< compared
  std::uint64_t charts = 0;       ///< planes, each with its lattice
  std::uint64_t value_bytes = 0;  ///< of the nodes' light
  std::uint64_t index_bytes = 0;  ///< of all that is used to find it
  double chart_seconds = 0;       ///< of finding charts, once
};

/// Four nodes and their weights, which sum to 1.
struct BilinearWeights {
  std::array<std::uint32_t, 4> node;
  std::array<float, 4> weight;
};

/// The contents of light maps, without what follows from the scene and the parameters.
struct LightMapContents {
  struct Coordinates {
    std::uint32_t chart, x, y;  ///< in cells of the finest level
  };
  struct Tile {
    std::uint64_t known, split;  ///< cells, bit y * 8 + x: whose corners are valued; refined
    std::uint32_t chart, level, x, y;
  };
  std::string settings;  ///< in words: what the light depends on beside the scene and the photons
  std::vector<Coordinates> nodes;
  LightTable values;                   ///< of the nodes
  std::vector<float> error, distance;  ///< of the nodes, as NodeValues has them
  std::vector<Tile> tiles;             ///< each after the one that it refines
};

/// Irradiance of every light at the nodes of lattices in the planes of the surface, finer where it
/// varies. Nodes are valued when hits first need them. The positions and values of nodes, and which
/// cells are split, depend on the scene, the parameters and the source alone, and not on earlier
/// queries: see docs/light-maps.md.
class LightMaps {
 public:
  /// Finds the charts. `scene` must outlive it.
  /// Errors: UsageError for parameters out of range.
  LightMaps(const Scene& scene, const LightMapParameters& parameters);
  ~LightMaps();
  LightMaps(LightMaps&&) noexcept;

  /// Values all nodes that these hits on opaque surfaces need, or those of the next `rounds` levels
  /// that each of them lacks. With fewer `levels` only that many of the coarsest are used. Errors:
  /// those of the source, after which the light maps are unchanged; Interrupted.
  void fill(const PrimaryHits& hits, NodeSource& source, const Progress& progress,
            int rounds = all_rounds, int levels = all_rounds);
  static constexpr int all_rounds = 1 << 30;

  /// The nodes around a point of an opaque surface. Thread-safe between fills. Where nodes are not
  /// valued yet it returns false, and the nodes of the finest level that is there; the first is
  /// `none` where no level is.
  bool find(std::uint32_t oriented_face, const glm::vec3& position, BilinearWeights& bilinear,
            int levels = all_rounds) const;

  /// Standard error of the light of all lights between nodes, relative; 0 where the source does not
  /// tell it, or without light. Errors of neighbours are taken for the same.
  double relative_error(const BilinearWeights& bilinear) const;

  /// Whether what stands between a position and its nodes matters: they differ by more than this
  /// part of the brightest, or all are dark, or something is close to one.
  bool uneven(const BilinearWeights& bilinear, double contrast) const;

  /// The point of the surface that a node stands for.
  struct NodePoint {
    glm::vec3 position;  ///< metres
    std::uint32_t oriented_face;
  };
  const NodePoint& point(std::uint32_t node) const;

  /// Harmonic mean of the distances to what sends light to a node, metres; infinite where the
  /// source does not tell it.
  float distance(std::uint32_t node) const;

  /// The light of the nodes, in the form of estimates: node n is hit n.
  const LightTable& values() const;

  /// The contents now; `settings` are left empty.
  LightMapContents contents() const;
  /// Takes in what light maps of the same scene and parameters held, of one pass. Nothing was
  /// filled before. Errors: InputError where it does not fit them; then nothing here is of use.
  void restore(LightMapContents contents);

  /// Forgets all but the cells whose corner of least column and row is to be kept, and what is
  /// coarser there. Nodes get other numbers, in the same order; what is forgotten is valued again
  /// when it is needed, to the same bits.
  ///   keep   per node
  /// Returns the former numbers of the nodes that are left.
  std::vector<std::uint32_t> forget(std::span<const std::uint8_t> keep);

  LightMapStatistics statistics() const;

  const cache::Charts& charts() const;
  const cache::Tiles& tiles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile
