#include "cache/surface_cache.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "cache/charts.hpp"
#include "cache/node_mix.hpp"
#include "estimate/map_order.hpp"
#include "light/light_at_points.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/statistics.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::cache {

namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t hits_per_interpolation_task = 1024;

/// Hits of these levels.
std::vector<std::uint32_t> hits_of(std::span<const int> levels, int level) {
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t hit = 0; hit < levels.size(); ++hit) {
    if (levels[hit] == level) chosen.push_back(hit);
  }
  return chosen;
}

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

/// Writes the light of hits, or its errors, one after another, from nodes, from the coarser
/// cache that rays read, or from their own estimates.
class Interpolation {
 public:
  ///   secondary   null where no hit reads it
  ///   row         per hit: that of its own estimate, or none
  Interpolation(const Scene& scene, const SceneNeeds& needs, const PrimaryHits& hits,
                const HitReading& reading, const LightTable& nodes, const LightTable* secondary,
                const LightTable& alone, std::span<const std::uint32_t> row)
      : scene_(scene),
        needs_(needs),
        hits_(hits),
        reading_(reading),
        nodes_(nodes),
        secondary_(secondary),
        alone_(alone),
        row_(row) {}

  /// The light of hits [first, last).
  LightTable of(std::size_t first, std::size_t last) const {
    LightTable rows(needs_);
    Sums sums(needs_.light_count);
    light::RowSum<ByNormal> layers(nodes_.by_normal.empty() ? 0 : needs_.light_count);
    for (std::size_t hit = first; hit < last; ++hit) {
      if (row_[hit] == none && reading_.levels[hit] != HitReading::secondary && layers.size() > 0) {
        add_smoothly(hit, layers, sums);
      } else if (row_[hit] == none) {
        add_from_maps(hit, reading_.levels[hit] == HitReading::secondary ? *secondary_ : nodes_,
                      sums);
      } else {
        add_alone(hit, row_[hit], sums);
      }
      light::end_row(sums, rows, needs_.tells_radiance());
    }
    return rows;
  }

  /// Sum of the squares of relative standard errors of hits [first, last) that nodes answer.
  double squared_errors(const LightMaps& maps, std::size_t first, std::size_t last) const {
    double sum = 0;
    for (std::size_t hit = first; hit < last; ++hit) {
      if (reading_.levels[hit] <= 0) continue;
      const double error = maps.relative_error(reading_.bilinear[hit]);
      sum += error * error;
    }
    return sum;
  }

 private:
  using Sums = light::RowSum<light::Reflection>;
  /// What the nodes around a hit say of a layer.
  struct ByNormal {
    glm::vec3 irradiance{0.0f};
    glm::vec4 by_normal{0.0f};
  };

  /// Irradiance is that of the surface; what is reflected goes by the shading normal, or by that of
  /// a normal map, in the colour of the irradiance.
  ///   layers   of none
  void add_smoothly(std::size_t hit, light::RowSum<ByNormal>& layers, Sums& sums) const {
    const BilinearWeights& bilinear = reading_.bilinear[hit];
    for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
      const float weight = bilinear.weight[i];
      if (weight == 0.0f) continue;
      nodes_.for_each(bilinear.node[i], [&](std::size_t layer, std::size_t value) {
        ByNormal& light = layers.of(layer);
        light.irradiance += weight * nodes_.irradiance[value];
        light.by_normal += weight * nodes_.by_normal[value];
      });
    }
    const glm::vec3 normal =
        material_of(scene_, hits_.oriented_face[hit]).normal_texture != none
            ? hits_.lobe[hit].normal
            : trace::shading_normal(scene_, hits_.oriented_face[hit], hits_.position[hit]);
    const glm::vec3 reflects = hits_.diffuse_albedo[hit] * glm::one_over_pi<float>();
    layers.take_lit([&](std::size_t layer, const ByNormal& light) {
      if (light.irradiance == glm::vec3(0.0f)) return;
      sums.of(layer).add(light.irradiance,
                         reflects * turned(light.irradiance, light.by_normal, normal));
    });
  }

  void add_from_maps(std::size_t hit, const LightTable& nodes, Sums& sums) const {
    const BilinearWeights& bilinear = reading_.bilinear[hit];
    const glm::vec3 reflects = hits_.diffuse_albedo[hit] * glm::one_over_pi<float>();
    for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
      if (bilinear.weight[i] == 0.0f) continue;
      nodes.for_each(bilinear.node[i], [&](std::size_t layer, std::size_t value) {
        const glm::vec3 light = bilinear.weight[i] * nodes.irradiance[value];
        sums.of(layer).add(light, reflects * light);
      });
    }
  }

  void add_alone(std::size_t hit, std::uint32_t row, Sums& sums) const {
    alone_.for_each(row, [&](std::size_t layer, std::size_t value) {
      const glm::vec3& light = alone_.irradiance[value];
      sums.of(layer).add(light, alone_.radiance.empty()
                                    ? hits_.diffuse_albedo[hit] * glm::one_over_pi<float>() * light
                                    : alone_.radiance[value]);
    });
  }

  const Scene& scene_;
  const SceneNeeds& needs_;
  const PrimaryHits& hits_;
  const HitReading& reading_;
  const LightTable& nodes_;
  const LightTable* secondary_;
  const LightTable& alone_;
  std::span<const std::uint32_t> row_;
};

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

