#include "cache/gathered_nodes.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cache/irradiance_filter.hpp"
#include "cache/light_maps.hpp"
#include "common/touched_memory.hpp"
#include "estimate/map_order.hpp"
#include "photile/defaults.hpp"
#include "photile/limits.hpp"
#include "trace/ray_query.hpp"

namespace photile::cache {
namespace {

/// Points that a point is averaged with.
constexpr NodeSource::Surroundings averaged{.window = defaults::averaged_window,
                                            .rounds = defaults::averaged_rounds,
                                            .fine_window = defaults::averaged_fine_window};
/// Differences that may be noise. Direct light ends at borders: beyond the horizon of
/// a light that is near, points are certainly dark, and the error of points before it is large.
constexpr NoiseTolerance of_indirect{.errors = defaults::tolerated_errors};
constexpr NoiseTolerance of_direct{.errors = defaults::tolerated_errors,
                                   .ratio = defaults::tolerated_error_ratio};

std::vector<std::uint64_t> numbers_at(const NodeBatch& batch,
                                      std::span<const std::uint32_t> chosen) {
  std::vector<std::uint64_t> numbers;
  for (const std::uint32_t point : chosen) numbers.push_back(batch.number[point]);
  return numbers;
}

/// Links between the chosen points only, by their numbers among those.
PointLinks links_between(const PointLinks& all, std::span<const std::uint32_t> chosen) {
  std::vector<std::uint32_t> index_of(all.position.size(), none);
  for (std::uint32_t i = 0; i < chosen.size(); ++i) index_of[chosen[i]] = i;
  const auto write = [&](std::size_t i, std::vector<std::uint32_t>& to) {
    for (const std::uint32_t other : all.of(chosen[i])) to.push_back(index_of[other]);
  };
  PointLinks links{index_rows_by_tasks(chosen.size(), write), {}};
  for (const std::uint32_t point : chosen) links.position.push_back(all.position[point]);
  return links;
}

/// The difference of two points, layer by layer, and the light of the brighter one; luminance of
/// all layers at their powers.
struct Contrast {
  double difference = 0, light = 0;

  Contrast(const KnownPoints& points, std::size_t a, std::size_t b,
           std::span<const double> layer_powers) {
    thread_local std::vector<double> less;
    less.assign(layer_powers.size(), 0.0);
    points.for_each_layer(a, [&](std::size_t layer, const LightTable::Total& light) {
      less[layer] = light.luminance;
    });
    points.for_each_layer(b, [&](std::size_t layer, const LightTable::Total& light) {
      less[layer] -= light.luminance;
    });
    for (std::size_t layer = 0; layer < less.size(); ++layer) {
      difference += layer_powers[layer] * std::abs(less[layer]);
    }
    light = std::max(points.all(a).luminance, points.all(b).luminance);
  }
};

/// By defaults::few_nodes.
double times_where_few(const Scene& scene, double spacing) {
  double area = 0;
  for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    area += triangle_area(scene, triangle);
  }
  if (!(area > 0)) return 1;
  return std::clamp(defaults::few_nodes * spacing * spacing / area, 1.0,
                    defaults::most_times_where_few);
}

/// The light of some of the points, in this order.
GatheredParts gathered(const GatheredParts& from, std::span<const std::uint32_t> rows) {
  GatheredParts parts{from.indirect.gathered(rows), from.direct.gathered(rows), {}};
  for (const std::uint32_t row : rows) parts.distance.push_back(from.distance[row]);
  return parts;
}

/// The light that all rays and light samples found at the same points.
GatheredParts mean_of(const GatheredParts& a, NodeRays of_a, const GatheredParts& b,
                      NodeRays of_b) {
  const auto share = [](int one, int other) {
    return static_cast<float>(one) / static_cast<float>(std::max(1, one + other));
  };
  const float rays_a = share(of_a.rays, of_b.rays), rays_b = share(of_b.rays, of_a.rays);
  GatheredParts mean{sum_of(a.indirect, b.indirect, rays_a, rays_b),
                     sum_of(a.direct, b.direct, share(of_a.light_samples, of_b.light_samples),
                            share(of_b.light_samples, of_a.light_samples)),
                     {}};
  for (std::size_t i = 0; i < a.distance.size(); ++i) {
    mean.distance.push_back(1 / (rays_a / a.distance[i] + rays_b / b.distance[i]));
  }
  return mean;
}

}  // namespace

