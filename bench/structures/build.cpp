// From the library's maps to the same maps in another structure.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "maps/build_maps.hpp"
#include "maps/build_steps.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photile/statistics.hpp"
#include "structures/structure.hpp"
#include "structures/structure_query.hpp"

namespace photile::structures {
namespace {

using maps::MapPage;
using maps::MapStore;

/// Puts pages of photons into a structure and the pages into a store.
class Builder {
 public:
  /// References are kept. `store` has all but pages and their statistics.
  Builder(const Structure& structure, MapStore& store, const Photons& photons)
      : structure_(structure),
        store_(store),
        photons_(photons),
        context_(device::context_of(*store.device)),
        normals_(context_.share(
            std::span<const float>(store.normals.empty() ? nullptr : &store.normals.front().x,
                                   3 * store.normals.size()),
            "normals of triangles")) {}

  /// A page of what `lists` hold. `normals`: whether its records keep theirs.
  void add(std::uint32_t first_map, std::uint32_t last_map, const PhotonLists& lists,
           bool normals) {
    MapPage page;
    page.first_map = first_map;
    page.last_map = last_map;
    page.record_count = static_cast<std::uint32_t>(lists.members.size());
    page.grids =
        context_.upload(std::span<const PhotileGrid>(lists.planes), "planes of photon maps");
    Index index = structure_.build(lists);
    page.record_photon = std::move(index.record_photon);
    maps::PhotonPages all_photons(
        context_,
        [&](std::uint64_t) {
          const auto count = static_cast<std::uint32_t>(photons_.size());
          return std::vector<maps::PhotonRange>{{0, count}};
        },
        [&](maps::PhotonRange range) {
          return maps::upload_photon_records(context_, photons_, range);
        },
        context_.largest_buffer());
    maps::copy_records(maps::build_kernels(store_, false), store_.needs, all_photons,
                       {.normals = normals ? &normals_ : nullptr}, page);
    context_.finish();
    store_.statistics.device_bytes +=
        index.root.bytes() + index.nodes.bytes() + index.cell_start.bytes();
    maps::add_page(store_, std::move(page));
    (*indices_)[first_map] = std::move(index);
  }

  void end(const Stopwatch& stopwatch) {
    store_.make_query = [structure = &structure_,
                         indices = std::shared_ptr<const Indices>(indices_)](
                            const MapStore& store, const auto& parameters) {
      return std::make_unique<StructureQuery>(*structure, indices, store, parameters);
    };
    store_.statistics.seconds = stopwatch.seconds();
  }

