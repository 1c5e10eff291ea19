#include "cache/light_maps.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/ascii_text.hpp"
#include "common/touched_memory.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"

namespace photile {

std::string_view name_of(LightMapMode mode) { return name_in({"off", "on", "auto"}, mode); }

}  // namespace photile

namespace photile::cache {

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

/// The parameters, checked.
const LightMapParameters& checked(const LightMapParameters& parameters, std::size_t layers) {
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
  return parameters;
}

}  // namespace

LightMaps::LightMaps(const RayScene& rays, const LightMapParameters& parameters, NodeSource& source,
                     Visibility visibility)
    : rays_(rays),
      scene_(rays.scene()),
      parameters_(checked(parameters, rays.needs().light_count)),
      source_(source),
      visibility_(visibility),
      charts_(scene_, parameters.spacing, parameters.angle_degrees),
      levels_(levels_that_fit(charts_, parameters.levels)),
      skipped_levels_(levels_ -
                      levels_that_fit(charts_, parameters.levels - parameters.skipped_levels)),
      tiles_(charts_),
      values_(rays.needs()) {}

std::vector<MissingCell> LightMaps::missing_cells(const PrimaryHits& hits,
                                                  std::vector<std::uint32_t>& pending,
                                                  int levels) const {
  struct Found {
    std::vector<MissingCell> cells;
    std::vector<std::uint32_t> hits;
  };
  const std::size_t tasks = (pending.size() + hits_per_query_task - 1) / hits_per_query_task;
  std::vector<Found> found(tasks);
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    Found& own = found[task];
    const std::size_t end = std::min(pending.size(), (task + 1) * hits_per_query_task);
    for (std::size_t i = task * hits_per_query_task; i < end; ++i) {
      const std::uint32_t hit = pending[i];
      BilinearWeights bilinear;
      const auto missing = tiles_.find(charts_.chart_of()[hits.oriented_face[hit]],
                                       hits.position[hit], bilinear, levels);
      if (!missing) continue;
      own.hits.push_back(hit);
      if (own.cells.empty() || own.cells.back() != *missing) own.cells.push_back(*missing);
    }
    std::sort(own.cells.begin(), own.cells.end());
    own.cells.erase(std::unique(own.cells.begin(), own.cells.end()), own.cells.end());
  });
  pending = joined(
      tasks, [&](std::size_t task) -> const auto& { return found[task].hits; });
  std::vector<MissingCell> cells = joined(
      tasks, [&](std::size_t task) -> const auto& { return found[task].cells; });
  tbb::parallel_sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

void LightMaps::number_corners(std::span<const std::pair<std::uint32_t, std::uint32_t>> requested,
                               std::vector<NodeCoordinates>& added) {
  for (const auto& [index, cell] : requested) {
    Tile& tile = tiles_[index];
    const int shift = levels_ - 1 - static_cast<int>(tile.level);
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t x = (cell & 7) + (corner & 1), y = (cell >> 3) + (corner >> 1);
      std::uint32_t& node = tile.node[y * 9 + x];
      if (node != none) continue;
      const NodeCoordinates at{tile.chart, (tile.x + x) << shift, (tile.y + y) << shift};
      const auto next = static_cast<std::uint32_t>(together_.size() + added.size());
      const auto [entry, is_new] = node_at_.insert({at, next});
      if (is_new) added.push_back(at);
      node = entry->second;
    }
  }
}

void LightMaps::take_back(std::span<const std::pair<std::uint32_t, std::uint32_t>> cells,
                          std::span<const NodeCoordinates> added) {
  for (const NodeCoordinates& at : added) node_at_.erase(at);
  for (const auto& [index, cell] : cells) {
    for (std::uint32_t& node : tiles_[index].node) {
      if (node != none && node >= together_.size()) node = none;
    }
  }
}

/// Values the nodes that follow.
void LightMaps::value(std::span<const NodeCoordinates> nodes, const Progress& progress) {
  const NodeBatch batch = node_batch(scene_, charts_, nodes, {levels_, skipped_levels_},
                                     rays_.needs().glossy, source_.surroundings());
  NodeValues found = source_.value(batch, progress);
  append(std::move(found.light), batch.points, nodes);
  error_.insert(error_.end(), found.error.begin(), found.error.end());
  distance_.insert(distance_.end(), found.distance.begin(), found.distance.end());
}

/// The light of the nodes that follow, at the first of these points.
void LightMaps::append(LightTable light, const PrimaryHits& at,
                       std::span<const NodeCoordinates> nodes) {
  light.radiance.clear();
  const std::size_t before = points_.size();
  together_.resize(before + nodes.size());
  points_.resize(before + nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t node) {
    double sum = 0;
    light.for_each(node, [&](std::size_t layer, std::size_t i) {
      sum += parameters_.powers[layer] * luminance(glm::dvec3(light.irradiance[i]));
    });
    together_[before + node] = static_cast<float>(sum);
    points_[before + node] = {at.position[node], at.oriented_face[node]};
  });
  values_.append(std::move(light));
  coordinates_.insert(coordinates_.end(), nodes.begin(), nodes.end());
  seen_by_middle_.resize(points_.size(), unknown);
}

