#include "photile/estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimate/hit_batches.hpp"
#include "estimate/hit_buffers.hpp"
#include "estimate/query.hpp"
#include "estimate/tuning.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

using estimate::HitBatches;
using estimate::HitBatchNeeds;
using estimate::HitBuffers;

struct Estimator::Impl {
  const maps::MapStore& store;
  device::Context& context;
  std::uint32_t neighbours;
  float radius;
  HitBatches batches;
  std::unique_ptr<estimate::Query> query;

  Impl(const PhotonMaps& photon_maps, const EstimateParameters& parameters)
      : store(photon_maps.store()),
        context(photon_maps.device().context()),
        neighbours(static_cast<std::uint32_t>(parameters.neighbours)),
        radius(static_cast<float>(parameters.radius == 0 ? photon_maps.parameters().radius
                                                         : parameters.radius)),
        batches(context),
        query(estimate::make_query(
            store, neighbours, radius,
            parameters.tuning.value_or(shipped_tuning(photon_maps.device().info())))) {}

  HitBatchNeeds needs(std::uint64_t largest_output, std::uint64_t outputs) const {
    return {.largest_bytes_per_hit = std::max<std::uint64_t>(3 * sizeof(float), largest_output),
            .bytes_per_hit = estimate::hit_bytes(store.needs.glossy) + outputs};
  }

  /// The estimates of hits [first, first + count).
  void estimate(const PrimaryHits& hits, std::size_t first, std::size_t count, Estimates& result) {
    const std::size_t lights = store.needs.light_count;
    const bool glossy = store.needs.glossy;
    const HitBuffers buffers = estimate::upload_hits(context, hits, first, count, glossy);
    auto irradiance = context.allocate<float>(3 * count * lights, "irradiance estimates");
    auto radiance = context.allocate<float>(glossy ? 3 * count * lights : 0, "radiance estimates");
    context.fill(irradiance, 0.0f);
    context.fill(radiance, 0.0f);
    estimate::for_each_page(store, buffers, std::span(hits.sided_triangle).subspan(first, count),
                            [&](const estimate::PageHits& page_hits) {
                              query->estimate(page_hits, irradiance, radiance);
                            });
    context.read(irradiance, std::span(&result.irradiance[first * lights].x, 3 * count * lights));
    if (glossy) {
      context.read(radiance, std::span(&result.radiance[first * lights].x, 3 * count * lights));
    }
  }

  /// The neighbours of hits [first, first + count).
  void nearest(const PrimaryHits& hits, std::size_t first, std::size_t count,
               NeighbourLists& result) {
    const std::size_t k = neighbours;
    const HitBuffers buffers = estimate::upload_hits(context, hits, first, count, false);
    auto photons = context.allocate<std::uint32_t>(count * k, "neighbour lists");
    auto squared_radius = context.allocate<float>(count, "neighbour radii");
    context.fill(photons, none);
    context.fill(squared_radius, radius * radius);
    estimate::for_each_page(store, buffers, std::span(hits.sided_triangle).subspan(first, count),
                            [&](const estimate::PageHits& page_hits) {
                              query->nearest(page_hits, photons, squared_radius);
                            });
    context.read(photons, std::span(result.photons).subspan(first * k, count * k));
    context.read(squared_radius, std::span(result.squared_radius).subspan(first, count));
    for (std::size_t hit = first; hit < first + count; ++hit) {
      std::sort(result.photons.begin() + static_cast<std::ptrdiff_t>(hit * k),
                result.photons.begin() + static_cast<std::ptrdiff_t>((hit + 1) * k));
    }
  }
};

Estimator::Estimator(const PhotonMaps& maps, const Scene&, const EstimateParameters& parameters) {
  if (parameters.neighbours < 1 || parameters.neighbours > limits::max_neighbours) {
    throw UsageError(fmt::format("{} neighbours: must be between 1 and {}", parameters.neighbours,
                                 limits::max_neighbours));
  }
  if (!(parameters.radius >= 0) || parameters.radius > maps.parameters().radius) {
    throw UsageError(fmt::format("estimate radius {} m: must be between 0 and the maps' {} m",
                                 parameters.radius, maps.parameters().radius));
  }
  if (parameters.tuning) {
    const std::string problem = estimate::tuning_problem(*parameters.tuning);
    if (!problem.empty()) throw UsageError("tuning of the estimate: " + problem);
  }
  impl_ = std::make_unique<Impl>(maps, parameters);
}

Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

Estimates Estimator::zeros(std::size_t hits) const {
  const std::size_t count = hits * impl_->store.needs.light_count;
  Estimates result;
  result.irradiance.resize(count);
  if (impl_->store.needs.glossy) result.radiance.resize(count);
  return result;
}

Estimates Estimator::estimate(const PrimaryHits& hits) {
  Estimates result = zeros(hits.size());
  estimate(hits, 0, hits.size(), result);
  return result;
}

void Estimator::estimate(const PrimaryHits& hits, std::size_t begin, std::size_t hit_count,
                         Estimates& result) {
  const std::size_t lights = impl_->store.needs.light_count;
  const std::uint64_t output = 3 * sizeof(float) * lights;
  const bool glossy = impl_->store.needs.glossy;
  impl_->batches.run(hit_count, impl_->needs(output, glossy ? 2 * output : output),
                     [&](std::size_t first, std::size_t count) {
                       impl_->estimate(hits, begin + first, count, result);
                     });
}

std::size_t Estimator::cut_before(const PrimaryHits& hits, std::size_t hit) const {
  if (hit >= hits.size()) return hits.size();
  // Work-items take hits from the first one of a page on, at most a vector of them together.
  constexpr std::size_t together =
      *std::max_element(estimate::vector_widths.begin(), estimate::vector_widths.end());
  std::size_t page_begin = 0;
  for (std::size_t i = 0; i < impl_->store.pages.size(); ++i) {
    const maps::PageExtent& page = impl_->store.pages[i];
    if (page.first_map > hits.sided_triangle[hit]) break;
    page_begin = static_cast<std::size_t>(
        std::lower_bound(hits.sided_triangle.begin(), hits.sided_triangle.end(), page.first_map) -
        hits.sided_triangle.begin());
  }
  return page_begin + (hit - page_begin) / together * together;
}

NeighbourLists Estimator::nearest(const PrimaryHits& hits) {
  const std::size_t k = impl_->neighbours;
  const std::uint64_t output = sizeof(std::uint32_t) * k;
  NeighbourLists result;
  result.k = static_cast<int>(k);
  result.photons.resize(hits.size() * k);
  result.squared_radius.resize(hits.size());
  impl_->batches.run(
      hits.size(), impl_->needs(output, output + sizeof(float)),
      [&](std::size_t first, std::size_t count) { impl_->nearest(hits, first, count, result); });
  return result;
}

}  // namespace photile
