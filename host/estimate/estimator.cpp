#include "photile/estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimate/hit_buffers.hpp"
#include "estimate/specialisation.hpp"
#include "maps/uniform_grid.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

using device::Buffer;
using estimate::HitBuffers;

struct Estimator::Impl {
  const maps::UniformGrid& grid;
  device::Context& context;
  std::uint32_t neighbours;
  float radius;
  device::Defines defines;

  Impl(const PhotonMaps& maps, const EstimateParameters& parameters)
      : grid(maps.grid()),
        context(maps.device().context()),
        neighbours(static_cast<std::uint32_t>(parameters.neighbours)),
        radius(static_cast<float>(parameters.radius == 0 ? maps.parameters().radius
                                                         : parameters.radius)),
        defines(estimate::specialise(context.info(), grid.needs, parameters.neighbours).defines()) {
  }

  /// Hits of one launch so that no buffer, input or output, is larger than the device allows.
  std::size_t batch_size(std::uint64_t output_bytes_per_hit) const {
    constexpr std::uint64_t comfortable = 1u << 20;
    const std::uint64_t bytes = std::max<std::uint64_t>(3 * sizeof(float), output_bytes_per_hit);
    const std::uint64_t limit =
        std::min<std::uint64_t>(context.info().max_allocation_bytes, 0xFFFF'FFFFu);
    return std::clamp<std::uint64_t>(limit / bytes, 1, comfortable);
  }

  /// Calls launch(page, first, count) for the hits of each map page. Hits of maps without photons
  /// lie in no page; their outputs keep what they were filled with.
  template <class Launch>
  void for_each_page(std::span<const std::uint32_t> hit_maps, Launch launch) const {
    for (const maps::MapPage& page : grid.pages) {
      const auto first = std::lower_bound(hit_maps.begin(), hit_maps.end(), page.first_map);
      const auto last = std::lower_bound(first, hit_maps.end(), page.last_map);
      if (first == last) continue;
      launch(page, static_cast<std::uint32_t>(first - hit_maps.begin()),
             static_cast<std::uint32_t>(last - first));
    }
  }

  void launch_estimate(const HitBuffers& hits, const maps::MapPage& page, std::uint32_t first,
                       std::uint32_t count, Buffer<float>& irradiance, Buffer<float>& radiance) {
    const auto launch = [&](const auto&... optional) {
      context.run(context.kernel("estimate/estimate.cl", "estimate", defines), count,
                  maps::work_group_size, count, first, hits.position, hits.map, page.first_map,
                  page.grids, page.cell_start, page.entry_stride, page.entry_position,
                  page.entry_flux, page.entry_photon, optional..., neighbours, radius,
                  grid.needs.light_count, irradiance);
    };
    const auto with_lobes = [&](const auto&... optional) {
      if (grid.needs.glossy) {
        launch(optional..., page.entry_incoming, hits.outgoing, hits.normal, hits.albedo,
               hits.specular, hits.roughness, radiance);
      } else {
        launch(optional...);
      }
    };
    if (grid.needs.light_count > 1) {
      with_lobes(page.entry_light);
    } else {
      with_lobes();
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
  impl_ = std::make_unique<Impl>(maps, parameters);
}

Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

Estimates Estimator::estimate(const PrimaryHits& hits) {
  const std::size_t lights = impl_->grid.needs.light_count;
  const bool glossy = impl_->grid.needs.glossy;
  Estimates result;
  result.irradiance.resize(hits.size() * lights);
  if (glossy) result.radiance.resize(hits.size() * lights);
  const std::size_t batch = impl_->batch_size(3 * sizeof(float) * lights);
  for (std::size_t first = 0; first < hits.size(); first += batch) {
    const std::size_t count = std::min(batch, hits.size() - first);
    const HitBuffers buffers = estimate::upload_hits(impl_->context, hits, first, count, glossy);
    auto irradiance = impl_->context.allocate<float>(3 * count * lights, "irradiance estimates");
    auto radiance =
        impl_->context.allocate<float>(glossy ? 3 * count * lights : 0, "radiance estimates");
    impl_->context.fill(irradiance, 0.0f);
    impl_->context.fill(radiance, 0.0f);
    impl_->for_each_page(
        std::span(hits.sided_triangle).subspan(first, count),
        [&](const maps::MapPage& page, std::uint32_t page_first, std::uint32_t page_count) {
          impl_->launch_estimate(buffers, page, page_first, page_count, irradiance, radiance);
        });
    impl_->context.read(irradiance,
                        std::span(&result.irradiance[first * lights].x, 3 * count * lights));
    if (glossy) {
      impl_->context.read(radiance,
                          std::span(&result.radiance[first * lights].x, 3 * count * lights));
    }
  }
  return result;
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
    impl_->for_each_page(
        std::span(hits.sided_triangle).subspan(first, count),
        [&](const maps::MapPage& page, std::uint32_t page_first, std::uint32_t page_count) {
          impl_->context.run(
              impl_->context.kernel("estimate/nearest.cl", "nearest", impl_->defines), page_count,
              maps::work_group_size, page_count, page_first, buffers.position, buffers.map,
              page.first_map, page.grids, page.cell_start, page.entry_stride, page.entry_position,
              page.entry_photon, impl_->neighbours, radius, photons, squared_radius);
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