/// By more than contrast and noise allow.
bool LightMaps::differ(const std::array<std::uint32_t, 4>& nodes, double spacing) const {
  const auto [low, high] = std::minmax_element(
      nodes.begin(), nodes.end(),
      [&](std::uint32_t a, std::uint32_t b) { return together_[a] < together_[b]; });
  const double least = together_[*low], most = together_[*high];
  if (error_.empty()) return differ_by_photons(most, least);
  const double noise = std::hypot(error_[*low], error_[*high]);
  if (most - least > most * parameters_.contrast + doubted_errors * noise) return true;
  const auto [near, far] = std::minmax(
      {distance_[nodes[0]], distance_[nodes[1]], distance_[nodes[2]], distance_[nodes[3]]});
  if (is_dark(most) && far < near_of_spacing * spacing) return true;
  const double nearest = near;
  return spacing > parameters_.near * nearest &&
         most - least > 0.25 * most * parameters_.contrast + noise;
}

bool LightMaps::is_dark(double light) const {
  return light <= dark_of_sparse * parameters_.sparse_irradiance;
}

bool LightMaps::differ_by_photons(double high, double low) const {
  const double full =
      parameters_.sparse_irradiance > 0 ? std::min(1.0, high / parameters_.sparse_irradiance) : 1.0;
  const double noise = 1 / std::sqrt(parameters_.neighbours * full);
  return high - low > high * (parameters_.contrast + noise);
}

void LightMaps::fill(const PrimaryHits& hits, const Progress& progress, int rounds, int levels) {
  std::vector<std::uint32_t> pending(hits.size());
  std::iota(pending.begin(), pending.end(), 0u);
  for (int round = 0; round < rounds; ++round) {
    progress.throw_if_cancelled();
    std::vector<MissingCell> missing = missing_cells(hits, pending, levels);
    if (parameters_.processes) {  // cells that some process misses, the same on all of them
      missing = parameters_.processes->gather_values<MissingCell>(missing);
      std::sort(missing.begin(), missing.end());
      missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    }
    if (missing.empty()) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
    for (const MissingCell& cell : missing) {
      const std::uint32_t tile = tiles_.tile_of(cell);
      if (static_cast<int>(tiles_[tile].level) >= skipped_levels_) {
        cells.emplace_back(tile, cell.cell);
        continue;
      }
      tiles_[tile].known |= std::uint64_t{1} << cell.cell;
      tiles_.split(tile, cell.cell);
    }
    std::vector<NodeCoordinates> added;
    number_corners(cells, added);
    try {
      if (!added.empty()) value(added, progress);
    } catch (...) {
      take_back(cells, added);
      throw;
    }
    for (const auto& [tile, cell] : cells) {
      tiles_[tile].known |= std::uint64_t{1} << cell;
      if (static_cast<int>(tiles_[tile].level) + 1 < levels_ &&
          differ(tiles_[tile].corners(cell),
                 std::ldexp(charts_.spacing(), -static_cast<int>(tiles_[tile].level)))) {
        tiles_.split(tile, cell);
      }
    }
    cells_ += cells.size();
  }
}

bool LightMaps::find(std::uint32_t oriented_face, const glm::vec3& position,
                     BilinearWeights& bilinear, int levels) const {
  return !tiles_.find(charts_.chart_of()[oriented_face], position, bilinear, levels);
}

double LightMaps::relative_error(const BilinearWeights& bilinear) const {
  if (error_.empty()) return 0;
  double error = 0, light = 0;
  for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
    error += double{bilinear.weight[i]} * error_[bilinear.node[i]];
    light += double{bilinear.weight[i]} * together_[bilinear.node[i]];
  }
  return light > 0 ? error / light : 0;
}

bool LightMaps::uneven(const BilinearWeights& bilinear) const {
  const double contrast = visibility_ == Visibility::of_cells ? 0.0 : parameters_.contrast;
  const auto light = [&](std::size_t corner) { return together_[bilinear.node[corner]]; };
  const auto [least, most] = std::minmax({light(0), light(1), light(2), light(3)});
  if (most - least > most * contrast || is_dark(most)) return true;
  if (distance_.empty()) return false;
  const auto finest = static_cast<float>(std::ldexp(charts_.spacing(), 1 - levels_));
  return std::any_of(bilinear.node.begin(), bilinear.node.end(),
                     [&](std::uint32_t node) { return distance_[node] < finest; });
}

float LightMaps::distance(std::uint32_t node) const {
  return distance_.empty() ? std::numeric_limits<float>::infinity() : distance_[node];
}

LightMapStatistics LightMaps::statistics() const {
  return {.nodes = together_.size(),
          .tiles = tiles_.size(),
          .cells = cells_,
          .charts = charts_.size(),
          .value_bytes = values_.bytes() + (together_.size() + 2 * error_.size()) * sizeof(float) +
                         points_.size() * (sizeof(NodePoint) + sizeof(NodeCoordinates)),
          .index_bytes = charts_.bytes() + tiles_.bytes() +
                         node_at_.size() * 2 * sizeof(std::pair<NodeCoordinates, std::uint32_t>)};
}

std::uint64_t LightMaps::bytes() const {
  const LightMapStatistics now = statistics();
  return now.value_bytes + now.index_bytes;
}

}  // namespace photile::cache
