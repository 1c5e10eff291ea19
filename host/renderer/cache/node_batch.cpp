#include "cache/node_batch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "trace/surface.hpp"

namespace photile::cache {

PrimaryHits node_points(const Scene& scene, Charts& charts, std::span<const NodePlace> nodes,
                        int levels, bool glossy) {
  std::vector<std::uint32_t> used;
  for (const NodePlace& node : nodes) used.push_back(node.chart);
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
    const Charts::Owner owner = charts.owner(nodes[i], levels);
    const trace::SurfacePoint point = trace::surface_point(scene, owner.where, owner.side);
    points.position[i] = point.position;
    points.oriented_face[i] = point.oriented_face();
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

std::uint64_t hash_of(const NodePlace& node) {
  std::uint64_t hash = (std::uint64_t{node.x} << 32 | node.y) * 0x9E3779B97F4A7C15ull;
  hash = (hash ^ hash >> 32 ^ node.chart) * 0xD6E8FEB86659FD93ull;
  return hash ^ hash >> 32;
}

/// Bits of the numbers of points: as many as random streams tell apart.
constexpr int number_bits = 48;

std::uint64_t number_of(const NodePlace& node) { return hash_of(node) >> (64 - number_bits); }

/// The distance, at the coarsest level that has the node, from one place to the next.
std::uint32_t step_of(const NodePlace& node, int levels) {
  const std::uint32_t coarsest = 1u << (levels - 1);
  std::uint32_t step = 1;
  while (step < coarsest && (node.x | node.y) % (2 * step) == 0) step *= 2;
  return step;
}

/// The places next to a node in the lattice of the next coarser level, or none at the coarsest.
std::optional<std::array<NodePlace, 4>> parents_of(const NodePlace& node, int levels) {
  const std::uint32_t step = step_of(node, levels);
  if (step == 1u << (levels - 1)) return std::nullopt;
  const std::uint32_t dx = node.x % (2 * step), dy = node.y % (2 * step);
  std::array<NodePlace, 4> parents;
  for (std::uint32_t i = 0; i < 4; ++i) {
    parents[i] = {node.chart, i & 1 ? node.x + dx : node.x - dx, i & 2 ? node.y + dy : node.y - dy};
  }
  return parents;
}

std::array<std::uint64_t, 4> parent_numbers(const NodePlace& node, int levels) {
  std::array<std::uint64_t, 4> numbers;
  numbers.fill(NodeBatch::no_parent);
  if (const auto parents = parents_of(node, levels)) {
    std::transform(parents->begin(), parents->end(), numbers.begin(), number_of);
  }
  return numbers;
}

/// The places around nodes, each in the coarsest lattice that has the node.
class Lattices {
 public:
  Lattices(const Charts& charts, int levels) : charts_(charts), levels_(levels) {}

  bool is_coarsest(const NodePlace& node) const { return step_of(node, levels_) == coarsest(); }

  /// Calls visit(place) for those up to so many places away to both sides, and up and down.
  template <class Visit>
  void around(const NodePlace& node, int across, int along, const Visit& visit) const {
    const Chart& chart = charts_[node.chart];
    const std::uint32_t step = step_of(node, levels_);
    const std::int64_t cells = coarsest() / step, x = node.x / step, y = node.y / step;
    const std::int64_t last_x = std::min(chart.columns * cells, x + across);
    const std::int64_t last_y = std::min(chart.rows * cells, y + along);
    for (std::int64_t j = std::max<std::int64_t>(0, y - along); j <= last_y; ++j) {
      for (std::int64_t i = std::max<std::int64_t>(0, x - across); i <= last_x; ++i) {
        visit(NodePlace{node.chart, static_cast<std::uint32_t>(i) * step,
                        static_cast<std::uint32_t>(j) * step});
      }
    }
  }

 private:
  std::uint32_t coarsest() const { return 1u << (levels_ - 1); }

  const Charts& charts_;
  int levels_;
};

/// Appends the places around each node that are not among them. Returns the numbers of all.
NodeIndex add_surroundings(const Lattices& lattices, const NodeSource::Surroundings& surroundings,
                           std::vector<NodePlace>& places) {
  NodeIndex index;
  for (const NodePlace& place : places) {
    index.insert({place, static_cast<std::uint32_t>(index.size())});
  }
  NodeIndex seen;  // coarse ones, whose surroundings are found side by side, then up and down
  std::vector<NodePlace> coarse;
  const auto see = [&](const NodePlace& place) {
    if (seen.insert({place, 0}).second) coarse.push_back(place);
  };
  const auto add = [&](const NodePlace& place) {
    if (index.insert({place, static_cast<std::uint32_t>(index.size())}).second) {
      places.push_back(place);
    }
  };
  for (std::size_t i = 0, nodes = places.size(); i < nodes; ++i) {
    const NodePlace node = places[i];
    if (lattices.is_coarsest(node)) {
      see(node);
    } else {
      lattices.around(node, surroundings.fine_window, surroundings.fine_window, add);
    }
  }
  const int reach = surroundings.window * surroundings.rounds;
  for (const bool upwards : {false, true}) {
    for (std::size_t i = 0, count = coarse.size(); i < count; ++i) {
      const NodePlace from = coarse[i];
      lattices.around(from, upwards ? 0 : reach, upwards ? reach : 0, see);
    }
  }
  for (const NodePlace& place : coarse) add(place);
  return index;
}

/// Links of the coarse places, and of the finer ones that are nodes, to those that are there.
void link(const Lattices& lattices, const NodeSource::Surroundings& surroundings,
          std::span<const NodePlace> places, const NodeIndex& index, NodeBatch& batch) {
  std::vector<std::vector<std::uint32_t>> links(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    if (!batch.coarse[i] && i >= batch.nodes) return;
    const int window = batch.coarse[i] ? surroundings.window : surroundings.fine_window;
    lattices.around(places[i], window, window, [&](const NodePlace& place) {
      const auto entry = index.find(place);
      if (entry != index.end() && entry->second != i) links[i].push_back(entry->second);
    });
  });
  batch.first_neighbour.push_back(0);
  for (const std::vector<std::uint32_t>& to : links) {
    batch.neighbour.insert(batch.neighbour.end(), to.begin(), to.end());
    batch.first_neighbour.push_back(static_cast<std::uint32_t>(batch.neighbour.size()));
  }
}

}  // namespace

