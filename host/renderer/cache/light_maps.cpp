#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "cache/light_maps_impl.hpp"
#include "common/ascii_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"

namespace photile {
namespace cache {

namespace {

/// Hits that one task reads: large enough to make its cost vanish, small enough to share work.
constexpr std::size_t hits_per_query_task = 1024;

/// Differences of fewer standard errors may be noise.
constexpr double doubted_errors = 3;

/// Nodes with less than this part of the sparse irradiance are dark: shut in by what stands on the
/// surface, as likely as not.
constexpr double dark_of_sparse = 0.5;

/// Cells all of whose nodes are dark, and have something nearer than this many times their spacing,
/// are split: the gap between two doors may lie among them.
constexpr double near_of_spacing = 2;

/// Positions of the finest lattice are counted in 32 bits.
int levels_that_fit(const Charts& charts, int requested) {
  std::uint64_t cells = 1;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    cells = std::max<std::uint64_t>({cells, charts[i].columns + 8, charts[i].rows + 8});
  }
  while (requested > 1 && cells << (requested - 1) > std::uint64_t{1} << 31) --requested;
  return requested;
}

void check(const LightMapParameters& parameters, std::size_t layers) {
  if (!(parameters.spacing > 0) || !std::isfinite(parameters.spacing)) {
    throw UsageError(
        fmt::format("light maps: a spacing of {} m is not a positive number", parameters.spacing));
  }
  if (parameters.levels < 1 || parameters.levels > limits::max_light_map_levels) {
    throw UsageError(fmt::format("light maps: {} levels are not between 1 and {}",
                                 parameters.levels, limits::max_light_map_levels));
  }
  if (parameters.skipped_levels < 0 || parameters.skipped_levels >= parameters.levels) {
    throw UsageError(fmt::format("light maps: {} of {} levels cannot be skipped",
                                 parameters.skipped_levels, parameters.levels));
  }
  if (parameters.powers.size() != layers) {
    throw UsageError(fmt::format("light maps: {} powers for {} layers of light",
                                 parameters.powers.size(), layers));
  }
}

}  // namespace
}  // namespace cache

std::string_view name_of(LightMapMode mode) { return name_in({"off", "on", "auto"}, mode); }

using cache::Charts;
using cache::MissingCell;
using cache::NodeCoordinates;
using cache::Tile;
using cache::Tiles;

LightMaps::Impl::Impl(const Scene& from, const LightMapParameters& given)
    : scene(from),
      needs(needs_of(from)),
      parameters(given),
      charts(scene, parameters.spacing, parameters.angle_degrees),
      levels(cache::levels_that_fit(charts, parameters.levels)),
      skipped_levels(levels -
                     cache::levels_that_fit(charts, parameters.levels - parameters.skipped_levels)),
      tiles(charts) {
  clear();
}

void LightMaps::Impl::clear() {
  tiles.clear();
  node_at.clear();
  values = LightTable(needs);
  together.clear();
  error.clear();
  distance.clear();
  points.clear();
  coordinates.clear();
  cells = 0;
}

std::vector<MissingCell> LightMaps::Impl::missing_cells(const PrimaryHits& hits,
                                                        std::vector<std::uint32_t>& pending,
                                                        int levels) const {
  struct Found {
    std::vector<MissingCell> cells;
    std::vector<std::uint32_t> hits;
  };
  const std::size_t tasks =
      (pending.size() + cache::hits_per_query_task - 1) / cache::hits_per_query_task;
  std::vector<Found> found(tasks);
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    Found& own = found[task];
    const std::size_t end = std::min(pending.size(), (task + 1) * cache::hits_per_query_task);
    for (std::size_t i = task * cache::hits_per_query_task; i < end; ++i) {
      const std::uint32_t hit = pending[i];
      BilinearWeights bilinear;
      const auto missing = tiles.find(charts.chart_of()[hits.oriented_face[hit]],
                                      hits.position[hit], bilinear, levels);
      if (!missing) continue;
      own.hits.push_back(hit);
      if (own.cells.empty() || own.cells.back() != *missing) own.cells.push_back(*missing);
    }
    std::sort(own.cells.begin(), own.cells.end());
    own.cells.erase(std::unique(own.cells.begin(), own.cells.end()), own.cells.end());
  });
  std::vector<MissingCell> cells;
  pending.clear();
  for (const Found& own : found) {
    cells.insert(cells.end(), own.cells.begin(), own.cells.end());
    pending.insert(pending.end(), own.hits.begin(), own.hits.end());
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

void LightMaps::Impl::number_corners(
    std::span<const std::pair<std::uint32_t, std::uint32_t>> requested,
    std::vector<NodeCoordinates>& added) {
  for (const auto& [index, cell] : requested) {
    Tile& tile = tiles[index];
    const int shift = levels - 1 - static_cast<int>(tile.level);
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t x = (cell & 7) + (corner & 1), y = (cell >> 3) + (corner >> 1);
      std::uint32_t& node = tile.node[y * 9 + x];
      if (node != none) continue;
      const NodeCoordinates at{tile.chart, (tile.x + x) << shift, (tile.y + y) << shift};
      const auto next = static_cast<std::uint32_t>(together.size() + added.size());
      const auto [entry, is_new] = node_at.insert({at, next});
      if (is_new) added.push_back(at);
      node = entry->second;
    }
  }
}