 private:
  const Structure& structure_;
  MapStore& store_;
  const Photons& photons_;
  device::Context& context_;
  device::Buffer<float> normals_;
  std::shared_ptr<Indices> indices_ = std::make_shared<Indices>();
};

template <class T>
std::vector<T> read_all(device::Context& context, const device::Buffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  context.read(buffer, std::span(values));
  return values;
}

/// The photons of each map of a page of grids.
PhotonLists lists_of(const MapPage& page, device::Context& context, const Photons& photons,
                     float radius) {
  PhotonLists lists{context,
                    photons,
                    radius,
                    read_all(context, page.record_photon),
                    {0},
                    read_all(context, page.grids),
                    read_all(context, page.record_photon),
                    read_all(context, page.cell_start)};
  const std::vector<std::uint32_t>& cell_start = lists.cell_start;
  for (const PhotileGrid& grid : lists.planes) {
    const std::uint32_t cells = grid.columns * grid.rows;
    lists.first.push_back(cells > 0 ? cell_start[grid.first_cell + cells] : lists.first.back());
  }
  tbb::parallel_for(std::size_t{0}, lists.size(), [&](std::size_t list) {
    const auto at = [&](std::size_t i) {
      return lists.members.begin() + static_cast<std::ptrdiff_t>(lists.first[i]);
    };
    std::sort(at(list), at(list + 1));
  });
  return lists;
}

PhotonMaps build_each(const Structure& structure, const PhotonMaps& grids, const Photons& photons,
                      const Stopwatch& stopwatch) {
  const MapStore& of_grids = maps::store_of(grids);
  auto store = std::make_unique<MapStore>(*of_grids.device, of_grids.needs, of_grids.parameters);
  store->map_of = of_grids.map_of;
  store->angle_degrees = of_grids.angle_degrees;
  store->cos_angle = of_grids.cos_angle;
  store->naive = of_grids.naive;
  store->landed = of_grids.landed;
  store->normals = of_grids.normals;
  store->statistics.photons = photons.size();
  store->statistics.maps = of_grids.statistics.maps;
  store->statistics.normal_filtered_maps = of_grids.statistics.normal_filtered_maps;
  store->statistics.largest_map = of_grids.statistics.largest_map;
  store->statistics.map_sizes = of_grids.statistics.map_sizes;
  Builder builder(structure, *store, photons);
  for (std::size_t i = 0; i < of_grids.pages.size(); ++i) {
    const MapPage& page = of_grids.pages.use(i);
    const bool normals = page.record_normal.size() > 0;
    const PhotonLists lists = lists_of(page, device::context_of(*store->device), photons,
                                       static_cast<float>(store->parameters.radius));
    of_grids.pages.release();  // leaves its memory to the page that is made of it
    builder.add(page.first_map, page.last_map, lists, normals);
  }
  builder.end(stopwatch);
  return maps::maps_in(std::move(store));
}

/// `store`: of maps whose photons filter by normal. Errors: DeviceError.
PhotonMaps build_global(const Structure& structure, std::unique_ptr<MapStore> store,
                        const Photons& photons, const Stopwatch& stopwatch) {
  const auto count = static_cast<std::uint32_t>(photons.size());
  device::Context& context = device::context_of(*store->device);
  const maps::PageLimits limits{.largest_buffer = context.largest_buffer()};
  if (!limits.fit(count, 1)) {
    throw DeviceError(
        fmt::format("{} of {} photons, more than the {} that the device's largest buffer holds; "
                    "use fewer photons or another structure",
                    structure.name, count, limits.most_records()));
  }
  store->statistics.photons = count;
  Builder builder(structure, *store, photons);
  if (count > 0) {
    PhotonLists lists{context,
                      photons,
                      static_cast<float>(store->parameters.radius),
                      std::vector<std::uint32_t>(count),
                      {0, count}};
    std::iota(lists.members.begin(), lists.members.end(), 0u);
    builder.add(0, static_cast<std::uint32_t>(store->normals.size()), lists, true);
    store->statistics.maps = 1;
    store->statistics.largest_map = count;
    store->statistics.map_sizes = {count};
  }
  builder.end(stopwatch);
  return maps::maps_in(std::move(store));
}

}  // namespace

PhotonMaps build(const Structure& structure, Device& device, const Scene& scene,
                 const Photons& photons, const NeighbourGroups& groups,
                 const PhotonMapParameters& parameters) {
  const Stopwatch stopwatch;
  if (!structure.global) {
    PhotonMapParameters of_grids = parameters;
    if (structure.photons_per_cell > 0) of_grids.photons_per_cell = structure.photons_per_cell;
    PhotonMaps grids(device, scene, photons, groups, of_grids);
    return structure.is_grid() ? std::move(grids)
                               : build_each(structure, grids, photons, stopwatch);
  }
  if (std::isinf(groups.radius)) {
    throw UsageError(structure.name + " knows no triangles' maps, and so no naive ones");
  }
  auto store = std::make_unique<MapStore>(device, needs_of(scene), parameters);
  store->angle_degrees = groups.angle_degrees;
  store->cos_angle = std::cos(glm::radians(groups.angle_degrees));
  store->landed = landed_on(scene, photons);
  store->normals = maps::face_normals(scene);
  return build_global(structure, std::move(store), photons, stopwatch);
}

PhotonMaps build_over(const Structure& structure, Device& device, const Points& points,
                      double radius) {
  const Stopwatch stopwatch;
  SceneNeeds needs;
  needs.light_count = 1;
  auto store = std::make_unique<MapStore>(device, needs, PhotonMapParameters{.radius = radius});
  store->angle_degrees = points.angle_degrees;
  store->cos_angle = std::cos(glm::radians(points.angle_degrees));
  store->normals.assign(points.normals.begin(), points.normals.end());
  return build_global(structure, std::move(store), points.photons, stopwatch);
}

}  // namespace photile::structures
