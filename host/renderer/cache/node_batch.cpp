#include "cache/node_batch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "trace/surface.hpp"

namespace photile::cache {

PrimaryHits node_points(const Scene& scene, Charts& charts, std::span<const NodeCoordinates> nodes,
                        int levels, bool glossy) {
  std::vector<std::uint32_t> used;
  for (const NodeCoordinates& node : nodes) {
    if (used.empty() || used.back() != node.chart) used.push_back(node.chart);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  tbb::parallel_for(std::size_t{0}, used.size(), [&](std::size_t i) { charts.prepare(used[i]); });

  PrimaryHits points;
  points.position.resize(nodes.size());
  points.oriented_face.resize(nodes.size());
  points.pixel.resize(nodes.size());
  points.throughput.assign(nodes.size(), glm::vec3(1.0f));
  points.diffuse_albedo.assign(nodes.size(), glm::vec3(0.0f));
  if (glossy) {
    points.outgoing.resize(nodes.size());
    points.lobe.resize(nodes.size());
  }
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
    const Charts::Support support = charts.support(nodes[i], levels);
    const trace::SurfacePoint point = trace::surface_point(scene, support.where, support.side);
    points.position[i] = point.position;
    points.oriented_face[i] =
        charts.coincident().at(scene, point.oriented_face(), glm::dvec3(point.position));
    if (!glossy) return;
    points.outgoing[i] = point.normal;
    points.lobe[i] = {.specular = glm::vec3(0.0f),
                      .roughness = 0.0f,
                      .normal = point.normal,
                      .smooth_normal = point.normal};
  });
  return points;
}

namespace {

std::uint64_t hash_of(const NodeCoordinates& node) {
  std::uint64_t hash = (std::uint64_t{node.x} << 32 | node.y) * 0x9E3779B97F4A7C15ull;
  hash = (hash ^ hash >> 32 ^ node.chart) * 0xD6E8FEB86659FD93ull;
  return hash ^ hash >> 32;
}

/// Bits of the numbers of points: as many as random streams distinguish.
constexpr int number_bits = 48;

/// The number of a point. A position that the finest lattice without skipped levels also has keeps
/// its number there; others mix in by how many levels they are finer.
std::uint64_t number_of(const NodeCoordinates& node, const Levels& levels) {
  NodeCoordinates at = node;
  int finer = levels.skipped;
  for (; finer > 0 && ((at.x | at.y) & 1) == 0; --finer) at.x /= 2, at.y /= 2;
  std::uint64_t hash = hash_of(at);
  if (finer > 0) hash = (hash ^ static_cast<std::uint64_t>(finer)) * 0x9E3779B97F4A7C15ull;
  return hash >> (64 - number_bits);
}

/// Between nodes of the coarsest level that is not skipped, in cells of the finest.
std::uint32_t coarsest_step(const Levels& levels) {
  return 1u << (levels.all - 1 - levels.skipped);
}

/// The distance, at the coarsest level that has the node, from one position to the next.
std::uint32_t step_of(const NodeCoordinates& node, const Levels& levels) {
  const std::uint32_t coarsest = coarsest_step(levels);
  std::uint32_t step = 1;
  while (step < coarsest && (node.x | node.y) % (2 * step) == 0) step *= 2;
  return step;
}

/// The positions around nodes, each in the coarsest lattice that has the node.
class Lattices {
 public:
  Lattices(const Charts& charts, const Levels& levels) : charts_(charts), levels_(levels) {}

  bool is_coarsest(const NodeCoordinates& node) const {
    return step_of(node, levels_) == coarsest_step(levels_);
  }

  /// Calls visit(coordinates) for those up to `across` positions away to both sides, and `along`
  /// positions up and down.
  template <class Visit>
  void around(const NodeCoordinates& node, int across, int along, const Visit& visit) const {
    const Chart& chart = charts_[node.chart];
    const std::uint32_t step = step_of(node, levels_);
    const std::int64_t cells = (1u << (levels_.all - 1)) / step, x = node.x / step,
                       y = node.y / step;
    const std::int64_t last_x = std::min(chart.columns * cells, x + across);
    const std::int64_t last_y = std::min(chart.rows * cells, y + along);
    for (std::int64_t j = std::max<std::int64_t>(0, y - along); j <= last_y; ++j) {
      for (std::int64_t i = std::max<std::int64_t>(0, x - across); i <= last_x; ++i) {
        visit(NodeCoordinates{node.chart, static_cast<std::uint32_t>(i) * step,
                              static_cast<std::uint32_t>(j) * step});
      }
    }
  }

