#include "maps/build_maps.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>

#include "maps/build_kernels.hpp"
#include "maps/candidate_maps.hpp"
#include "maps/entry_defines.hpp"
#include "maps/gather_entries.hpp"
#include "maps/kdtree_builder.hpp"
#include "maps/map_numbers.hpp"
#include "maps/map_pages.hpp"
#include "maps/map_shapes.hpp"
#include "maps/page_queue.hpp"
#include "maps/photon_crowding.hpp"
#include "maps/photon_pages.hpp"
#include "maps/prefix_sum.hpp"

namespace photile::maps {
namespace {

using device::Buffer;
using device::Context;

/// What every step of the build needs.
struct Build {
  Context& context;
  const MapStore& store;
  device::KernelSet kernels;
  device::KernelSet tile_kernels;
  bool patches = false;            ///< maps may serve several triangles
  Buffer<PhotileMapShape> shapes;  ///< per pair of maps
  Buffer<float> crowding;          ///< per map
  Buffer<float> corners;           ///< 9 floats per triangle that is alone in its maps
  std::unique_ptr<PhotonPages> photon_pages;
  float squared_reach = 0;
  float radius = 0;
  float photons_per_cell = 0;

  template <class... Args>
  void run(const char* kernel, std::size_t size, const Args&... args) {
    kernels.run(kernel, size, work_group_size, args...);
  }
};

std::vector<glm::vec3> sided_normals(const Scene& scene) {
  std::vector<glm::vec3> normals(2 * scene.triangle_count());
  tbb::parallel_for(std::size_t{0}, normals.size(), [&](std::size_t s) {
    normals[s] = glm::vec3(sided_normal(scene, static_cast<std::uint32_t>(s)));
  });
  return normals;
}

/// The radius that photons must lie within of a triangle to enter its map: grown by what rounding
/// may do to positions as large as the scene's, so that no neighbour is lost.
float reach_of(const Scene& scene, double radius) {
  float largest = 0;
  for (const glm::vec3& v : scene.vertices) {
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  return static_cast<float>(radius * (1.0 + 1e-5) +
                            8.0 * std::numeric_limits<float>::epsilon() * largest);
}

/// Per map: how many photons it holds, and whether their normals may disagree with its triangles'.
struct MapCounts {
  Buffer<std::uint32_t> photons, mixed;  ///< `mixed` only with patches
};

void count_photons(Build& build, MapCounts& counts) {
  build.context.fill(counts.photons, 0u);
  build.context.fill(counts.mixed, 0u);
  for (const PhotonPage& page : *build.photon_pages) {
    const auto launch = [&](const auto&... patches) {
      build.run("count_photons", page.count, page.count, page.position, page.own_map, page.list,
                page.list_offsets, page.list_members, build.shapes, build.corners,
                build.squared_reach, counts.photons, patches...);
    };
    if (build.patches) {
      launch(page.normal, counts.mixed);
    } else {
      launch();
    }
  }
}

std::vector<std::uint32_t> read_all(Context& context, const Buffer<std::uint32_t>& buffer) {
  std::vector<std::uint32_t> values(buffer.size());
  context.read(buffer, std::span(values));
  return values;
}

/// The sum of the cells of maps. Errors: DeviceMemoryError where they are too many for one page.
std::uint32_t total_cells(Context& context, const Buffer<std::uint32_t>& cells_of_map) {
  std::vector<std::uint32_t> cells(cells_of_map.size());
  context.read(cells_of_map, std::span(cells));
  const std::uint64_t total = std::accumulate(cells.begin(), cells.end(), std::uint64_t{0});
  const std::uint64_t most =
      std::min(context.largest_buffer() / sizeof(std::uint32_t), max_items) - 1;
  if (total > most) {
    throw DeviceMemoryError(fmt::format(
        "photon maps of {} grid cells, more than the {} that the device's largest buffer "
        "holds; use more photons per cell, or a larger --memory if one is set",
        total, most));
  }
  return static_cast<std::uint32_t>(total);
}

/// Grids of the page's maps, but for their first cells. Returns cells per map, and a zero.
Buffer<std::uint32_t> size_grids(Build& build, MapPage& page, const MapCounts& counts) {
  const std::uint32_t maps = page.last_map - page.first_map;
  page.grids = build.context.allocate<PhotileGrid>(maps, "photon map grids");
  auto cells = build.context.allocate<std::uint32_t>(maps + 1, "first cells of photon maps");
  build.context.fill(cells, 0u);
  const auto launch = [&](const auto&... patches) {
    build.run("size_grids", maps, maps, page.first_map, build.shapes, counts.photons,
              build.crowding, patches..., build.radius, build.photons_per_cell, page.grids, cells);
  };
  if (build.patches) {
    launch(counts.mixed);
  } else {
    launch();
  }
  return cells;
}

void place_grids(Build& build, MapPage& page, const MapCounts& counts) {
  auto first_cell = size_grids(build, page, counts);
  page.cell_count = total_cells(build.context, first_cell);
  exclusive_prefix_sum(build.kernels, first_cell);
  const std::uint32_t maps = page.last_map - page.first_map;
  build.run("place_grids", maps, maps, first_cell, page.grids);
}

/// The tiling of a map, with its photons counted.
MapTiling tiling_of(Build& build, std::uint32_t map, const MapCounts& counts) {
  MapPage page;
  page.first_map = map;
  page.last_map = map + 1;
  size_grids(build, page, counts);
  PhotileGrid grid{};
  build.context.read(page.grids, std::span(&grid, 1));
  MapTiling tiling(grid, build.store.parameters.radius);
  auto bins = build.context.allocate<std::uint32_t>(std::size_t{tiling.columns()} * tiling.rows(),
                                                    "bins of a photon map");
  build.context.fill(bins, 0u);
  for (const PhotonPage& photons : build.photon_pages->entering(map, map + 1)) {
    build.tile_kernels.run("count_bins", photons.count, work_group_size, photons.count,
                           photons.position, photons.own_map, photons.list, photons.list_offsets,
                           photons.list_members, build.shapes, build.corners, build.squared_reach,
                           map, page.grids, tiling.bin_width(), tiling.bin_height(),
                           tiling.columns(), bins);
  }
  tiling.set_photons(read_all(build.context, bins));
  return tiling;
}

/// `tile`: cells that the page holds, where it holds a tile; else nothing.
void fill_cells(Build& build, MapPage& page, const std::optional<Rectangle>& tile) {
  auto cell_count = build.context.allocate<std::uint32_t>(page.cell_count + 1, "cell counts");
  page.cell_start = build.context.allocate<std::uint32_t>(page.cell_count + 1, "cell offsets",
                                                          device::MemoryPages::large);
  build.context.fill(cell_count, 0u);
  const auto launch = [&](const char* kernel, const PhotonPage& photons, const auto&... outputs) {
    const auto run = [&](const device::KernelSet& kernels, const auto&... bounds) {
      kernels.run(kernel, photons.count, work_group_size, photons.count, photons.position,
                  photons.own_map, photons.list, photons.list_offsets, photons.list_members,
                  build.shapes, build.corners, build.squared_reach, page.first_map, page.last_map,
                  page.grids, outputs..., bounds...);
    };
    if (tile) {
      run(build.tile_kernels, tile->first_column, tile->first_row, tile->last_column,
          tile->last_row);
    } else {
      run(build.kernels);
    }
  };
  const auto photon_pages = build.photon_pages->entering(page.first_map, page.last_map);
  for (const PhotonPage& photons : photon_pages) launch("count_cells", photons, cell_count);
  if (tile) {
    build.tile_kernels.run("narrow_gaps", tile->height(), work_group_size, page.grids, cell_count,
                           tile->first_column, tile->first_row, tile->last_column, tile->last_row);
  }
  exclusive_prefix_sum(build.kernels, cell_count, page.cell_start);
  build.context.read(page.cell_start, std::span(&page.entry_count, 1), page.cell_count);

  page.entry_photon = build.context.allocate<std::uint32_t>(page.entry_count, "photon references");
  if (tile) build.context.fill(page.entry_photon, none);  // that gaps have
  for (const PhotonPage& photons : photon_pages) {
    launch("scatter", photons, page.cell_start, cell_count, photons.first_photon,
           page.entry_photon);
  }
  build.run("sort_cells", page.cell_count, page.cell_count, page.cell_start, page.entry_photon);
  build.context.finish();  // cell_count is released here
}

/// An array of a photon page takes at most a 32nd of the memory, so that the page takes about an
/// eighth.
std::unique_ptr<PhotonPages> photon_pages(Context& context, const MapStore& store,
                                          const CandidateMaps& candidates, const Photons& photons,
                                          Progress& progress) {
  return std::make_unique<PhotonPages>(
      context,
      [&](std::uint64_t max_bytes) { return plan_photon_pages(photons, candidates, max_bytes); },
      [&](PhotonRange range) {
        progress.throw_if_cancelled();
        return upload_photon_page(context, photons, store.normals, store.map_of, candidates, range);
      },
      std::min(context.largest_buffer(), context.memory_limit() / 32));
}

/// A page of maps takes at most half of the memory: beside it lie a page of photons and what the
/// build needs, later a batch of hits and its estimates.
PageLimits page_limits(const Context& context, const MapStore& store, float photons_per_cell,
                       bool normals) {
  const std::uint64_t record = bytes_per_entry(store.needs) + (normals ? 3 * sizeof(float) : 0);
  // Two cells for what photons_per_cell asks of one: grids reach beyond the photons. Each is
  // counted and has a start.
  const double cells = 2.0 / photons_per_cell;
  const auto cell_bytes = static_cast<std::uint64_t>(std::ceil(2 * sizeof(std::uint32_t) * cells));
  return {.largest_buffer = context.largest_buffer(),
          .page_bytes = context.memory_limit() / 2,
          .bytes_per_entry = record + cell_bytes,
          .bytes_per_map = sizeof(PhotileGrid) + sizeof(std::uint32_t)};
}

/// Brute force and trees take the photons of a map from a grid of one cell.
float photons_per_cell(const PhotonMapParameters& parameters) {
  constexpr float all = 1e12f;
  return parameters.structure == MapStructure::uniform_grid ? parameters.photons_per_cell : all;
}

std::string surface_name(std::uint32_t pair, const Patches& patches) {
  return patches.empty()
             ? fmt::format("triangle {}", pair)
             : fmt::format("triangle {} and its patch", triangle_of(patches.of(pair).front()));
}

/// `mixed`: per map, 1 where queries filter by normal; empty without patches.
bool holds_mixed(std::span<const std::uint32_t> mixed, const MapRange& range) {
  if (mixed.empty()) return false;
  const auto maps = mixed.subspan(range.first, range.last - range.first);
  return std::find(maps.begin(), maps.end(), 1u) != maps.end();
}

MapPage build_page(Build& build, const Photons& photons, const MapRange& range,
                   std::span<const std::uint32_t> counts, std::span<const std::uint32_t> mixed,
                   const MapCounts& map_counts) {
  const MapStore& store = build.store;
  MapPage page;
  page.first_map = range.first;
  page.last_map = range.last;
  std::optional<Rectangle> cells;
  if (range.tile) {
    const MapTiling& tiling = store.tilings.at(range.first);
    const PhotileGrid grid = tiling.page_grid(*range.tile);
    cells = tiling.cells(*range.tile);
    page.grids = build.context.upload(std::span(&grid, 1), "photon map grids");
    page.cell_count = cells->height() * grid.columns;
  } else {
    place_grids(build, page, map_counts);
  }
  fill_cells(build, page, cells);
  if (is_tree(store.parameters.structure)) {
    build_trees(build.context, store.parameters.structure, photons, counts, page);
  }
  gather_entries(build.kernels, store.needs, *build.photon_pages, holds_mixed(mixed, range), page);
  build.context.finish();
  return page;
}

void add_page(MapStore& store, MapPage page) {
  PhotonMapStatistics& statistics = store.statistics;
  statistics.references += page.entry_count;
  statistics.cells += page.cell_count;
  statistics.nodes += page.tree_nodes.size();
  statistics.device_bytes += page.device_bytes();
  ++statistics.pages;
  store.pages.add(std::move(page));
}

/// Gives the page of a tile a map of its own, numbered `map`.
void renumber_tile(MapStore& store, const MapRange& range, std::uint32_t map, MapPage& page) {
  store.tilings.at(range.first).assign(*range.tile, map);
  page.first_map = map;
  page.last_map = map + 1;
}

void count_all_photons(Build& build, MapCounts& counts) {
  for (;;) {
    try {
      count_photons(build, counts);
      return;
    } catch (const DeviceMemoryError&) {
      if (!build.photon_pages->halve()) throw;
    }
  }
}

}  // namespace

void build_maps_of_groups(MapStore& store, const Scene& scene, const Photons& photons,
                          const NeighbourGroups& groups, Progress& progress) {
  Context& context = store.device->context();
  const float reach = reach_of(scene, store.parameters.radius);
  const Patches& patches = groups.patches;
  if (!patches.empty()) store.normals = sided_normals(scene);
  CandidateMaps candidates = find_candidate_maps(scene, photons, groups, reach);
  MapNumbers numbers = number_maps(candidates, patches, 2 * scene.triangle_count());
  store.map_of = std::move(numbers.map_of);
  Build build{context,
              store,
              build_kernels(store, !patches.empty()),
              tile_kernels(store),
              !patches.empty(),
              {},
              {},
              {},
              {},
              reach * reach,
              static_cast<float>(store.parameters.radius),
              photons_per_cell(store.parameters)};
  const MapShapes surfaces =
      map_shapes(scene, patches, numbers.pairs, glm::radians(groups.angle_degrees));
  build.corners = context.upload(std::span(surfaces.corners), "triangle corners");
  build.shapes = context.upload(std::span(surfaces.shapes), "map shapes");
  const std::vector<float> crowding =
      of_numbered(numbers, photon_crowding(scene, photons, patches));
  build.crowding = context.upload(std::span(crowding), "photon crowding");
  build.photon_pages = photon_pages(context, store, candidates, photons, progress);

  const std::size_t map_total = numbers.map_count();
  MapCounts map_counts;
  map_counts.photons = context.allocate<std::uint32_t>(map_total, "photons per map");
  map_counts.mixed = context.allocate<std::uint32_t>(build.patches ? map_total : 0, "mixed maps");
  count_all_photons(build, map_counts);
  const std::vector<std::uint32_t> counts = read_all(context, map_counts.photons);
  const std::vector<std::uint32_t> mixed = read_all(context, map_counts.mixed);

  PhotonMapStatistics& statistics = store.statistics;
  statistics.mixed_maps = static_cast<std::uint64_t>(std::count(mixed.begin(), mixed.end(), 1u));
  PageQueue queue(
      counts, page_limits(context, store, build.photons_per_cell, statistics.mixed_maps > 0),
      store.tilings, [&](std::uint32_t map) { return tiling_of(build, map, map_counts); },
      [&](std::uint32_t map) { return surface_name(numbers.pairs[map / 2], patches); });
  auto tile_number = static_cast<std::uint32_t>(map_total);
  while (const auto range = queue.next()) {
    progress.throw_if_cancelled();
    try {
      MapPage page = build_page(build, photons, *range, counts, mixed, map_counts);
      if (range->tile) renumber_tile(store, *range, tile_number++, page);
      add_page(store, std::move(page));
      progress.advance(range->entries);
    } catch (const DeviceMemoryError&) {
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
  if (statistics.mixed_maps == 0) store.normals.clear();
  statistics.maps = static_cast<std::uint64_t>(
      std::count_if(counts.begin(), counts.end(), [](std::uint32_t count) { return count > 0; }));
  statistics.largest_map = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
}

void build_global_map(MapStore& store, const Scene& scene, const Photons& photons) {
  const auto count = static_cast<std::uint32_t>(photons.size());
  if (count == 0) return;
  Context& context = store.device->context();
  const PageLimits limits{.largest_buffer = context.largest_buffer()};
  if (!limits.fit(count, 1)) {
    throw DeviceError(fmt::format(
        "a global kd-tree of {} photons, more than the {} that the device's largest buffer holds; "
        "use fewer photons, more --passes or another --structure",
        count, limits.most_entries()));
  }
  MapPage page;
  page.first_map = 0;
  page.last_map = static_cast<std::uint32_t>(2 * scene.triangle_count());
  page.entry_count = count;
  build_global_tree(context, photons, page);

  store.normals = sided_normals(scene);
  PhotonPages pages(
      context,
      [&](std::uint64_t) {
        return std::vector<PhotonRange>{{0, count}};
      },
      [&](PhotonRange range) {
        return upload_photon_records(context, photons, store.normals, range);
      },
      context.largest_buffer());
  gather_entries(build_kernels(store, false), store.needs, pages, true, page);
  context.finish();
  store.statistics.maps = 1;
  store.statistics.largest_map = count;
  add_page(store, std::move(page));
}

}  // namespace photile::maps