std::size_t NodePlaceHash::operator()(const NodePlace& node) const {
  return static_cast<std::size_t>(hash_of(node));
}

int level_of(const NodePlace& node, int levels) {
  return levels - 1 - std::countr_zero(step_of(node, levels));
}

std::vector<std::vector<NodePlace>> unknown_parents(std::span<const NodePlace> nodes, int levels,
                                                    const NodeSource& source) {
  std::vector<std::vector<NodePlace>> by_level(static_cast<std::size_t>(levels));
  NodeIndex found;
  std::vector<NodePlace> open(nodes.begin(), nodes.end());
  while (!open.empty()) {
    const auto parents = parents_of(open.back(), levels);
    open.pop_back();
    if (!parents) continue;
    for (const NodePlace& parent : *parents) {
      if (source.knows(number_of(parent)) || !found.insert({parent, 0}).second) continue;
      by_level[static_cast<std::size_t>(level_of(parent, levels))].push_back(parent);
      open.push_back(parent);
    }
  }
  return by_level;
}

NodeBatch node_batch(const Scene& scene, Charts& charts, std::span<const NodePlace> nodes,
                     int levels, bool glossy, const NodeSource::Surroundings& surroundings) {
  NodeBatch batch;
  batch.nodes = nodes.size();
  for (const NodePlace& node : nodes) batch.parents.push_back(parent_numbers(node, levels));
  std::vector<NodePlace> places(nodes.begin(), nodes.end());
  const Lattices lattices(charts, levels);
  NodeIndex index;
  if (surroundings.rounds > 0) index = add_surroundings(lattices, surroundings, places);
  for (const NodePlace& place : places) batch.coarse.push_back(lattices.is_coarsest(place));
  if (surroundings.rounds > 0) link(lattices, surroundings, places, index, batch);
  for (const NodePlace& place : places) {
    batch.number.push_back(number_of(place));
  }
  batch.points = node_points(scene, charts, places, levels, glossy);
  return batch;
}

}  // namespace photile::cache
