#include "photile/estimator.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "common/ascii_text.hpp"
#include "common/touched_memory.hpp"
#include "common/value_range.hpp"
#include "estimate/estimate_buffers.hpp"
#include "estimate/hit_buffers.hpp"
#include "estimate/query.hpp"
#include "estimate/specialisation.hpp"
#include "geometry/radius_range.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"

namespace photile {

using estimate::HitBatches;
using estimate::HitBatchNeeds;
using estimate::HitBuffers;

namespace {

/// Photons that coincide make discs without an area; those are taken for discs of this radius, over
/// that of the search or, where it is less, the size of the scene.
constexpr double least_disc_over_radius = 1e-5;

}  // namespace

struct Estimator::Impl {
  const maps::MapStore& store;
  device::Context& context;
  std::uint32_t neighbours;
  float radius;
  HitBatches batches;
  std::shared_ptr<const SurfaceIndex> surface;  ///< where areas are clipped
  std::optional<estimate::SurfaceBuffers> surface_buffers;
  std::unique_ptr<estimate::Query> query;

  Impl(const PhotonMaps& photon_maps, const Scene& scene, const EstimateParameters& parameters)
      : store(maps::store_of(photon_maps)),
        context(device::context_of(photon_maps.device())),
        neighbours(static_cast<std::uint32_t>(parameters.neighbours)),
        radius(static_cast<float>(parameters.radius == 0 ? photon_maps.parameters().radius
                                                         : parameters.radius)),
        batches(context) {
    if (parameters.area == AreaMode::clipped && !store.naive) {
      surface = parameters.surface != nullptr
                    ? parameters.surface
                    : std::make_shared<const SurfaceIndex>(index_surface(
                          scene, store.landed, store.parameters.radius, store.angle_degrees));
      surface_buffers.emplace(store, scene, *surface);
    }
    query = estimate::make_query(
        store, {.neighbours = neighbours,
                .compiled_neighbours = std::max(
                    neighbours, static_cast<std::uint32_t>(parameters.compiled_neighbours)),
                .radius = radius,
                .least_radius = static_cast<float>(least_disc_over_radius *
                                                   std::min<double>(radius, scene_diagonal(scene))),
                .tuning = parameters.tuning.value_or(shipped_tuning(photon_maps.device().info())),
                .surface = clipped_to(),
                .kernel = kernel_used(parameters.kernel, parameters.neighbours)});
  }

  /// What areas are clipped to, or null.
  const estimate::SurfaceBuffers* clipped_to() const {
    return surface_buffers ? &*surface_buffers : nullptr;
  }

  HitBatchNeeds needs(std::uint64_t largest_output, std::uint64_t outputs) const {
    return {
        .largest_bytes_per_hit = std::max<std::uint64_t>(3 * sizeof(float), largest_output),
        .bytes_per_hit =
            estimate::hit_bytes(store.needs, !store.normals.empty(), surface != nullptr) + outputs};
  }

  /// The estimates of hits [first, first + count) become those of hits from `offset` on in
  /// `result`.
  void estimate(const PrimaryHits& hits, std::size_t first, std::size_t count, std::size_t offset,
                LightTable& result) {
    const std::vector<std::uint32_t> hit_maps = store.maps_of(hits, first, count);
    const HitBuffers buffers = estimate::upload_hits(context, hits, first, hit_maps, store.normals,
                                                     clipped_to(), store.needs);
    estimate::EstimateBuffers estimates(context, query->sums(), result, offset,
                                        static_cast<std::uint32_t>(count));
    estimate::for_each_page(store, buffers, hit_maps, [&](const estimate::PageHits& page_hits) {
      query->estimate(page_hits, estimates);
    });
    estimates.read();
  }

