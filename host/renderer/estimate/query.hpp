// Queries of one page of photon maps, by kernels on the device.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "device/launch.hpp"
#include "estimate/estimate_buffers.hpp"
#include "estimate/hit_buffers.hpp"
#include "maps/map_store.hpp"
#include "photile/device/constants.h"
#include "photile/device/query.h"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::estimate {

/// The hits of a batch and a page of maps, on which some of them lie.
struct PageHits {
  const HitBuffers& hits;
  const maps::MapPage& page;
};

/// The kernels for one k and radius. Outputs of hits that lie on no page, or on
/// maps without photons, keep what they were filled with.
class Query {
 public:
  virtual ~Query() = default;

  /// The layout for which the kernels are compiled and EstimateBuffers are made.
  virtual const LightSums& sums() const = 0;

  /// `estimates` are those of sums().
  virtual void estimate(const PageHits& hits, EstimateBuffers& estimates) = 0;

  /// k photon indices per hit, in any order. Before: `none`.
  virtual void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
                       device::Buffer<float>& squared_radius) = 0;
};

/// What kernels are compiled for, and their arguments.
struct QueryParameters {
  std::uint32_t neighbours = 1;             ///< k
  std::uint32_t compiled_neighbours = 1;    ///< kernels are compiled for k up to this
  float radius = 0;                         ///< metres; no neighbour is farther
  float least_radius = 0;                   ///< metres; smaller discs count as this
  EstimateTuning tuning;                    ///< of the grids' kernels
  const SurfaceBuffers* surface = nullptr;  ///< what areas are clipped to, or null for whole discs
  DensityKernel kernel = DensityKernel::constant;  ///< the weight of photons
};

/// The query of the store's grids, or that of MapStore::make_query.
std::unique_ptr<Query> make_query(const maps::MapStore& store, const QueryParameters& parameters);

/// Sets CLIPPED and DENSITY_KERNEL.
inline void set_density_defines(device::Defines& defines, bool clipped, DensityKernel kernel) {
  if (clipped) defines.set("CLIPPED");
  static_assert(static_cast<int>(DensityKernel::constant) == PHOTILE_CONSTANT_KERNEL &&
                static_cast<int>(DensityKernel::cone) == PHOTILE_CONE_KERNEL);
  if (kernel != DensityKernel::constant) {
    defines.set("DENSITY_KERNEL", static_cast<long long>(kernel));
  }
}

/// Calls launch(page_hits) for each map page that hits lie on; `hit_maps`: their maps.
template <class Launch>
void for_each_page(const maps::MapStore& store, const HitBuffers& hits,
                   std::span<const std::uint32_t> hit_maps, Launch launch) {
  const maps::ResidentMaps::Release release_last{store.pages};
  for (std::size_t i = 0; i < store.pages.size(); ++i) {
    const maps::PageExtent& extent = store.pages[i];
    const auto is_here = [&](std::uint32_t map) {
      return map >= extent.first_map && map < extent.last_map;
    };
    if (std::any_of(hit_maps.begin(), hit_maps.end(), is_here)) {
      launch(PageHits{hits, store.pages.use(i)});
    }
  }
}

/// The arguments of kernels about the hits of a page.
inline PhotileQuery query_of(const maps::MapStore& store, const PageHits& hits,
                             const QueryParameters& parameters) {
  return {.first_hit = 0,
          .hit_count = hits.hits.count,
          .first_map = hits.page.first_map,
          .map_count = hits.page.last_map - hits.page.first_map,
          .record_stride = hits.page.record_stride,
          .k = parameters.neighbours,
          .radius = parameters.radius,
          .least_radius = parameters.least_radius,
          // The slack of normals_agree, which groups are made with.
          .least_cosine = static_cast<float>(store.cos_angle - cosine_slack)};
}

/// Sets the arguments that every kernel takes, except the query itself.
inline void set_page_arguments(device::Launch& launch, const PageHits& hits) {
  launch.set("hits", hits.hits.hits)
      .set("order", hits.hits.order)
      .set("hit_surfaces", hits.hits.surfaces)
      .set("record_photon", hits.page.record_photon)
      .set("record_position", hits.page.record_position)
      .set("record_normal", hits.page.record_normal);
}

/// Sets those of every kernel of the estimate. What the scene does not need is empty.
inline void set_estimate_arguments(device::Launch& launch, const PageHits& hits,
                                   const QueryParameters& parameters,
                                   const EstimateBuffers& estimates) {
  set_page_arguments(launch, hits);
  launch.set("hit_lobes", hits.hits.lobes)
      .set("record_flux", hits.page.record_flux)
      .set("record_light", hits.page.record_light)
      .set("record_incoming", hits.page.record_incoming)
      .set("irradiance", estimates.irradiance)
      .set("radiance", estimates.radiance)
      .set("slot_light", estimates.slot_light)
      .set("slots_taken", estimates.slots_taken);
  const device::Buffer<PhotileSurfaceNode> no_nodes;
  const device::Buffer<PhotileSurfaceLeaf> no_leaves;
  const SurfaceBuffers* const surface = parameters.surface;
  launch.set("surface_nodes", surface != nullptr ? surface->nodes : no_nodes)
      .set("surface_leaves", surface != nullptr ? surface->leaves : no_leaves);
}

}  // namespace photile::estimate