LightTable SurfaceCache::at(const PrimaryHits& hits, const Progress& progress) {
  const HitReading reading = read(hits, progress);
  std::vector<std::uint32_t> alone, row(hits.size(), none);
  for (std::uint32_t hit = 0; hit < hits.size(); ++hit) {
    if (reading.levels[hit] != HitReading::own_estimate) continue;
    row[hit] = static_cast<std::uint32_t>(alone.size());
    alone.push_back(hit);
  }
  hits_alone_ += alone.size();
  const LightTable own = alone.empty() && !shared_
                             ? LightTable{}
                             : elsewhere_.at(estimate::reordered(hits, 0, alone), progress);
  const bool reads_secondary = std::find(reading.levels.begin(), reading.levels.end(),
                                         int{HitReading::secondary}) != reading.levels.end();
  const LightTable* secondary = reads_secondary ? &secondary_->values() : nullptr;
  const Interpolation bilinear(scene_, needs_, hits, reading, maps_.values(), secondary, own, row);
  std::vector<LightTable> parts((hits.size() + hits_per_interpolation_task - 1) /
                                hits_per_interpolation_task);
  std::vector<double> squared_errors(parts.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * hits_per_interpolation_task;
    const std::size_t last = std::min(hits.size(), first + hits_per_interpolation_task);
    parts[part] = bilinear.of(first, last);
    squared_errors[part] = bilinear.squared_errors(maps_, first, last);
  });
  for (const double part : squared_errors) errors_read_.squares += part;
  errors_read_.hits += static_cast<std::uint64_t>(
      std::count_if(reading.levels.begin(), reading.levels.end(), [](int l) { return l > 0; }));
  return joined(std::move(parts));
}

LightTable SurfaceCache::errors(const PrimaryHits& hits, const LightTable& estimates,
                                const LightTable& of_nodes) {
  const HitReading reading = read(hits, Progress::none());
  std::vector<std::uint32_t> row(hits.size(), none);
  for (std::uint32_t hit = 0; hit < hits.size(); ++hit) {
    if (reading.levels[hit] <= 0) row[hit] = hit;  // photons
  }
  LightTable own = estimates;
  const auto relative = static_cast<float>(photon_noise().noise);
  for (glm::vec3& light : own.irradiance) light *= relative;
  for (glm::vec3& light : own.radiance) light *= relative;
  const Interpolation bilinear(scene_, needs_, hits, reading, of_nodes, nullptr, own, row);
  std::vector<LightTable> parts((hits.size() + hits_per_interpolation_task - 1) /
                                hits_per_interpolation_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * hits_per_interpolation_task;
    parts[part] = bilinear.of(first, std::min(hits.size(), first + hits_per_interpolation_task));
  });
  return joined(std::move(parts));
}

LightTable SurfaceCache::joined(std::vector<LightTable> parts) const {
  LightTable all(needs_);
  for (LightTable& part : parts) all.append(std::move(part));
  return all;
}

HitReading SurfaceCache::read(const PrimaryHits& hits, const Progress& progress) {
  HitReading reading{std::vector<int>(hits.size(), LightMaps::all_rounds),
                     std::vector<BilinearWeights>(hits.size())};
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    if (!serves(hits, hit)) {
      reading.levels[hit] = HitReading::own_estimate;
    } else if (!hits.coarse.empty() && hits.coarse[hit] != 0) {
      reading.levels[hit] = secondary_ ? HitReading::secondary : 1;
    }
  }
  const Stopwatch stopwatch;
  fill(hits, reading.levels, progress);
  find_secondary(hits, progress, reading);
  fill_time_ += stopwatch.taken();
  find_nodes(hits, reading);
  return reading;
}

/// Values the nodes that hits read.
void SurfaceCache::fill(const PrimaryHits& hits, std::span<const int> levels,
                        const Progress& progress) {
  const bool all =
      std::all_of(levels.begin(), levels.end(), [](int l) { return l == LightMaps::all_rounds; });
  if (all && !shared_) {
    maps_.fill(hits, source_, progress);
    return;
  }
  for (const int level : {LightMaps::all_rounds, 1}) {
    maps_.fill(estimate::reordered(hits, 0, hits_of(levels, level)), source_, progress,
               LightMaps::all_rounds, level);
  }
}

void SurfaceCache::find_secondary(const PrimaryHits& hits, const Progress& progress,
                                  HitReading& reading) {
  const std::vector<std::uint32_t> chosen = hits_of(reading.levels, HitReading::secondary);
  if (chosen.empty() && !(secondary_ && shared_)) return;
  const std::vector<BilinearWeights> bilinear =
      secondary_->nodes_around(estimate::reordered(hits, 0, chosen), progress);
  for (std::size_t i = 0; i < chosen.size(); ++i) reading.bilinear[chosen[i]] = bilinear[i];
}

/// Hits that no node sees are to have estimates of their own.
void SurfaceCache::find_nodes(const PrimaryHits& hits, HitReading& reading) const {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hits.size(), hits_per_interpolation_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const trace::FlushDenormals flush_denormals;
                      for (std::size_t hit = range.begin(); hit < range.end(); ++hit) {
                        int& levels = reading.levels[hit];
                        if (levels <= 0) continue;
                        const std::uint32_t face = hits.oriented_face[hit];
                        BilinearWeights& bilinear = reading.bilinear[hit];
                        maps_.find(face, hits.position[hit], bilinear, levels);
                        const bool seen =
                            visibility_.keep_visible(face, hits.position[hit], bilinear);
                        // Where photons value nodes they would say no more at the hit, and may
                        // have to be traced first.
                        if (secondary_ && !seen && levels > 1) levels = HitReading::own_estimate;
                      }
                    });
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