void GatheredPoints::append(std::span<const std::uint64_t> numbers, NodeRays of_each,
                            GatheredParts found) {
  for (const std::uint64_t number : numbers) {
    row_of.insert({number, static_cast<std::uint32_t>(rays.size())});
    rays.push_back(of_each);
  }
  light.indirect.append(std::move(found.indirect));
  light.direct.append(std::move(found.direct));
  light.distance.insert(light.distance.end(), found.distance.begin(), found.distance.end());
}

GatheredNodesParameters rays_of_nodes(const Scene& scene, int coarse, double spacing) {
  // Shadow borders stand at the finer levels: there light samples matter more than rays.
  // Nine of these are averaged. In the open few light samples find the sky through a window, and
  // the light of single samples would show.
  const bool open = std::any_of(scene.lights.begin(), scene.lights.end(),
                                [](const Light& light) { return light.is_distant(); });
  const int of_few = static_cast<int>(std::lround(times_where_few(scene, spacing) * coarse));
  const int rays = std::min(std::max(of_few, open ? defaults::times_in_the_open * coarse : 0),
                            limits::max_gathering_rays);
  const int fine = std::max((rays + 3) / 4, std::min(rays, defaults::least_rays));
  const auto light_samples_of = [](int of_rays) {
    return std::min(defaults::light_samples_per_ray * of_rays, limits::max_direct_rays);
  };
  return {{rays, light_samples_of(of_few)}, {fine, light_samples_of(open ? of_few : fine)}};
}

NodeSource::Surroundings GatheredNodes::surroundings() const { return averaged; }

std::uint64_t GatheredNodes::bytes() const {
  const std::size_t rows = former_.row_of.size() + raw_.row_of.size();
  return former_.light.bytes() + raw_.light.bytes() + relative_errors_.size() * sizeof(float) +
         gather_.ends().bytes() + rows * 2 * sizeof(std::pair<std::uint64_t, std::uint32_t>);
}

void GatheredNodes::forget() {
  raw_ = {};
  relative_errors_ = {};
  LightMaps& ends = gather_.ends();
  ends.forget(std::vector<std::uint8_t>(ends.statistics().nodes, 0));
}

NodeValues GatheredNodes::value(const NodeBatch& batch, const Progress& progress) {
  const auto points_that_are = [&](bool coarse) {
    return numbers_where(batch.points.size(),
                         [&](std::uint32_t point) { return (batch.coarse[point] != 0) == coarse; });
  };
  const std::vector<std::uint32_t> coarse = points_that_are(true);
  std::vector<std::uint32_t> fine = points_that_are(false);
  gather_new(batch, coarse, rays_.coarse, progress);
  gather_new(batch, fine, rays_.fine, progress);
  std::vector<std::uint32_t> rows(batch.number.size());
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t i) { rows[i] = raw_.row_of.at(batch.number[i]); });
  const PointLinks links = visible_links(batch, rows);
  GatheredParts all = smoothed(links, rows, coarse);
  std::erase_if(fine, [&](std::uint32_t point) { return point >= batch.nodes; });
  all.indirect.append(
      means_with_neighbours(raw_.light.indirect, rows, links, fine, layer_powers_, of_indirect));
  all.direct.append(
      means_with_neighbours(raw_.light.direct, rows, links, fine, layer_powers_, of_direct));

  std::vector<std::uint32_t> row_of_node;
  auto next_coarse = std::uint32_t{0}, next_fine = static_cast<std::uint32_t>(coarse.size());
  for (std::uint32_t node = 0; node < batch.nodes; ++node) {
    row_of_node.push_back(batch.coarse[node] ? next_coarse++ : next_fine++);
  }
  NodeValues values;
  values.light = sum_of(all.indirect.gathered(row_of_node), all.direct.gathered(row_of_node));
  all = {};
  values.error.resize(batch.nodes);
  const std::size_t before = relative_errors_.size();
  relative_errors_.resize(before + values.light.irradiance.size());
  tbb::parallel_for(std::size_t{0}, batch.nodes, [&](std::size_t node) {
    values.error[node] = static_cast<float>(values.light.total(node, layer_powers_).error);
    values.light.for_each(node, [&](std::size_t, std::size_t entry) {
      const double light = luminance(glm::dvec3(values.light.irradiance[entry]));
      relative_errors_[before + entry] =
          light > 0 ? static_cast<float>(values.light.error(entry) / light) : 0.0f;
    });
  });
  values.light.drop_batches();
  for (std::uint32_t node = 0; node < batch.nodes; ++node) {
    values.distance.push_back(raw_.light.distance[rows[node]]);
  }
  return values;
}

