#include "cache/surface_cache.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "cache/charts.hpp"
#include "cache/gathered_nodes.hpp"
#include "cache/node_mix.hpp"
#include "estimate/map_order.hpp"
#include "light/light_at_points.hpp"
#include "light/row_sum.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/statistics.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::cache {

namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task = 1024;

constexpr int coarsest_level = 1;

/// Per oriented face: flux of its photons at the powers, luminance. Of those that this process
/// answers for, where there are several.
std::vector<double> flux_of_triangles(const Photons& photons, std::span<const double> powers) {
  std::vector<double> flux(std::max<std::size_t>(1, photons.first_of.size()) - 1, 0.0);
  tbb::parallel_for(std::size_t{0}, flux.size(), [&](std::size_t s) {
    if (photons.of_all && photons.of_all->own[s] == 0) return;
    for (std::size_t i = photons.first_of[s]; i < photons.first_of[s + 1]; ++i) {
      const std::size_t layer = photons.light.empty() ? 0 : photons.light[i];
      flux[s] += powers[layer] * luminance(glm::dvec3(photons.flux[i]));
    }
  });
  return flux;
}

/// Mean flux of a photon at the powers, luminance.
double mean_photon(const Photons& photons, std::span<const double> powers) {
  std::vector<double> flux = flux_of_triangles(photons, powers);
  if (photons.of_all) {
    // One process has a number for each, the others zeros: bits add up to those of the number.
    std::vector<std::uint64_t> bits;
    for (const double one : flux) bits.push_back(std::bit_cast<std::uint64_t>(one));
    photons.of_all->processes->sum(bits);
    for (std::size_t s = 0; s < flux.size(); ++s) flux[s] = std::bit_cast<double>(bits[s]);
  }
  const double sum = std::accumulate(flux.begin(), flux.end(), 0.0);
  return photons.total() == 0 ? 0 : sum / static_cast<double>(photons.total());
}

/// Metres: that of photons spread evenly over the triangles that have some; 0 without photons.
double mean_distance(const Scene& scene, const Photons& photons) {
  double area = 0;
  for (std::uint32_t face = 0; face + 1 < photons.first_of.size(); ++face) {
    const std::uint32_t landed = photons.of_all
                                     ? photons.of_all->landed[face]
                                     : photons.first_of[face + 1] - photons.first_of[face];
    if (landed > 0) area += triangle_area(scene, face / 2);
  }
  return photons.total() == 0 ? 0 : std::sqrt(area / static_cast<double>(photons.total()));
}

/// Metres: half the median distance from a photon to its nearest; 0 where most lie in the same
/// points.
double near_photons(const Photons& photons) {
  if (photons.total() < 2) return 0;
  try {
    return automatic_radius(photons, 1) / defaults::radius_over_median_kth_distance / 2;
  } catch (const UsageError&) {
    return 0;
  }
}

/// Metres, for estimates that reach so far. Photons know light no finer than they lie apart: most
/// may lie close together, up to a sixteenth of the mean, which is looked up where it counts.
double least_spacing(const Scene& scene, const Photons& photons, double reach) {
  const double distance = mean_distance(scene, photons);
  return reach > distance ? 0 : std::max(distance / 16, near_photons(photons));
}

const Material& material_of(const Scene& scene, std::uint32_t oriented_face) {
  return scene.materials[scene.triangle_material[triangle_of(oriented_face)]];
}

/// Calls write(point, sums) for each of so many points, which adds the lights of its row. Work is
/// shared by TBB.
template <class Write>
LightTable rows_of(std::size_t points, const SceneNeeds& needs, const Write& write) {
  std::vector<LightTable> parts((points + points_per_task - 1) / points_per_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    LightTable& rows = parts[part] = LightTable(needs);
    light::RowSum<light::Reflection> sums(needs.light_count);
    const std::size_t last = std::min(points, (part + 1) * points_per_task);
    for (std::size_t point = part * points_per_task; point < last; ++point) {
      write(point, sums);
      light::end_row(sums, rows, needs.tells_radiance());
    }
  });
  LightTable all(needs);
  for (LightTable& part : parts) all.append(std::move(part));
  return all;
}

/// What the nodes around a point say of a light.
struct ByNormal {
  glm::vec3 irradiance{0.0f};
  glm::vec4 by_normal{0.0f};
};

