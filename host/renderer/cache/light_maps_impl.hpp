// The state of LightMaps.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "cache/charts.hpp"
#include "cache/node_batch.hpp"
#include "cache/tiles.hpp"
#include "photile/light_maps.hpp"
#include "photile/scene.hpp"

namespace photile {

struct LightMaps::Impl {
  Impl(const Scene& from, const LightMapParameters& given);

  /// Cells that the hits need next, each once, ascending; leaves those hits in `pending`.
  std::vector<cache::MissingCell> missing_cells(const PrimaryHits& hits,
                                                std::vector<std::uint32_t>& pending,
                                                int levels) const;
  /// Numbers of the nodes at the corners of cells; new ones are appended to `added`.
  void number_corners(std::span<const std::pair<std::uint32_t, std::uint32_t>> cells,
                      std::vector<cache::NodeCoordinates>& added);
  /// Takes numbers back.
  void forget(std::span<const std::pair<std::uint32_t, std::uint32_t>> cells,
              std::span<const cache::NodeCoordinates> added);
  /// Releases all nodes.
  void clear();
  /// The values of nodes by the source, and their positions.
  std::pair<NodeValues, PrimaryHits> values_of(std::span<const cache::NodeCoordinates> nodes,
                                               NodeSource& source, const Progress& progress);
  void append(LightTable light, const PrimaryHits& at,
              std::span<const cache::NodeCoordinates> nodes);
  bool differ(const std::array<std::uint32_t, 4>& nodes, double spacing) const;
  bool is_dark(double light) const;
  bool differ_by_photons(double high, double low) const;

  const Scene& scene;
  const SceneNeeds needs;
  const LightMapParameters parameters;
  cache::Charts charts;
  const int levels;
  const int skipped_levels;  ///< of them
  cache::Tiles tiles;
  cache::NodeIndex node_at;
  std::vector<cache::NodeCoordinates> coordinates;  ///< of nodes
  LightTable values;                                ///< of nodes
  /// Per node: luminance of all lights at their powers.
  std::vector<float> together;
  std::vector<float> error, distance;  ///< per node, where the source tells: see NodeValues
  std::vector<NodePoint> points;       ///< of nodes
  std::uint64_t cells = 0;
  double chart_seconds = 0;
};

}  // namespace photile