  /// The neighbours of hits [first, first + count).
  void nearest(const PrimaryHits& hits, std::size_t first, std::size_t count, ListOrder order,
               NeighbourLists& result) {
    const std::size_t k = neighbours;
    const std::vector<std::uint32_t> hit_maps = store.maps_of(hits, first, count);
    const HitBuffers buffers =
        estimate::upload_hits(context, hits, first, hit_maps, store.normals, nullptr, {});
    auto photons = context.allocate<std::uint32_t>(count * k, "neighbour lists");
    auto squared_radius = context.allocate<float>(count, "neighbour radii");
    context.fill(photons, none);
    context.fill(squared_radius, radius * radius);
    estimate::for_each_page(store, buffers, hit_maps, [&](const estimate::PageHits& page_hits) {
      query->nearest(page_hits, photons, squared_radius);
    });
    context.read(photons, std::span(result.photons).subspan(first * k, count * k));
    context.read(squared_radius, std::span(result.squared_radius).subspan(first, count));
    if (order == ListOrder::any) return;
    tbb::parallel_for(first, first + count, [&](std::size_t hit) {
      std::sort(result.photons.begin() + static_cast<std::ptrdiff_t>(hit * k),
                result.photons.begin() + static_cast<std::ptrdiff_t>((hit + 1) * k));
    });
  }
};

std::string_view name_of(AreaMode area) { return name_in({"disc", "clipped"}, area); }

Estimator::Estimator(const PhotonMaps& maps, const Scene& scene,
                     const EstimateParameters& parameters) {
  check_setting("neighbours", setting_value(parameters.neighbours));
  if (!(parameters.radius >= 0) || parameters.radius > maps.parameters().radius) {
    throw UsageError(fmt::format("estimate radius {} m: must be between 0 and the maps' {} m",
                                 parameters.radius, maps.parameters().radius));
  }
  if (parameters.tuning) {
    const std::string problem = estimate::tuning_problem(*parameters.tuning);
    if (!problem.empty()) throw UsageError("tuning of the estimate: " + problem);
  }
  impl_ = std::make_unique<Impl>(maps, scene, parameters);
}

Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

LightTable Estimator::estimate(const PrimaryHits& hits) { return estimate(hits, 0, hits.size()); }

LightTable Estimator::estimate(const PrimaryHits& hits, std::size_t begin, std::size_t hit_count) {
  const auto [largest, together] = impl_->query->sums().bytes_per_hit();
  LightTable result(impl_->store.needs);
  if (!result.sparse()) {
    const std::size_t estimates = hit_count * impl_->store.needs.light_count;
    result.irradiance = touched_vector<glm::vec3>(estimates);
    if (impl_->store.needs.glossy) result.radiance = touched_vector<glm::vec3>(estimates);
  }
  // Slots for many lights stay mostly empty: more of them than this at a time gain nothing.
  constexpr std::uint64_t comfortable_bytes = 128u << 20;
  constexpr std::size_t least_hits = 4096;
  const std::size_t most =
      impl_->store.needs.many_lights()
          ? std::max<std::size_t>(comfortable_bytes / together / least_hits, 1) * least_hits
          : hit_count;
  for (std::size_t part = 0; part < hit_count; part += most) {
    impl_->batches.run(std::min(most, hit_count - part), impl_->needs(largest, together),
                       [&](std::size_t first, std::size_t count) {
                         impl_->estimate(hits, begin + part + first, count, part + first, result);
                       });
  }
  return result;
}

NeighbourLists Estimator::nearest(const PrimaryHits& hits, ListOrder list_order) {
  const std::size_t k = impl_->neighbours;
  const std::uint64_t output = sizeof(std::uint32_t) * k;
  NeighbourLists result;
  result.k = static_cast<int>(k);
  result.photons.resize(hits.size() * k);
  result.squared_radius.resize(hits.size());
  impl_->batches.run(hits.size(), impl_->needs(output, output + sizeof(float)),
                     [&](std::size_t first, std::size_t count) {
                       impl_->nearest(hits, first, count, list_order, result);
                     });
  return result;
}

std::string_view name_of(DensityKernel kernel) { return name_in({"constant", "cone"}, kernel); }

}  // namespace photile