/// The light of points between nodes, or its errors. Irradiance is that of the surface. Where nodes
/// tell light by the normal, what is reflected goes by the shading normal, or by that of a normal
/// map, in the colour of the irradiance.
///   nodes   of each point
///   of      the nodes
LightTable interpolated(const Scene& scene, const SceneNeeds& needs, const PrimaryHits& points,
                        std::span<const BilinearWeights> nodes, const LightTable& of) {
  const auto for_each = [&](std::size_t point, const auto& visit) {
    for (std::size_t i = 0; i < nodes[point].node.size(); ++i) {
      const float weight = nodes[point].weight[i];
      if (weight == 0.0f) continue;
      of.for_each(nodes[point].node[i],
                  [&](std::size_t layer, std::size_t entry) { visit(layer, entry, weight); });
    }
  };
  if (of.by_normal.empty()) {
    return rows_of(points.size(), needs, [&](std::size_t point, auto& sums) {
      const glm::vec3 reflects = points.diffuse_albedo[point] * glm::one_over_pi<float>();
      for_each(point, [&](std::size_t layer, std::size_t entry, float weight) {
        const glm::vec3 light = weight * of.irradiance[entry];
        sums.of(layer).add(light, reflects * light);
      });
    });
  }
  tbb::enumerable_thread_specific<light::RowSum<ByNormal>> layers_of_threads(needs.light_count);
  return rows_of(points.size(), needs, [&](std::size_t point, auto& sums) {
    light::RowSum<ByNormal>& layers = layers_of_threads.local();
    for_each(point, [&](std::size_t layer, std::size_t entry, float weight) {
      ByNormal& light = layers.of(layer);
      light.irradiance += weight * of.irradiance[entry];
      light.by_normal += weight * of.by_normal[entry];
    });
    const glm::vec3 normal =
        material_of(scene, points.oriented_face[point]).normal_texture != none
            ? points.lobe[point].normal
            : trace::shading_normal(scene, points.oriented_face[point], points.position[point]);
    const glm::vec3 reflects = points.diffuse_albedo[point] * glm::one_over_pi<float>();
    layers.take_lit([&](std::size_t layer, const ByNormal& light) {
      if (light.irradiance == glm::vec3(0.0f)) return;
      sums.of(layer).add(light.irradiance,
                         reflects * turned(light.irradiance, light.by_normal, normal));
    });
  });
}

/// Light that was found at the points themselves, in the form of that which lies between nodes.
LightTable completed(const SceneNeeds& needs, const PrimaryHits& points, const LightTable& found) {
  return rows_of(points.size(), needs, [&](std::size_t point, auto& sums) {
    found.for_each(point, [&](std::size_t layer, std::size_t entry) {
      sums.of(layer).add(found.irradiance[entry],
                         light::reflected_radiance(points, point, found, entry));
    });
  });
}

}  // namespace

double ErrorSum::mean() const {
  return hits == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(hits));
}

LightMapParameters light_map_parameters(const Scene& scene, const Photons& photons, int neighbours,
                                        double radius, double angle_degrees, double spacing,
                                        double detail, std::span<const double> powers) {
  // The radius is so many times the distance to the k-th photon of a typical estimate.
  const double reach = radius / defaults::radius_over_median_kth_distance;
  LightMapParameters parameters;
  const double steps = std::max(
      std::round(std::log2(reach / defaults::light_map_spacing)),
      std::ceil(std::log2(least_spacing(scene, photons, reach) / defaults::light_map_spacing)));
  parameters.spacing = spacing > 0 ? spacing : defaults::light_map_spacing * std::exp2(steps);
  if (detail > 0) {
    // One more where the division is a rounding above a power of two would halve the detail again.
    const double halvings = std::ceil(std::log2(parameters.spacing / detail) - 1e-9);
    parameters.levels =
        1 + static_cast<int>(std::clamp(halvings, 0.0, limits::max_light_map_levels - 1.0));
  }
  parameters.angle_degrees = angle_degrees;
  parameters.neighbours = neighbours;
  // Where k photons are just within the radius.
  parameters.sparse_irradiance =
      neighbours * mean_photon(photons, powers) / (glm::pi<double>() * radius * radius);
  parameters.powers.assign(powers.begin(), powers.end());
  return parameters;
}

SurfaceCache::SurfaceCache(const RayScene& rays, const LightMapParameters& parameters,
                           light::LightAtPoints& elsewhere, NodeSource& source,
                           SecondaryLight* secondary)
    : scene_(rays.scene()),
      needs_(rays.needs()),
      shared_(parameters.processes != nullptr),
      neighbours_(parameters.neighbours),
      elsewhere_(elsewhere),
      source_(source),
      secondary_(secondary),
      maps_(scene_, parameters),
      visibility_(rays, maps_) {}

/// What answers for points, by their positions among all, and the points.
struct SurfaceCache::Reading {
  struct Part {
    std::vector<std::uint32_t> row;
    PrimaryHits points;
    std::vector<BilinearWeights> nodes;  ///< of each point; of none where the point is alone

    explicit Part(std::vector<std::uint32_t> rows, const PrimaryHits& all)
        : row(std::move(rows)), points(estimate::reordered(all, 0, row)), nodes(row.size()) {}
  };
  Part alone;   ///< have estimates of their own
  Part fine;    ///< lie between nodes
  Part coarse;  ///< are answered by the light where rays end, or by the coarsest nodes

  /// Rows of the parts, one part after another, in the order of all points.
  LightTable in_order(LightTable rows, const LightTable& of_fine,
                      const LightTable& of_coarse) const {
    rows.append(of_fine);
    rows.append(of_coarse);
    std::vector<std::uint32_t> order = alone.row;
    order.insert(order.end(), fine.row.begin(), fine.row.end());
    order.insert(order.end(), coarse.row.begin(), coarse.row.end());
    return estimate::restored(rows, order);
  }
};

LightTable SurfaceCache::at(const PrimaryHits& points, const Progress& progress) {
  return light_of(read(points, progress), progress);
}

