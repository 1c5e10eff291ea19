#include "maps/build_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "maps/prefix_sum.hpp"
#include "photile/errors.hpp"

namespace photile::maps {
namespace {

using device::Buffer;
using device::Context;

/// With the pages of photons as they are. Errors: DeviceMemoryError where they do not fit.
void try_to_count(Build& build) {
  build.context.fill(build.counts.photons, 0u);
  build.context.fill(build.counts.mixed, 0u);
  for (const PhotonPage& page : *build.photon_pages) {
    const auto launch = [&](const auto&... patches) {
      build.run("count_photons", page.count, page.count, page.position, page.own_map, page.list,
                page.list_offsets, page.list_members, build.shapes, build.corners,
                build.squared_reach, build.counts.photons, patches...);
    };
    if (build.patches) {
      launch(page.normal, build.counts.mixed);
    } else {
      launch();
    }
  }
}

/// The sum of the cells of maps. Errors: DeviceMemoryError where they are too many for one page.
std::uint32_t total_cells(Context& context, const Buffer<std::uint32_t>& cells_of_map) {
  const std::vector<std::uint32_t> cells = read_all(context, cells_of_map);
  const std::uint64_t total = std::accumulate(cells.begin(), cells.end(), std::uint64_t{0});
  const std::uint64_t most =
      std::min(context.largest_buffer() / sizeof(std::uint32_t), max_items) - 1;
  if (total > most) {
    throw DeviceMemoryError(fmt::format(
        "photon maps of {} grid cells, more than the {} that the device's largest buffer "
        "holds; use more photons per cell, or a larger memory limit if one is set",
        total, most));
  }
  return static_cast<std::uint32_t>(total);
}

/// Grids of the page's maps, but for their first cells. Returns cells per map, and a zero.
Buffer<std::uint32_t> size_grids(const Build& build, MapPage& page) {
  const std::uint32_t maps = page.last_map - page.first_map;
  page.grids = build.context.allocate<PhotileGrid>(maps, "photon map grids");
  auto cells = build.context.allocate<std::uint32_t>(maps + 1, "first cells of photon maps");
  build.context.fill(cells, 0u);
  const auto launch = [&](const auto&... patches) {
    build.run("size_grids", maps, maps, page.first_map, build.shapes, build.counts.photons,
              build.crowding, patches..., build.radius, build.photons_per_cell, page.grids, cells);
  };
  if (build.patches) {
    launch(build.counts.mixed);
  } else {
    launch();
  }
  return cells;
}

}  // namespace

void count_photons(Build& build, std::size_t map_count) {
  build.counts.photons = build.context.allocate<std::uint32_t>(map_count, "photons per map");
  build.counts.mixed =
      build.context.allocate<std::uint32_t>(build.patches ? map_count : 0, "mixed maps");
  for (;;) {
    try {
      try_to_count(build);
      return;
    } catch (const DeviceMemoryError&) {
      if (!build.photon_pages->halve()) throw;
    }
  }
}

std::vector<std::uint32_t> read_all(Context& context, const Buffer<std::uint32_t>& buffer) {
  std::vector<std::uint32_t> values(buffer.size());
  context.read(buffer, std::span(values));
  return values;
}

MapTiling tiling_of(const Build& build, std::uint32_t map) {
  MapPage page;
  page.first_map = map;
  page.last_map = map + 1;
  size_grids(build, page);
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

void place_grids(const Build& build, MapPage& page) {
  auto first_cell = size_grids(build, page);
  page.cell_count = total_cells(build.context, first_cell);
  exclusive_prefix_sum(build.kernels, first_cell);
  const std::uint32_t maps = page.last_map - page.first_map;
  build.run("place_grids", maps, maps, first_cell, page.grids);
}

void fill_cells(const Build& build, MapPage& page, const std::optional<Rectangle>& tile) {
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

}  // namespace photile::maps