void LightMaps::Impl::forget(std::span<const std::pair<std::uint32_t, std::uint32_t>> cells,
                             std::span<const NodeCoordinates> added) {
  for (const NodeCoordinates& at : added) node_at.erase(at);
  for (const auto& [index, cell] : cells) {
    for (std::uint32_t& node : tiles[index].node) {
      if (node != none && node >= together.size()) node = none;
    }
  }
}

std::pair<NodeValues, PrimaryHits> LightMaps::Impl::values_of(
    std::span<const NodeCoordinates> nodes, NodeSource& source, const Progress& progress) {
  NodeBatch batch = cache::node_batch(scene, charts, nodes, {levels, skipped_levels}, needs.glossy,
                                      source.surroundings());
  NodeValues values = source.value(batch, progress);
  return {std::move(values), std::move(batch.points)};
}

/// The light of the nodes that follow, at the first of these points.
void LightMaps::Impl::append(LightTable light, const PrimaryHits& at,
                             std::span<const NodeCoordinates> nodes) {
  light.radiance.clear();
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    double sum = 0;
    light.for_each(node, [&](std::size_t layer, std::size_t i) {
      sum += parameters.powers[layer] * luminance(glm::dvec3(light.irradiance[i]));
    });
    together.push_back(static_cast<float>(sum));
    points.push_back({at.position[node], at.oriented_face[node]});
  }
  values.append(std::move(light));
  coordinates.insert(coordinates.end(), nodes.begin(), nodes.end());
}

/// By more than contrast and noise allow.
bool LightMaps::Impl::differ(const std::array<std::uint32_t, 4>& nodes, double spacing) const {
  const auto [low, high] = std::minmax_element(
      nodes.begin(), nodes.end(),
      [&](std::uint32_t a, std::uint32_t b) { return together[a] < together[b]; });
  const double least = together[*low], most = together[*high];
  if (error.empty()) return differ_by_photons(most, least);
  const double noise = std::hypot(error[*low], error[*high]);
  if (most - least > most * parameters.contrast + cache::doubted_errors * noise) return true;
  const auto [near, far] =
      std::minmax({distance[nodes[0]], distance[nodes[1]], distance[nodes[2]], distance[nodes[3]]});
  if (is_dark(most) && far < cache::near_of_spacing * spacing) return true;
  const double nearest = near;
  return spacing > parameters.near * nearest &&
         most - least > 0.25 * most * parameters.contrast + noise;
}

bool LightMaps::Impl::is_dark(double light) const {
  return light <= cache::dark_of_sparse * parameters.sparse_irradiance;
}

bool LightMaps::Impl::differ_by_photons(double high, double low) const {
  const double full =
      parameters.sparse_irradiance > 0 ? std::min(1.0, high / parameters.sparse_irradiance) : 1.0;
  const double noise = 1 / std::sqrt(parameters.neighbours * full);
  return high - low > high * (parameters.contrast + noise);
}

LightMaps::LightMaps(const Scene& scene, const LightMapParameters& parameters) {
  cache::check(parameters, needs_of(scene).light_count);
  const Stopwatch stopwatch;
  impl_ = std::make_unique<Impl>(scene, parameters);
  impl_->chart_seconds = stopwatch.seconds();
}

LightMaps::~LightMaps() = default;
LightMaps::LightMaps(LightMaps&&) noexcept = default;

