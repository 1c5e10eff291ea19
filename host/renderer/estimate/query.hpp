// What answers queries on one page of photon maps: the kernels of a structure.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "device/launch.hpp"
#include "estimate/estimate_buffers.hpp"
#include "estimate/hit_buffers.hpp"
#include "estimate/surface_buffers.hpp"
#include "maps/map_store.hpp"
#include "photile/density_kernel.hpp"
#include "photile/estimate_tuning.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::estimate {

/// Hits [first, first + count) of a batch, which all lie on maps of one page.
struct PageHits {
  const HitBuffers& hits;
  const maps::MapPage& page;
  std::uint32_t first = 0, count = 0;
};

/// The kernels of one structure for one k and radius. Outputs of hits that lie on no page, or on
/// maps without photons, keep what they were filled with.
class Query {
 public:
  virtual ~Query() = default;

  /// What the kernels are compiled with, and what EstimateBuffers are to be made for.
  virtual const LightSums& sums() const = 0;

  /// `estimates` are those of sums().
  virtual void estimate(const PageHits& hits, EstimateBuffers& estimates) = 0;

  /// k photon indices per hit, in any order. Before: none.
  virtual void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
                       device::Buffer<float>& squared_radius) = 0;
};

/// What kernels are compiled for and given.
struct QueryParameters {
  std::uint32_t neighbours = 1;             ///< k
  std::uint32_t compiled_neighbours = 1;    ///< kernels are compiled for k up to this
  float radius = 0;                         ///< metres; no neighbour is farther
  float least_radius = 0;                   ///< metres; smaller discs count as this
  EstimateTuning tuning;                    ///< for uniform grids only
  const SurfaceBuffers* surface = nullptr;  ///< what areas are clipped to, or null for whole discs
  DensityKernel kernel = DensityKernel::constant;  ///< what photons count
};

std::unique_ptr<Query> make_query(const maps::MapStore& store, const QueryParameters& parameters);
std::unique_ptr<Query> make_grid_query(const maps::MapStore& store,
                                       const QueryParameters& parameters);
std::unique_ptr<Query> make_structure_query(const maps::MapStore& store,
                                            const QueryParameters& parameters);

/// Sets the symbols that kernels/estimate/area.clh and kernels/shared/density_kernel.clh ask for.
inline void set_density_defines(device::Defines& defines, const SurfaceBuffers* surface,
                                DensityKernel kernel) {
  if (surface != nullptr) defines.set("CLIPPED");
  if (kernel == DensityKernel::cone) defines.set("CONE");
  if (kernel == DensityKernel::epanechnikov) defines.set("EPANECHNIKOV");
}

/// Calls launch(page_hits) for the hits of each map page that has any; `hit_maps`: theirs,
/// ascending.
template <class Launch>
void for_each_page(const maps::MapStore& store, const HitBuffers& hits,
                   std::span<const std::uint32_t> hit_maps, Launch launch) {
  const maps::ResidentMaps::Release release_last{store.pages};
  for (std::size_t i = 0; i < store.pages.size(); ++i) {
    const maps::PageExtent& extent = store.pages[i];
    const auto first = std::lower_bound(hit_maps.begin(), hit_maps.end(), extent.first_map);
    const auto last = std::lower_bound(first, hit_maps.end(), extent.last_map);
    if (first == last) continue;
    launch(PageHits{hits, store.pages.use(i), static_cast<std::uint32_t>(first - hit_maps.begin()),
                    static_cast<std::uint32_t>(last - first)});
  }
}

/// Sets the arguments that every kernel takes.
inline void set_page_arguments(device::Launch& launch, const PageHits& hits,
                               const QueryParameters& parameters) {
  const maps::MapPage& page = hits.page;
  launch.set("hit_count", hits.count)
      .set("first_hit", hits.first)
      .set("hit_position", hits.hits.position)
      .set("hit_map", hits.hits.map)
      .set("first_map", page.first_map)
      .set("entry_stride", page.entry_stride)
      .set("entry_position", page.entry_position)
      .set("entry_photon", page.entry_photon)
      .set("k", parameters.neighbours)
      .set("radius", parameters.radius);
}

/// Sets the arguments that a page with mixed maps adds, whose kernels are compiled with NORMALS,
/// and those that clipped areas add.
inline void set_normal_arguments(device::Launch& launch, const maps::MapStore& store,
                                 const PageHits& page_hits, const SurfaceBuffers* surface) {
  const HitBuffers& hits = page_hits.hits;
  const bool mixed = page_hits.page.entry_normal.size() > 0;
  if (mixed) launch.set("entry_normal", page_hits.page.entry_normal);
  if (mixed || surface != nullptr) {
    // The slack of normals_agree, which groups are made with.
    launch.set("hit_face_normal", hits.face_normal)
        .set("least_cosine", static_cast<float>(store.cos_angle - cosine_slack));
  }
  if (surface != nullptr) {
    launch.set("hit_place", hits.place)
        .set("hit_inwards", hits.inwards)
        .set("surface_nodes", surface->nodes)
        .set("surface_leaves", surface->leaves);
  }
}

/// Sets those of kernels/estimate/arguments.clh and of the disc.
inline void set_estimate_arguments(device::Launch& launch, const maps::MapStore& store,
                                   const PageHits& page_hits, const QueryParameters& parameters,
                                   const EstimateBuffers& estimates) {
  const SceneNeeds& needs = store.needs;
  const auto& [hits, page, first, count] = page_hits;
  set_page_arguments(launch, page_hits, parameters);
  set_normal_arguments(launch, store, page_hits, parameters.surface);
  launch.set("entry_flux", page.entry_flux)
      .set("least_radius", parameters.least_radius)
      .set("irradiance", estimates.irradiance);
  if (needs.light_count > 1) launch.set("entry_light", page.entry_light);
  if (needs.glossy) {
    launch.set("entry_incoming", page.entry_incoming)
        .set("hit_outgoing", hits.outgoing)
        .set("hit_normal", hits.normal)
        .set("hit_diffuse", hits.diffuse)
        .set("hit_f0", hits.f0)
        .set("hit_shape", hits.shape)
        .set("radiance", estimates.radiance);
  }
  if (needs.normal_maps) launch.set("hit_bump", hits.bump);
  if (needs.many_lights()) {
    launch.set("slot_light", estimates.slot_light).set("slots_taken", estimates.slots_taken);
  }
}

}  // namespace photile::estimate
