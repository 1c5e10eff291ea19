#include "maps/build_maps.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "maps/build_steps.hpp"
#include "maps/candidate_maps.hpp"
#include "maps/map_page.hpp"
#include "maps/map_shapes.hpp"
#include "maps/photon_pages.hpp"
#include "scene/scene_queries.hpp"

namespace photile::maps {
namespace {

using device::Context;

/// Lies over store.normals where the device shares memory.
device::Buffer<float> upload_normals(Context& context, const MapStore& store) {
  const float* const first = store.normals.empty() ? nullptr : &store.normals.front().x;
  return context.share(std::span(first, 3 * store.normals.size()), "normals of triangles");
}

}  // namespace

float reach_of(const Scene& scene, double radius) {
  return static_cast<float>(radius * (1.0 + 1e-5) + 8.0 * std::numeric_limits<float>::epsilon() *
                                                        scene::largest_coordinate(scene));
}

namespace {

/// An array of a photon page takes at most a 32nd of the memory, so that the page takes about an
/// eighth.
std::unique_ptr<PhotonPages> photon_pages(const Build& build, const CandidateMaps& candidates,
                                          const Photons& photons, Progress& progress) {
  Context& context = build.context;
  return std::make_unique<PhotonPages>(
      context,
      [&](std::uint64_t max_bytes) { return plan_photon_pages(photons, candidates, max_bytes); },
      [&](PhotonRange range) {
        progress.throw_if_cancelled();
        PhotonPage page = upload_photon_page(context, photons, candidates, range);
        find_insertions(build, page);
        return page;
      },
      std::min(context.largest_buffer(), context.memory_limit() / 32));
}

/// All that does not follow from the photons' triangles.
void give_back_records(Photons& photons) {
  // Nothing is assigned: that would keep the memory.
  std::vector<glm::vec3>().swap(photons.position);
  std::vector<glm::vec3>().swap(photons.flux);
  std::vector<glm::vec3>().swap(photons.incoming);
  std::vector<std::uint16_t>().swap(photons.light);
}

/// A page of maps takes at most half of the memory: beside it lie a page of photons and what the
/// build needs, later a batch of hits and its estimates.
PageLimits page_limits(const Context& context, const MapStore& store, bool normals) {
  const std::uint64_t record = bytes_per_record(store.needs) + (normals ? 3 * sizeof(float) : 0);
  // Two cells for what photons_per_cell asks of one: grids reach beyond the photons.
  const double cells = 2.0 / store.parameters.photons_per_cell;
  const auto cell_bytes = static_cast<std::uint64_t>(std::ceil(sizeof(std::uint32_t) * cells));
  return {.largest_buffer = context.largest_buffer(),
          .page_bytes = context.memory_limit() / 2,
          .bytes_per_record = record + cell_bytes,
          .bytes_per_map = sizeof(PhotileGrid) + sizeof(std::uint32_t)};
}

std::string surface_name(std::uint32_t pair, const Patches& patches) {
  return patches.empty()
             ? fmt::format("triangle {}", pair)
             : fmt::format("triangle {} and its patch", triangle_of(patches.of(pair).front()));
}

/// MapCounts on the host.
struct CountedMaps {
  std::vector<std::uint32_t> photons;
  std::vector<std::uint32_t>
      normal_filtered;  ///< 1 where queries filter by normal; empty without patches

