#include "photile/estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimate/hit_buffers.hpp"
#include "estimate/query.hpp"
#include "estimate/tuning.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

using estimate::HitBuffers;

struct Estimator::Impl {
  const maps::MapStore& store;
  device::Context& context;
  std::uint32_t neighbours;
  float radius;
  std::unique_ptr<estimate::Query> query;

  Impl(const PhotonMaps& photon_maps, const EstimateParameters& parameters)
      : store(photon_maps.store()),
        context(photon_maps.device().context()),
        neighbours(static_cast<std::uint32_t>(parameters.neighbours)),
        radius(static_cast<float>(parameters.radius == 0 ? photon_maps.parameters().radius
                                                         : parameters.radius)),
        query(estimate::make_query(
            store, neighbours, radius,
            parameters.tuning.value_or(shipped_tuning(photon_maps.device().info())))) {}

  /// Hits of one batch so that no buffer, input or output, is larger than the device allows.
  std::size_t batch_size(std::uint64_t output_bytes_per_hit) const {
    constexpr std::uint64_t comfortable = 1u << 20;
    const std::uint64_t bytes = std::max<std::uint64_t>(3 * sizeof(float), output_bytes_per_hit);
    const std::uint64_t limit =
        std::min<std::uint64_t>(context.info().max_allocation_bytes, 0xFFFF'FFFFu);
    return std::clamp<std::uint64_t>(limit / bytes, 1, comfortable);
  }

  /// Calls launch(page_hits) for the hits of each map page.
  template <class Launch>
  void for_each_page(const HitBuffers& hits, std::span<const std::uint32_t> hit_maps,
                     Launch launch) const {
    for (const maps::MapPage& page : store.pages) {
      const auto first = std::lower_bound(hit_maps.begin(), hit_maps.end(), page.first_map);
      const auto last = std::lower_bound(first, hit_maps.end(), page.last_map);
      if (first == last) continue;
      launch(estimate::PageHits{hits, page, static_cast<std::uint32_t>(first - hit_maps.begin()),
                                static_cast<std::uint32_t>(last - first)});
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
  const bool glossy = impl_->store.needs.glossy;
  const std::size_t batch = impl_->batch_size(3 * sizeof(float) * lights);
  const std::size_t end = begin + hit_count;
  for (std::size_t first = begin; first < end; first += batch) {
    const std::size_t count = std::min(batch, end - first);
    const HitBuffers buffers = estimate::upload_hits(impl_->context, hits, first, count, glossy);
    auto irradiance = impl_->context.allocate<float>(3 * count * lights, "irradiance estimates");
    auto radiance =
        impl_->context.allocate<float>(glossy ? 3 * count * lights : 0, "radiance estimates");
    impl_->context.fill(irradiance, 0.0f);
    impl_->context.fill(radiance, 0.0f);
    impl_->for_each_page(buffers, std::span(hits.sided_triangle).subspan(first, count),
                         [&](const estimate::PageHits& page_hits) {
                           impl_->query->estimate(page_hits, irradiance, radiance);
                         });
    impl_->context.read(irradiance,
                        std::span(&result.irradiance[first * lights].x, 3 * count * lights));
    if (glossy) {
      impl_->context.read(radiance,
                          std::span(&result.radiance[first * lights].x, 3 * count * lights));
    }
  }
}

std::size_t Estimator::cut_before(const PrimaryHits& hits, std::size_t hit) const {
  if (hit >= hits.size()) return hits.size();
  // Work-items take hits from the first one of a page on, at most a vector of them together.
  constexpr std::size_t together =
      *std::max_element(estimate::vector_widths.begin(), estimate::vector_widths.end());
  std::size_t page_begin = 0;
  for (const maps::MapPage& page : impl_->store.pages) {
    if (page.first_map > hits.sided_triangle[hit]) break;
    page_begin = static_cast<std::size_t>(
        std::lower_bound(hits.sided_triangle.begin(), hits.sided_triangle.end(), page.first_map) -
        hits.sided_triangle.begin());
  }
  return page_begin + (hit - page_begin) / together * together;
}

NeighbourLists Estimator::nearest(const PrimaryHits& hits) {
  const std::size_t k = impl_->neighbours;
  NeighbourLists result;
  result.k = static_cast<int>(k);
  result.photons.resize(hits.size() * k);
  result.squared_radius.resize(hits.size());
  const std::size_t batch = impl_->batch_size(sizeof(std::uint32_t) * k);
  const float radius = impl_->radius;
  for (std::size_t first = 0; first < hits.size(); first += batch) {
    const std::size_t count = std::min(batch, hits.size() - first);
    const HitBuffers buffers = estimate::upload_hits(impl_->context, hits, first, count, false);
    auto photons = impl_->context.allocate<std::uint32_t>(count * k, "neighbour lists");
    auto squared_radius = impl_->context.allocate<float>(count, "neighbour radii");
    impl_->context.fill(photons, none);
    impl_->context.fill(squared_radius, radius * radius);
    impl_->for_each_page(buffers, std::span(hits.sided_triangle).subspan(first, count),
                         [&](const estimate::PageHits& page_hits) {
                           impl_->query->nearest(page_hits, photons, squared_radius);
                         });
    impl_->context.read(photons, std::span(result.photons).subspan(first * k, count * k));
    impl_->context.read(squared_radius, std::span(result.squared_radius).subspan(first, count));
    for (std::size_t hit = first; hit < first + count; ++hit) {
      std::sort(result.photons.begin() + static_cast<std::ptrdiff_t>(hit * k),
                result.photons.begin() + static_cast<std::ptrdiff_t>((hit + 1) * k));
    }
  }
  return result;
}

}  // namespace photile
