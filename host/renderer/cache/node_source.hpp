// The light of nodes, as light maps request it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/index_rows.hpp"
#include "light/light_at_points.hpp"
#include "photile/light_table.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"

namespace photile::cache {

/// Nodes of light maps that are filled together.
struct NodeBatch {
  /// Their positions. After the first `nodes` points, positions that lie around them follow: see
  /// NodeSource::surroundings.
  PrimaryHits points;
  std::size_t nodes = 0;
  std::vector<std::uint64_t> number;  ///< of each point: by its position alone, below 2^48
  std::vector<std::uint8_t> coarse;   ///< of each point: whether the coarsest lattice has it
  /// The neighbours of points of the coarsest lattice and of nodes; others have none; empty without
  /// surroundings.
  IndexRows neighbours;
};

/// The light of a batch's nodes.
struct NodeValues {
  LightTable light;  ///< a row for each; radiance is not read
  /// Per node: standard error of the luminance of all lights at their powers; empty where it is
  /// that of k photons.
  std::vector<float> error;
  /// Per node: mean distance of the surfaces that send light there, metres; empty with `error`.
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

/// Fills nodes with the light at their points.
class ValuedBy : public NodeSource {
 public:
  /// The reference is kept. What a point gets from it does not depend on the points beside it.
  explicit ValuedBy(light::LightAtPoints& light) : light_(light) {}

  NodeValues value(const NodeBatch& batch, const Progress&) override {
    return {light_.at(batch.points, Progress::none()), {}, {}};
  }

 private:
  light::LightAtPoints& light_;
};

}  // namespace photile::cache
