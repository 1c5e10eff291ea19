#include "render/light_map_estimates.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimate/estimate_writer.hpp"
#include "estimate/map_order.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"
#include "render/reflected_radiance.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/largest.hpp"

namespace photile {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t hits_per_blend_task = 1024;

/// Levels of light maps that serve a hit.
int levels_for(const PrimaryHits& hits, std::size_t hit, float faint) {
  return trace::largest(hits.throughput[hit]) < faint ? 1 : LightMaps::all_rounds;
}

/// Mean flux of a photon at the powers, luminance.
double mean_photon(const Photons& photons, std::span<const double> powers) {
  double sum = 0;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const std::size_t layer = photons.light.empty() ? 0 : photons.light[i];
    sum += powers[layer] * luminance(glm::dvec3(photons.flux[i]));
  }
  return photons.size() == 0 ? 0 : sum / static_cast<double>(photons.size());
}

/// Metres, 0 without photons: a sixteenth of the distance of photons that are spread evenly over
/// the triangles that have some. Estimates that find a photon take more surface.
double least_spacing(const Scene& scene, const Photons& photons) {
  double area = 0;
  for (std::uint32_t sided = 0; sided + 1 < photons.first_of.size(); ++sided) {
    if (photons.first_of[sided + 1] > photons.first_of[sided]) {
      area += triangle_area(scene, sided / 2);
    }
  }
  return photons.size() == 0 ? 0 : std::sqrt(area / static_cast<double>(photons.size())) / 16;
}

/// Writes the light of hits, or its errors, one after another, from nodes or from their own
/// estimates.
class Blend {
 public:
  ///   place    per hit: that of its own estimate, or none
  ///   blends   per hit, where it has none
  Blend(const SceneNeeds& needs, const Estimates& nodes, const PrimaryHits& hits,
        const Estimates& alone, std::span<const std::uint32_t> place,
        std::span<const NodeBlend> blends)
      : needs_(needs), nodes_(nodes), hits_(hits), alone_(alone), place_(place), blends_(blends) {}

  /// Of hits [first, last).
  Estimates of(std::size_t first, std::size_t last) const {
    Estimates estimates;
    estimate::EstimateWriter writer(needs_, estimates);
    for (std::size_t hit = first; hit < last; ++hit) {
      if (place_[hit] == none) {
        add_from_maps(hit, writer);
      } else {
        add_alone(hit, place_[hit], writer);
      }
      writer.end_hit();
    }
    return estimates;
  }

  /// Sum of the squares of relative standard errors of hits [first, last) that maps serve.
  double squared_errors(const LightMaps& maps, std::size_t first, std::size_t last) const {
    double sum = 0;
    for (std::size_t hit = first; hit < last; ++hit) {
      if (place_[hit] != none) continue;
      const double error = maps.relative_error(blends_[hit]);
      sum += error * error;
    }
    return sum;
  }

 private:
  void add_from_maps(std::size_t hit, estimate::EstimateWriter& writer) const {
    const NodeBlend& blend = blends_[hit];
    const glm::vec3 reflects = hits_.diffuse_albedo[hit] * glm::one_over_pi<float>();
    for (std::size_t i = 0; i < blend.node.size(); ++i) {
      if (blend.weight[i] == 0.0f) continue;
      for_each_estimate(nodes_, blend.node[i], needs_.light_count,
                        [&](std::size_t layer, std::size_t value) {
                          const glm::vec3 light = blend.weight[i] * nodes_.irradiance[value];
                          writer.add(static_cast<std::uint32_t>(layer), light, reflects * light);
                        });
    }
  }

  void add_alone(std::size_t hit, std::uint32_t place, estimate::EstimateWriter& writer) const {
    for_each_estimate(alone_, place, needs_.light_count, [&](std::size_t layer, std::size_t value) {
      const glm::vec3& light = alone_.irradiance[value];
      writer.add(static_cast<std::uint32_t>(layer), light,
                 alone_.radiance.empty()
                     ? hits_.diffuse_albedo[hit] * glm::one_over_pi<float>() * light
                     : alone_.radiance[value]);
    });
  }

  const SceneNeeds& needs_;
  const Estimates& nodes_;
  const PrimaryHits& hits_;
  const Estimates& alone_;
  std::span<const std::uint32_t> place_;
  std::span<const NodeBlend> blends_;
};

}  // namespace

