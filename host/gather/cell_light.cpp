#include "gather/cell_light.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "estimate/map_order.hpp"
#include "photile/statistics.hpp"
#include "render/reflected_radiance.hpp"
#include "trace/diffuse_part.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/hit_batch.hpp"
#include "trace/largest.hpp"

namespace photile::gathering {
namespace {

/// Lobes that reflect more of the light towards the ray need directions: photons at the end itself.
constexpr float strong_lobe = 0.2f;

/// What an end's surface reflects towards the ray of light that is the same from everywhere.
struct EndReflection {
  glm::vec3 reflectance;
  bool strong_lobe;
};

EndReflection reflection_of(const trace::EyeRecord& ends, std::size_t end) {
  const glm::vec3& albedo = ends.hits[end].diffuse_albedo;
  if (ends.glossy.empty() || ends.glossy[end].lobe.f90 == 0.0f) return {albedo, false};
  const trace::GlossyEyeHit& glossy = ends.glossy[end];
  const scene_io::Reflectance surface{albedo, glossy.lobe.specular, glossy.lobe.f90,
                                      glossy.lobe.roughness};
  const float cosine = std::max(glm::dot(glossy.lobe.normal, glossy.outgoing), 1e-6f);
  PhotileAlbedoFit fit;
  photile_albedo_fit(surface.alpha, &fit);
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&fit, cosine, &f0_weight, &f90_weight);
  const glm::vec3 lobe = f0_weight * surface.f0 + f90_weight * surface.f90;
  return {lobe + diffuse_reflectance(diffuse_part(surface, cosine), surface.alpha),
          trace::largest(lobe) > strong_lobe};
}

/// In single precision: enough to tell directions apart.
glm::vec3 normal_of(const Scene& scene, std::uint32_t sided) {
  const auto [a, b, c] = scene.corners(triangle_of(sided));
  const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  return side_of(sided) == 0 ? normal : -normal;
}

}  // namespace

IndirectLight CellLight::look_up(trace::HemisphereRays rays, const PrimaryHits& points,
                                 std::size_t first) {
  const Stopwatch stopwatch;
  IndirectLight light{.rays = std::move(rays), .estimate = {}, .weight = {}, .own = {}};
  std::vector<CellKey> keys;
  std::vector<std::uint8_t> has_own;
  classify(light, points, first, keys, has_own);
  EndCells::Numbers numbers = cells_.number(keys, has_own);
  light.estimate = std::move(numbers.cell);
  std::vector<std::uint32_t> own;
  for (std::uint32_t end = 0; end < has_own.size(); ++end) {
    if (!has_own[end]) continue;
    light.estimate[end] = IndirectLight::own_estimate | static_cast<std::uint32_t>(own.size());
    own.push_back(end);
  }
  costs_.cell_seconds += stopwatch.seconds();

  const Stopwatch estimate_watch;
  const trace::EyeRecord& ends = light.rays.ends;
  Estimates fresh = estimates_at(ends, numbers.first_key).estimates;
  fresh.radiance.clear();  // towards one of the rays alone
  irradiance_.append(std::move(fresh));
  if (!own.empty()) light.own = estimates_at(ends, own);
  costs_.estimated += numbers.first_key.size() + own.size();
  costs_.ends += ends.hits.size();
  costs_.rays += ends.rays;
  costs_.estimate_seconds += estimate_watch.seconds();
  return light;
}

void CellLight::add_point(const IndirectLight& light, std::size_t point, std::uint32_t batches,
                          std::uint32_t rays_per_batch, BatchSums& sums) const {
  const std::size_t lights = rays_.needs().light_count;
  for (std::size_t end = light.rays.first[point]; end < light.rays.first[point + 1]; ++end) {
    const std::uint32_t batch = light.rays.ends.hits[end].pixel / rays_per_batch % batches;
    const std::uint32_t number = light.estimate[end];
    if (number & IndirectLight::own_estimate) {
      const std::size_t hit = number & ~IndirectLight::own_estimate;
      const EndEstimates& own = light.own;
      for_each_estimate(own.estimates, hit, lights, [&](std::size_t layer, std::size_t i) {
        sums.add(static_cast<std::uint32_t>(layer), batch,
                 light.weight[end] * reflected_radiance(own.hits, hit, own.estimates, i));
      });
    } else {
      for_each_estimate(irradiance_, number, lights, [&](std::size_t layer, std::size_t i) {
        sums.add(static_cast<std::uint32_t>(layer), batch,
                 light.weight[end] * irradiance_.irradiance[i]);
      });
    }
  }
}

/// Finds the cells of ends, which ends have estimates of their own instead, and what estimates
/// weigh at each.
void CellLight::classify(IndirectLight& light, const PrimaryHits& points, std::size_t first,
                         std::vector<CellKey>& keys, std::vector<std::uint8_t>& has_own) const {
  const trace::HemisphereRays& rays = light.rays;
  const std::size_t count = rays.ends.hits.size();
  light.weight.resize(count);
  keys.resize(count);
  has_own.resize(count);
  const std::span<const std::uint32_t> map_of = photons_.map_of();
  tbb::parallel_for(std::size_t{0}, rays.first.size() - 1, [&](std::size_t point) {
    const trace::FlushDenormals flush_denormals;
    const glm::vec3 from = points.position[first + point];
    for (std::size_t end = rays.first[point]; end < rays.first[point + 1]; ++end) {
      const trace::EyeHit& hit = rays.ends.hits[end];
      const EndReflection reflection = reflection_of(rays.ends, end);
      has_own[end] = reflection.strong_lobe;
      light.weight[end] = hit.throughput;
      if (reflection.strong_lobe) continue;
      light.weight[end] *= reflection.reflectance * glm::one_over_pi<float>();
      const std::uint32_t sided = hit.sided_triangle;
      keys[end] =
          cell_of(hit.position, normal_of(rays_.scene(), sided),
                  map_of.empty() ? sided : map_of[sided], side_, glm::distance(from, hit.position));
    }
  });
}

/// In the order of the ends that are chosen.
EndEstimates CellLight::estimates_at(const trace::EyeRecord& ends,
                                     std::span<const std::uint32_t> chosen) {
  trace::EyeRecord record;
  for (const std::uint32_t end : chosen) {
    record.hits.push_back(ends.hits[end]);
    if (!ends.glossy.empty()) record.glossy.push_back(ends.glossy[end]);
  }
  const std::span<const trace::EyeRecord> records(&record, 1);
  const std::vector<trace::HitPlace> places =
      trace::sorted_places(records, impl_of(rays_).bounds, photons_.map_of());
  std::vector<std::uint32_t> order;
  for (const trace::HitPlace& place : places) order.push_back(place.index);
  Estimates in_order = photons_.estimate(trace::hits_at(records, places));
  std::vector<trace::HitPlace> as_chosen;
  for (std::uint32_t i = 0; i < chosen.size(); ++i) as_chosen.push_back({0, i});
  return {trace::hits_at(records, as_chosen),
          estimate::restored(std::move(in_order), order, rays_.needs().light_count)};
}

}  // namespace photile::gathering