LightTable GatheredNodes::errors(LightTable light) const {
  for (std::size_t i = 0; i < light.irradiance.size(); ++i) {
    light.irradiance[i] *= relative_errors_[i];
    if (!light.by_normal.empty()) light.by_normal[i] *= relative_errors_[i];
  }
  return light;
}

/// Gathers at points that have no rays yet, or fewer than they are to have.
void GatheredNodes::gather_new(const NodeBatch& batch, std::span<const std::uint32_t> points,
                               NodeRays rays, const Progress& progress) {
  std::map<NodeRays, std::vector<std::uint32_t>> with;  // by the rays that they have
  const auto is_new = [&](std::uint32_t i) {
    return !raw_.row_of.contains(batch.number[points[i]]);
  };
  for (const std::uint32_t i : numbers_where(points.size(), is_new)) {
    const std::uint32_t point = points[i];
    const auto known = former_.row_of.find(batch.number[point]);
    with[known == former_.row_of.end() ? NodeRays{} : former_.rays[known->second]].push_back(point);
  }
  for (const auto& [before, chosen] : with) {
    const NodeRays more{std::max(0, rays.rays - before.rays),
                        std::max(0, rays.light_samples - before.light_samples)};
    const std::vector<std::uint64_t> numbers = numbers_at(batch, chosen);
    GatheredParts light, known;
    if (more != NodeRays{}) {
      light = gather_.gather(estimate::reordered(batch.points, chosen), numbers, more.rays,
                             more.light_samples, progress, before);
    }
    if (before != NodeRays{}) {
      std::vector<std::uint32_t> former;
      for (const std::uint64_t number : numbers) former.push_back(former_.row_of.at(number));
      known = gathered(former_.light, former);
      light = more == NodeRays{} ? std::move(known) : mean_of(known, before, light, more);
    }
    raw_.append(numbers, {before.rays + more.rays, before.light_samples + more.light_samples},
                std::move(light));
  }
}

/// The links of a batch, without those across what stands on the surface between two points, such
/// as a wall on a floor that runs on under it. Only points whose light is unlike are looked at: a
/// bright one with a large error would brighten a dark one.
///   rows   of all points
PointLinks GatheredNodes::visible_links(const NodeBatch& batch,
                                        std::span<const std::uint32_t> rows) const {
  if (batch.neighbours.size() == 0) return {{}, batch.points.position};
  const KnownPoints indirect(raw_.light.indirect, {rows.begin(), rows.end()}, layer_powers_);
  const KnownPoints direct(raw_.light.direct, {rows.begin(), rows.end()}, layer_powers_);
  const Scene& scene = gather_.rays().scene();
  const auto location = [&](std::size_t point) {
    return trace::location_on(scene, batch.points.oriented_face[point],
                              batch.points.position[point]);
  };
  const auto write = [&](std::size_t point, std::vector<std::uint32_t>& to) {
    const trace::FlushDenormals flush_denormals;
    for (const std::uint32_t other : batch.neighbours.of(point)) {
      const Contrast reflected(indirect, point, other, layer_powers_);
      const Contrast sent(direct, point, other, layer_powers_);
      if (reflected.difference + sent.difference <=
              defaults::parting_contrast * std::max(reflected.light, sent.light) ||
          sees(gather_.rays(), location(point), location(other))) {
        to.push_back(other);
      }
    }
  };
  return {index_rows_by_tasks(batch.points.size(), write), batch.points.position};
}

/// Coarse points averaged with those around them.
GatheredParts GatheredNodes::smoothed(const PointLinks& links, std::span<const std::uint32_t> rows,
                                      std::span<const std::uint32_t> coarse) const {
  if (coarse.empty()) return {};
  std::vector<std::uint32_t> of_coarse;
  for (const std::uint32_t point : coarse) of_coarse.push_back(rows[point]);
  GatheredParts parts = gathered(raw_.light, of_coarse);
  const PointLinks between = links_between(links, coarse);
  parts.indirect = filter_irradiance(std::move(parts.indirect), between, layer_powers_,
                                     {.rounds = averaged.rounds, .tolerated = of_indirect});
  parts.direct = filter_irradiance(std::move(parts.direct), between, layer_powers_,
                                   {.rounds = averaged.rounds, .tolerated = of_direct});
  return parts;
}

}  // namespace photile::cache