LightMapParameters light_map_parameters(const Scene& scene, const Photons& photons, int neighbours,
                                        double radius, double angle_degrees, double detail,
                                        std::span<const double> powers) {
  // The radius is so many times the distance to the k-th photon of a typical estimate.
  const double reach = radius / defaults::radius_over_median_kth_distance;
  LightMapParameters parameters;
  const double steps =
      std::max(std::round(std::log2(reach / defaults::light_map_spacing)),
               std::ceil(std::log2(least_spacing(scene, photons) / defaults::light_map_spacing)));
  parameters.spacing = defaults::light_map_spacing * std::exp2(steps);
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

LightMapEstimates::LightMapEstimates(const RayScene& rays, const LightMapParameters& parameters,
                                     MapEstimators& photons, NodeSource* nodes)
    : scene_(rays.scene()),
      needs_(rays.needs()),
      gathered_(nodes != nullptr),
      maps_(scene_, parameters),
      sight_(rays, maps_) {
  add_pass(photons, nodes);
}

void LightMapEstimates::add_pass(MapEstimators& photons, NodeSource* nodes) {
  photons_.push_back(&photons);
  source_.add(nodes ? *nodes : photon_nodes_.emplace_back(photons));
}

std::uint64_t LightMapEstimates::Passes::bytes() const {
  std::uint64_t sum = first_->bytes();
  for (const NodeSource* source : further_) sum += source->bytes();
  return sum;
}

void LightMapEstimates::Passes::forget() {
  first_->forget();
  for (NodeSource* source : further_) source->forget();
}

Estimates LightMapEstimates::estimate(const PrimaryHits& hits, const Progress& progress,
                                      std::size_t pass, float faint) {
  std::vector<std::uint8_t> is_alone(hits.size(), 0);
  std::vector<std::uint32_t> served, served_faint;
  for (std::uint32_t hit = 0; hit < hits.size(); ++hit) {
    if (serves(hits, hit)) {
      (levels_for(hits, hit, faint) > 1 ? served : served_faint).push_back(hit);
    } else {
      is_alone[hit] = 1;
    }
  }
  const Stopwatch stopwatch;
  if (served.size() == hits.size()) {
    maps_.fill(hits, source_, progress);
  } else {
    maps_.fill(estimate::reordered(hits, 0, served), source_, progress);
    maps_.fill(estimate::reordered(hits, 0, served_faint), source_, progress, LightMaps::all_rounds,
               1);
  }
  maps_.refine(source_, progress);
  fill_time_ += stopwatch.taken();
  const std::vector<NodeBlend> blends = blends_of(hits, faint, is_alone);
  std::vector<std::uint32_t> alone, place(hits.size(), none);
  for (std::uint32_t hit = 0; hit < hits.size(); ++hit) {
    if (is_alone[hit] == 0) continue;
    place[hit] = static_cast<std::uint32_t>(alone.size());
    alone.push_back(hit);
  }
  hits_alone_ += alone.size();
  hits_read_ += hits.size() - alone.size();
  const Estimates own =
      alone.empty() ? Estimates{} : photons_[pass]->estimate(estimate::reordered(hits, 0, alone));
  const Blend blend(needs_, maps_.values(), hits, own, place, blends);
  std::vector<Estimates> parts((hits.size() + hits_per_blend_task - 1) / hits_per_blend_task);
  std::vector<double> squared_errors(parts.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * hits_per_blend_task;
    const std::size_t last = std::min(hits.size(), first + hits_per_blend_task);
    parts[part] = blend.of(first, last);
    squared_errors[part] = blend.squared_errors(maps_, first, last);
  });
  for (const double part : squared_errors) squared_errors_ += part;
  return joined(std::move(parts));
}

Estimates LightMapEstimates::errors(const PrimaryHits& hits, const Estimates& estimates,
                                    const Estimates& of_nodes, float faint) const {
  std::vector<std::uint8_t> is_alone(hits.size(), 0);
  for (std::uint32_t hit = 0; hit < hits.size(); ++hit) is_alone[hit] = serves(hits, hit) ? 0 : 1;
  const std::vector<NodeBlend> blends = blends_of(hits, faint, is_alone);
  std::vector<std::uint32_t> place(hits.size(), none);
  for (std::uint32_t hit = 0; hit < hits.size(); ++hit) {
    if (is_alone[hit] != 0) place[hit] = hit;
  }
  Estimates own = estimates;
  const float relative = 1 / std::sqrt(static_cast<float>(photons_.front()->neighbours()));
  for (glm::vec3& light : own.irradiance) light *= relative;
  for (glm::vec3& light : own.radiance) light *= relative;
  const Blend blend(needs_, of_nodes, hits, own, place, blends);
  std::vector<Estimates> parts((hits.size() + hits_per_blend_task - 1) / hits_per_blend_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * hits_per_blend_task;
    parts[part] = blend.of(first, std::min(hits.size(), first + hits_per_blend_task));
  });
  return joined(std::move(parts));
}

Estimates LightMapEstimates::joined(std::vector<Estimates> parts) const {
  Estimates all;
  if (needs_.many_lights()) all.first.push_back(0);
  for (Estimates& part : parts) all.append(std::move(part));
  return all;
}

std::vector<NodeBlend> LightMapEstimates::blends_of(const PrimaryHits& hits, float faint,
                                                    std::vector<std::uint8_t>& alone) const {
  std::vector<NodeBlend> blends(hits.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hits.size(), hits_per_blend_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const trace::FlushDenormals flush_denormals;
                      for (std::size_t hit = range.begin(); hit < range.end(); ++hit) {
                        if (alone[hit] != 0) continue;
                        const std::uint32_t sided = hits.sided_triangle[hit];
                        const int levels = levels_for(hits, hit, faint);
                        maps_.find(sided, hits.position[hit], blends[hit], levels);
                        const bool seen = sight_.look(sided, hits.position[hit], blends[hit]);
                        // Where photons value nodes they would say no more at the hit, and may
                        // have to be traced first.
                        alone[hit] = gathered_ && !seen && levels > 1 ? 1 : 0;
                      }
                    });
  return blends;
}

double LightMapEstimates::error() const {
  return hits_read_ == 0 ? 0.0 : std::sqrt(squared_errors_ / static_cast<double>(hits_read_));
}

bool LightMapEstimates::serves(const PrimaryHits& hits, std::size_t hit) const {
  const Material& material =
      scene_.materials[scene_.triangle_material[triangle_of(hits.sided_triangle[hit])]];
  const bool has_lobe = !hits.lobe.empty() && hits.lobe[hit].f90 > 0.0f;
  return !has_lobe && material.normal_texture == none;
}

}  // namespace photile