LightAndErrors SurfaceCache::with_errors(const PrimaryHits& points, const GatheredNodes& nodes,
                                         const Progress& progress) {
  const Reading reading = read(points, progress);
  LightTable light = light_of(reading, progress);
  const auto relative = static_cast<float>(photon_noise().noise);
  const auto by_photons = [&](const Reading::Part& part) {
    LightTable errors = light.gathered(part.row);
    for (glm::vec3& value : errors.irradiance) value *= relative;
    for (glm::vec3& value : errors.radiance) value *= relative;
    return completed(needs_, part.points, errors);
  };
  const Reading::Part& fine = reading.fine;
  LightTable errors =
      reading.in_order(by_photons(reading.alone),
                       interpolated(scene_, needs_, fine.points, fine.nodes, nodes.errors()),
                       by_photons(reading.coarse));
  return {std::move(light), std::move(errors)};
}

LightTable SurfaceCache::light_of(const Reading& reading, const Progress& progress) {
  const auto& [alone, fine, coarse] = reading;
  hits_alone_ += alone.row.size();
  const LightTable found =
      alone.row.empty() && !shared_ ? LightTable{} : elsewhere_.at(alone.points, progress);
  const LightTable& of_coarse =
      secondary_ && !coarse.row.empty() ? secondary_->values() : maps_.values();
  return reading.in_order(completed(needs_, alone.points, found),
                          interpolated(scene_, needs_, fine.points, fine.nodes, maps_.values()),
                          interpolated(scene_, needs_, coarse.points, coarse.nodes, of_coarse));
}

/// Values what the points read, and finds it.
SurfaceCache::Reading SurfaceCache::read(const PrimaryHits& points, const Progress& progress) {
  std::vector<std::uint32_t> alone, fine, coarse;
  for (std::uint32_t point = 0; point < points.size(); ++point) {
    const bool is_coarse = !points.coarse.empty() && points.coarse[point] != 0;
    (!serves(points, point) ? alone : is_coarse ? coarse : fine).push_back(point);
  }
  Reading::Part between(std::move(fine), points), coarser(std::move(coarse), points);
  const Stopwatch stopwatch;
  if (shared_ || !between.row.empty()) maps_.fill(between.points, source_, progress);
  if (secondary_) {
    if (shared_ || !coarser.row.empty()) {
      coarser.nodes = secondary_->nodes_around(coarser.points, progress);
    }
  } else if (shared_ || !coarser.row.empty()) {
    maps_.fill(coarser.points, source_, progress, LightMaps::all_rounds, coarsest_level);
  }
  fill_time_ += stopwatch.taken();
  if (!secondary_) find_nodes(coarser.points, coarsest_level, coarser.nodes);
  const std::vector<std::uint8_t> seen =
      find_nodes(between.points, LightMaps::all_rounds, between.nodes);
  // Where photons value nodes they would say no more at a point which no node sees, and may have
  // to be traced first.
  if (secondary_ && std::find(seen.begin(), seen.end(), 0) != seen.end()) {
    std::vector<BilinearWeights> nodes;
    std::vector<std::uint32_t> rows;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] == 0) {
        alone.push_back(between.row[i]);
      } else {
        rows.push_back(between.row[i]);
        nodes.push_back(between.nodes[i]);
      }
    }
    std::sort(alone.begin(), alone.end());
    between = Reading::Part(std::move(rows), points);
    between.nodes = std::move(nodes);
  }
  count_errors(between.nodes);
  if (!secondary_) count_errors(coarser.nodes);
  return {Reading::Part(std::move(alone), points), std::move(between), std::move(coarser)};
}

/// The nodes around points. Returns 1 for each of them that one of its nodes sees, else 0.
std::vector<std::uint8_t> SurfaceCache::find_nodes(const PrimaryHits& points, int levels,
                                                   std::span<BilinearWeights> nodes) const {
  std::vector<std::uint8_t> seen(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), points_per_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const trace::FlushDenormals flush_denormals;
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const std::uint32_t face = points.oriented_face[i];
                        maps_.find(face, points.position[i], nodes[i], levels);
                        seen[i] = visibility_.keep_visible(face, points.position[i], nodes[i]);
                      }
                    });
  return seen;
}

void SurfaceCache::count_errors(std::span<const BilinearWeights> nodes) {
  for (const BilinearWeights& bilinear : nodes) {
    const double error = maps_.relative_error(bilinear);
    errors_read_.squares += error * error;
  }
  errors_read_.hits += nodes.size();
}

PhotonNoise SurfaceCache::photon_noise() const {
  return {secondary_ ? secondary_->spacing() : maps_.charts().spacing(),
          1 / std::sqrt(neighbours_)};
}

bool SurfaceCache::serves(const PrimaryHits& hits, std::size_t hit) const {
  const bool has_lobe = !hits.lobe.empty() && hits.lobe[hit].f90 > 0.0f;
  const bool mapped = material_of(scene_, hits.oriented_face[hit]).normal_texture != none;
  return !has_lobe && (!mapped || secondary_ != nullptr);
}

}  // namespace photile::cache