void LightMaps::fill(const PrimaryHits& hits, NodeSource& source, const Progress& progress,
                     int rounds, int levels) {
  std::vector<std::uint32_t> pending(hits.size());
  std::iota(pending.begin(), pending.end(), 0u);
  Tiles& tiles = impl_->tiles;
  for (int round = 0; round < rounds; ++round) {
    progress.throw_if_cancelled();
    std::vector<MissingCell> missing = impl_->missing_cells(hits, pending, levels);
    if (impl_->parameters.processes) {  // cells that some process misses, the same on all of them
      missing = impl_->parameters.processes->gather_values<MissingCell>(missing);
      std::sort(missing.begin(), missing.end());
      missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    }
    if (missing.empty()) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
    for (const MissingCell& cell : missing) {
      const std::uint32_t tile = tiles.tile_of(cell);
      if (static_cast<int>(tiles[tile].level) >= impl_->skipped_levels) {
        cells.emplace_back(tile, cell.cell);
        continue;
      }
      tiles[tile].known |= std::uint64_t{1} << cell.cell;
      tiles.split(tile, cell.cell);
    }
    std::vector<NodeCoordinates> added;
    impl_->number_corners(cells, added);
    try {
      if (!added.empty()) {
        auto [values, points] = impl_->values_of(added, source, progress);
        impl_->append(std::move(values.light), points, added);
        impl_->error.insert(impl_->error.end(), values.error.begin(), values.error.end());
        impl_->distance.insert(impl_->distance.end(), values.distance.begin(),
                               values.distance.end());
      }
    } catch (...) {
      impl_->forget(cells, added);
      throw;
    }
    for (const auto& [tile, cell] : cells) {
      tiles[tile].known |= std::uint64_t{1} << cell;
      if (static_cast<int>(tiles[tile].level) + 1 < impl_->levels &&
          impl_->differ(
              tiles[tile].corners(cell),
              std::ldexp(impl_->charts.spacing(), -static_cast<int>(tiles[tile].level)))) {
        tiles.split(tile, cell);
      }
    }
    impl_->cells += cells.size();
  }
}

bool LightMaps::find(std::uint32_t oriented_face, const glm::vec3& position,
                     BilinearWeights& bilinear, int levels) const {
  return !impl_->tiles.find(impl_->charts.chart_of()[oriented_face], position, bilinear, levels);
}

double LightMaps::relative_error(const BilinearWeights& bilinear) const {
  if (impl_->error.empty()) return 0;
  double error = 0, light = 0;
  for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
    error += double{bilinear.weight[i]} * impl_->error[bilinear.node[i]];
    light += double{bilinear.weight[i]} * impl_->together[bilinear.node[i]];
  }
  return light > 0 ? error / light : 0;
}

bool LightMaps::uneven(const BilinearWeights& bilinear, double contrast) const {
  const auto light = [&](std::size_t corner) { return impl_->together[bilinear.node[corner]]; };
  const auto [least, most] = std::minmax({light(0), light(1), light(2), light(3)});
  if (most - least > most * contrast || impl_->is_dark(most)) return true;
  if (impl_->distance.empty()) return false;
  const auto finest = static_cast<float>(std::ldexp(impl_->charts.spacing(), 1 - impl_->levels));
  return std::any_of(bilinear.node.begin(), bilinear.node.end(),
                     [&](std::uint32_t node) { return impl_->distance[node] < finest; });
}

const LightMaps::NodePoint& LightMaps::point(std::uint32_t node) const {
  return impl_->points[node];
}

float LightMaps::distance(std::uint32_t node) const {
  return impl_->distance.empty() ? std::numeric_limits<float>::infinity() : impl_->distance[node];
}

const Charts& LightMaps::charts() const { return impl_->charts; }
const Tiles& LightMaps::tiles() const { return impl_->tiles; }

const LightTable& LightMaps::values() const { return impl_->values; }

LightMapStatistics LightMaps::statistics() const {
  return {
      .nodes = impl_->together.size(),
      .tiles = impl_->tiles.size(),
      .cells = impl_->cells,
      .charts = impl_->charts.size(),
      .value_bytes = impl_->values.bytes() +
                     (impl_->together.size() + 2 * impl_->error.size()) * sizeof(float) +
                     impl_->points.size() * (sizeof(NodePoint) + sizeof(NodeCoordinates)),
      .index_bytes = impl_->charts.bytes() + impl_->tiles.bytes() +
                     impl_->node_at.size() * 2 * sizeof(std::pair<NodeCoordinates, std::uint32_t>),
      .chart_seconds = impl_->chart_seconds};
}

}  // namespace photile