  bool any_normal_filtered(const MapRange& range) const {
    if (normal_filtered.empty()) return false;
    const auto maps = std::span(normal_filtered).subspan(range.first, range.last - range.first);
    return std::find(maps.begin(), maps.end(), 1u) != maps.end();
  }
};

///   release   as RecordCopying
MapPage build_page(const Build& build, const CountedMaps& counted, const MapRange& range,
                   const PhotonRelease* release) {
  const MapStore& store = build.store;
  MapPage page;
  page.first_map = range.first;
  page.last_map = range.last;
  lay_out_grids(build, page);
  fill_cells(build, page);
  copy_records(build.kernels, store.needs, *build.photon_pages,
               {.normals = counted.any_normal_filtered(range) ? &build.normals : nullptr,
                .release = release,
                .memory = memory_pages(store)},
               page);
  build.context.finish();
  return page;
}

/// `counts`: photons per map.
void set_map_sizes(std::vector<std::uint32_t> counts, PhotonMapStatistics& statistics) {
  std::erase(counts, 0u);
  std::sort(counts.begin(), counts.end());
  statistics.maps = counts.size();
  statistics.largest_map = counts.empty() ? 0 : counts.back();
  statistics.map_sizes = std::move(counts);
}

/// Builds the pages of `queue` into the store.
///   release   what releases the photons, for the last page; null: they stay
void build_pages(MapStore& store, const Build& build, const CountedMaps& counted, PageQueue& queue,
                 const PhotonRelease* release, Progress& progress) {
  while (const auto range = queue.next()) {
    progress.throw_if_cancelled();
    try {
      add_page(store, build_page(build, counted, *range, queue.empty() ? release : nullptr));
      progress.advance(range->records);
    } catch (const DeviceMemoryError&) {
      if (build.photon_pages->released()) throw;
      // The larger one of what lies on the device together, if it can be made smaller.
      const bool photons_first = build.photon_pages->page_bytes() >= queue.bytes(*range);
      if (photons_first && build.photon_pages->halve()) {
        queue.put_back(*range);
      } else if (!queue.cut(*range)) {
        if (!build.photon_pages->halve()) throw;
        queue.put_back(*range);
      }
    }
  }
}

}  // namespace

void add_page(MapStore& store, MapPage page) {
  PhotonMapStatistics& statistics = store.statistics;
  statistics.references += page.record_count;
  statistics.cells += page.cell_count;
  statistics.device_bytes += page.device_bytes();
  ++statistics.pages;
  store.pages.add(std::move(page));
}

std::vector<glm::vec3> face_normals(const Scene& scene) {
  std::vector<glm::vec3> normals(2 * scene.triangle_count());
  tbb::parallel_for(std::size_t{0}, scene.triangle_count(), [&](std::size_t triangle) {
    const std::uint32_t front = oriented(static_cast<std::uint32_t>(triangle), 0);
    normals[front] = glm::vec3(face_normal(scene, front));
    normals[front + 1] = -normals[front];
  });
  return normals;
}

void build_maps_of_groups(MapStore& store, const Scene& scene, const Photons& photons,
                          Photons* consumed, const NeighbourGroups& groups,
                          std::span<const std::uint8_t> requested, Progress& progress) {
  const Patches& patches = groups.patches;
  MapPlan plan;
  plan.reach = reach_of(scene, store.parameters.radius);
  plan.normals = !patches.empty();
  if (plan.normals) store.normals = face_normals(scene);
  plan.candidates = find_candidate_maps(scene, photons, groups, plan.reach, requested);
  MapNumbers numbers = number_maps(plan.candidates, patches, 2 * scene.triangle_count());
  store.map_of = std::move(numbers.map_of);
  plan.surfaces = map_shapes(scene, patches, numbers.pairs, glm::radians(groups.angle_degrees));
  plan.density_ratio = of_numbered(numbers, photon_density_ratio(scene, photons, patches));
  plan.name_of = [&](std::uint32_t pair) { return surface_name(numbers.pairs[pair], patches); };
  build_maps(store, photons, consumed, std::move(plan), progress);
}

void build_maps(MapStore& store, const Photons& photons, Photons* consumed, MapPlan plan,
                Progress& progress) {
  Context& context = device::context_of(*store.device);
  Build build{.context = context,
              .store = store,
              .kernels = build_kernels(store, plan.normals),
              .patches = plan.normals,
              .squared_reach = plan.reach * plan.reach,
              .radius = static_cast<float>(store.parameters.radius)};
  build.corners = context.upload(std::span<const float>(plan.surfaces.corners), "triangle corners");
  build.shapes =
      context.upload(std::span<const PhotileMapShape>(plan.surfaces.shapes), "map shapes");
  build.density_ratio =
      context.upload(std::span<const float>(plan.density_ratio), "density ratios");
  build.map_of = context.share(std::span(std::as_const(store.map_of)), "maps of triangles");
  build.normals = upload_normals(context, store);
  build.photon_pages = photon_pages(build, plan.candidates, photons, progress);
  plan.surfaces = {};
  count_photons(build, plan.density_ratio.size());
  const CountedMaps counted{read_all(context, build.counts.photons),
                            read_all(context, build.counts.normal_filtered)};

  PhotonMapStatistics& statistics = store.statistics;
  statistics.normal_filtered_maps = static_cast<std::uint64_t>(
      std::count(counted.normal_filtered.begin(), counted.normal_filtered.end(), 1u));
  PageQueue queue(counted.photons, page_limits(context, store, statistics.normal_filtered_maps > 0),
                  [&](std::uint32_t map) { return plan.name_of(map / 2); });
  const PhotonRelease release{[&] { plan.candidates = CandidateMaps(); },
                              [&] { give_back_records(*consumed); }};
  build_pages(store, build, counted, queue, consumed ? &release : nullptr, progress);
  if (statistics.normal_filtered_maps == 0) store.normals.clear();
  set_map_sizes(counted.photons, statistics);
}

}  // namespace photile::maps