 private:
  const Charts& charts_;
  const Levels levels_;
};

/// Appends the positions around each node that are not among them. Returns the numbers of all.
NodeIndex add_surroundings(const Lattices& lattices, const NodeSource::Surroundings& surroundings,
                           std::vector<NodeCoordinates>& coordinates) {
  NodeIndex index;
  for (const NodeCoordinates& at : coordinates) {
    index.insert({at, static_cast<std::uint32_t>(index.size())});
  }
  NodeIndex seen;  // coarse ones, whose surroundings are found side by side, then up and down
  std::vector<NodeCoordinates> coarse;
  const auto see = [&](const NodeCoordinates& at) {
    if (seen.insert({at, 0}).second) coarse.push_back(at);
  };
  const auto add = [&](const NodeCoordinates& at) {
    if (index.insert({at, static_cast<std::uint32_t>(index.size())}).second) {
      coordinates.push_back(at);
    }
  };
  for (std::size_t i = 0, nodes = coordinates.size(); i < nodes; ++i) {
    const NodeCoordinates node = coordinates[i];
    if (lattices.is_coarsest(node)) {
      see(node);
    } else {
      lattices.around(node, surroundings.fine_window, surroundings.fine_window, add);
    }
  }
  const int reach = surroundings.window * surroundings.rounds;
  for (const bool upwards : {false, true}) {
    for (std::size_t i = 0, count = coarse.size(); i < count; ++i) {
      const NodeCoordinates from = coarse[i];
      lattices.around(from, upwards ? 0 : reach, upwards ? reach : 0, see);
    }
  }
  for (const NodeCoordinates& at : coarse) add(at);
  return index;
}

/// Links of the coarse positions, and of the finer ones that are nodes, to those that are there.
void link(const Lattices& lattices, const NodeSource::Surroundings& surroundings,
          std::span<const NodeCoordinates> coordinates, const NodeIndex& index, NodeBatch& batch) {
  const auto write = [&](std::size_t i, std::vector<std::uint32_t>& links) {
    if (!batch.coarse[i] && i >= batch.nodes) return;
    const int window = batch.coarse[i] ? surroundings.window : surroundings.fine_window;
    lattices.around(coordinates[i], window, window, [&](const NodeCoordinates& at) {
      const auto entry = index.find(at);
      if (entry != index.end() && entry->second != i) links.push_back(entry->second);
    });
  };
  batch.neighbours = index_rows_by_tasks(coordinates.size(), write);
}

}  // namespace

std::size_t NodeCoordinatesHash::operator()(const NodeCoordinates& node) const {
  return static_cast<std::size_t>(hash_of(node));
}

NodeBatch node_batch(const Scene& scene, Charts& charts, std::span<const NodeCoordinates> nodes,
                     const Levels& levels, bool glossy,
                     const NodeSource::Surroundings& surroundings) {
  NodeBatch batch;
  batch.nodes = nodes.size();
  std::vector<NodeCoordinates> coordinates(nodes.begin(), nodes.end());
  const Lattices lattices(charts, levels);
  NodeIndex index;
  if (surroundings.rounds > 0) index = add_surroundings(lattices, surroundings, coordinates);
  for (const NodeCoordinates& at : coordinates) batch.coarse.push_back(lattices.is_coarsest(at));
  if (surroundings.rounds > 0) link(lattices, surroundings, coordinates, index, batch);
  for (const NodeCoordinates& at : coordinates) {
    batch.number.push_back(number_of(at, levels));
  }
  batch.points = node_points(scene, charts, coordinates, levels.all, glossy);
  return batch;
}

}  // namespace photile::cache
