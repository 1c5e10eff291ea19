#include "cache/gathered_nodes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "cache/irradiance_filter.hpp"
#include "estimate/map_order.hpp"
#include "photile/defaults.hpp"
#include "photile/limits.hpp"

namespace photile::cache {
namespace {

/// Points that a point is averaged with.
constexpr NodeSource::Surroundings averaged{.window = defaults::averaged_window,
                                            .rounds = defaults::averaged_rounds,
                                            .fine_window = defaults::averaged_fine_window};
/// Differences that may be noise. Direct light ends at borders: beyond the horizon of
/// a light that is near, points know that they are dark, and those before it are not sure of much.
constexpr NoiseTolerance of_indirect{.errors = defaults::tolerated_errors};
constexpr NoiseTolerance of_direct{.errors = defaults::tolerated_errors,
                                   .ratio = defaults::tolerated_error_ratio};

std::vector<std::uint64_t> numbers_at(const NodeBatch& batch,
                                      std::span<const std::uint32_t> chosen) {
  std::vector<std::uint64_t> numbers;
  for (const std::uint32_t point : chosen) numbers.push_back(batch.number[point]);
  return numbers;
}

/// Links between chosen points alone, by their numbers among those chosen.
PointLinks links_between(const NodeBatch& batch, std::span<const std::uint32_t> chosen) {
  std::vector<std::uint32_t> index_of(batch.points.size(), none);
  for (std::uint32_t i = 0; i < chosen.size(); ++i) index_of[chosen[i]] = i;
  PointLinks links;
  links.first.push_back(0);
  for (const std::uint32_t point : chosen) {
    for (std::uint32_t i = batch.first_neighbour[point]; i < batch.first_neighbour[point + 1];
         ++i) {
      links.to.push_back(index_of[batch.neighbour[i]]);
    }
    links.first.push_back(static_cast<std::uint32_t>(links.to.size()));
  }
  return links;
}

void append(const GatheredParts& from, std::size_t point, std::size_t lights, GatheredParts& to) {
  to.indirect.append(from.indirect, point, lights);
  to.direct.append(from.direct, point, lights);
  to.distance.push_back(from.distance[point]);
}

}  // namespace

GatheredNodesParameters rays_of_nodes(const Scene& scene, int coarse) {
  // Shadow borders stand at the finer levels: there light samples matter more than rays.
  // Nine of these are averaged. In the open a shadow has a hundredth of the light of the sun beside
  // it, and few light samples find the sky through a window: what single ones find would show.
  const bool open = std::any_of(scene.lights.begin(), scene.lights.end(),
                                [](const Light& light) { return light.is_distant(); });
  const int rays =
      std::min((open ? defaults::times_in_the_open : 1) * coarse, limits::max_gathering_rays);
  const int fine = std::max((rays + 3) / 4, std::min(rays, defaults::least_rays));
  const auto light_samples_of = [&](int of_rays) {
    return std::min((open ? 1 : defaults::light_samples_per_ray) * of_rays,
                    limits::max_direct_rays);
  };
  return {{rays, light_samples_of(rays)}, {fine, light_samples_of(open ? rays : fine)}};
}

NodeSource::Surroundings GatheredNodes::surroundings() const { return averaged; }

std::uint64_t GatheredNodes::bytes() const {
  return raw_.bytes() + nodes_.bytes() + gather_.bytes() +
         (raw_of_.size() + row_of_.size()) * 2 * sizeof(std::pair<std::uint64_t, std::uint32_t>);
}

void GatheredNodes::forget() {
  raw_of_.clear();
  row_of_.clear();
  raw_ = {};
  nodes_ = {};
  gather_.forget();
}

NodeValues GatheredNodes::value(const NodeBatch& batch, const Progress& progress) {
  const std::size_t lights = layer_powers_.size();
  std::vector<std::uint32_t> coarse, fine;
  for (std::uint32_t i = 0; i < batch.points.size(); ++i) {
    (batch.coarse[i] ? coarse : fine).push_back(i);
  }
  gather_new(batch, coarse, parameters_.coarse, progress);
  gather_new(batch, fine, parameters_.fine, progress);
  const GatheredParts smooth = smoothed(batch, coarse);
  std::erase_if(fine, [&](std::uint32_t point) { return point >= batch.nodes; });
  const auto averaged_fine = [&](const GatheredIrradiance& raw, const GatheredIrradiance& known,
                                 const NoiseTolerance& tolerated) {
    return corrected(known, with_neighbours(raw, batch, fine, tolerated), batch, fine, tolerated);
  };
  const GatheredIrradiance indirect = averaged_fine(raw_.indirect, nodes_.indirect, of_indirect);
  const GatheredIrradiance direct = averaged_fine(raw_.direct, nodes_.direct, of_direct);

  const std::size_t before = nodes_.distance.size();
  std::size_t next_coarse = 0, next_fine = 0;
  for (std::uint32_t node = 0; node < batch.nodes; ++node) {
    row_of_.insert_or_assign(batch.number[node],
                             static_cast<std::uint32_t>(nodes_.distance.size()));
    if (batch.parents[node][0] == NodeBatch::no_parent) {
      append(smooth, next_coarse++, lights, nodes_);
    } else {
      nodes_.indirect.append(indirect, next_fine, lights);
      nodes_.direct.append(direct, next_fine++, lights);
      nodes_.distance.push_back(raw_.distance[raw_of_.at(batch.number[node])]);
    }
  }
  GatheredParts own;
  for (std::size_t row = before; row < nodes_.distance.size(); ++row) {
    append(nodes_, row, lights, own);
  }
  GatheredIrradiance all = sum_of(own.indirect, own.direct, lights);
  NodeValues values;
  for (std::size_t node = 0; node < batch.nodes; ++node) {
    values.error.push_back(static_cast<float>(all.total(node, layer_powers_).error));
    values.distance.push_back(nodes_.distance[before + node]);
  }
  values.irradiance = std::move(all.mean);
  return values;
}

Estimates GatheredNodes::errors() const {
  const GatheredIrradiance all = sum_of(nodes_.indirect, nodes_.direct, layer_powers_.size());
  Estimates errors = all.mean;
  for (std::size_t i = 0; i < errors.irradiance.size(); ++i) {
    const double light = luminance(glm::dvec3(all.mean.irradiance[i]));
    const float relative = light > 0 ? static_cast<float>(all.error(i) / light) : 0.0f;
    errors.irradiance[i] *= relative;
    if (!errors.by_normal.empty()) errors.by_normal[i] *= relative;
  }
  return errors;
}

/// Gathers at points that have no rays yet.
void GatheredNodes::gather_new(const NodeBatch& batch, std::span<const std::uint32_t> points,
                               const NodeRays& rays, const Progress& progress) {
  std::vector<std::uint32_t> fresh;
  for (const std::uint32_t point : points) {
    if (!raw_of_.contains(batch.number[point])) fresh.push_back(point);
  }
  GatheredParts found =
      gather_.gather(estimate::reordered(batch.points, 0, fresh), numbers_at(batch, fresh),
                     rays.rays, rays.light_samples, progress);
  for (const std::uint32_t point : fresh) {
    raw_of_.insert({batch.number[point], static_cast<std::uint32_t>(raw_of_.size())});
  }
  raw_.indirect.append(std::move(found.indirect));
  raw_.direct.append(std::move(found.direct));
  raw_.distance.insert(raw_.distance.end(), found.distance.begin(), found.distance.end());
}

/// Coarse points averaged with those around them.
GatheredParts GatheredNodes::smoothed(const NodeBatch& batch,
                                      std::span<const std::uint32_t> coarse) const {
  const std::size_t lights = layer_powers_.size();
  GatheredParts parts;
  for (const std::uint32_t point : coarse) {
    append(raw_, raw_of_.at(batch.number[point]), lights, parts);
  }
  if (coarse.empty()) return parts;
  const PointLinks links = links_between(batch, coarse);
  parts.indirect = filter_irradiance(std::move(parts.indirect), links, layer_powers_,
                                     {.rounds = averaged.rounds, .tolerated = of_indirect});
  parts.direct = filter_irradiance(std::move(parts.direct), links, layer_powers_,
                                   {.rounds = averaged.rounds, .tolerated = of_direct});
  return parts;
}

/// Finer nodes averaged with the points next to them, as gathered.
GatheredIrradiance GatheredNodes::with_neighbours(const GatheredIrradiance& raw,
                                                  const NodeBatch& batch,
                                                  std::span<const std::uint32_t> fine,
                                                  const NoiseTolerance& tolerated) const {
  std::vector<std::size_t> rows;
  if (!fine.empty()) {
    for (const std::uint64_t number : batch.number) rows.push_back(raw_of_.at(number));
  }
  const KnownPoints points(raw, std::move(rows), layer_powers_);
  return means_of(raw, fine.size(), layer_powers_, [&](std::size_t i, auto& mean) {
    const std::uint32_t node = fine[i];
    mean.add_own(points, node);
    for (std::uint32_t j = batch.first_neighbour[node]; j < batch.first_neighbour[node + 1]; ++j) {
      mean.add_other(points, batch.neighbour[j], tolerated);
    }
  });
}

/// Finer nodes averaged with what lies around them at coarser levels.
///   known   of nodes valued before
///   found   of the fine nodes
GatheredIrradiance GatheredNodes::corrected(const GatheredIrradiance& known,
                                            const GatheredIrradiance& found, const NodeBatch& batch,
                                            std::span<const std::uint32_t> fine,
                                            const NoiseTolerance& tolerated) const {
  const GatheredIrradiance expected =
      means_of(found, fine.size(), layer_powers_, [&](std::size_t i, auto& mean) {
        for (const std::uint64_t parent : batch.parents[fine[i]]) {
          mean.add(known, row_of_.at(parent));
        }
      });
  const KnownPoints found_points(found, layer_powers_), expected_points(expected, layer_powers_);
  return means_of(found, fine.size(), layer_powers_, [&](std::size_t i, auto& mean) {
    mean.add_own(found_points, i);
    mean.add_other(expected_points, i, tolerated, defaults::weight_of_parents);
  });
}

}  // namespace photile::cache
