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
      build.run_over(page, build.kernels, "count_photons", page.entered, build.counts.photons,
                     patches...);
    };
    if (build.patches) {
      launch(build.normals, build.counts.mixed);
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
      std::min(context.largest_buffer() / sizeof(std::uint32_t), max_items) - 2;
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

void find_entered(const Build& build, PhotonPage& page) {
  page.entered = build.context.allocate<std::uint32_t>(page.count, "maps that photons enter");
  build.run_over(page, build.kernels, "find_entered", page.entered);
}

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
    build.run_over(photons, build.tile_kernels, "count_bins", photons.entered, map, page.grids,
                   tiling.bin_width(), tiling.bin_height(), tiling.columns(), bins);
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
  page.cell_start = build.context.allocate<std::uint32_t>(
      std::size_t{page.cell_count} + 2, "cell offsets", device::MemoryPages::large);
  build.context.fill(page.cell_start, 0u);
  const auto with_tile = [&](const auto& run) {
    if (tile) {
      run(build.tile_kernels, tile->first_column, tile->first_row, tile->last_column,
          tile->last_row);
    } else {
      run(build.kernels);
    }
  };
  const auto over_photons = [&](const PhotonPage& photons, const char* kernel,
                                const auto&... outputs) {
    with_tile([&](const device::KernelSet& kernels, const auto&... bounds) {
      build.run_over(photons, kernels, kernel, photons.entered, page.first_map, page.last_map,
                     page.grids, page.cell_start, outputs..., bounds...);
    });
  };
  const auto over_gaps = [&](const char* kernel) {
    if (!tile) return;
    build.tile_kernels.run(kernel, tile->height(), work_group_size, page.grids, page.cell_start,
                           tile->first_column, tile->first_row, tile->last_column, tile->last_row);
  };
  const auto photon_pages = build.photon_pages->entering(page.first_map, page.last_map);
  for (const PhotonPage& photons : photon_pages) over_photons(photons, "count_cells");
  over_gaps("narrow_gaps");
  exclusive_prefix_sum(build.kernels, page.cell_start);
  build.context.read(page.cell_start, std::span(&page.entry_count, 1),
                     std::size_t{page.cell_count} + 1);
  over_gaps("skip_gaps");

  page.entry_photon = build.context.allocate<std::uint32_t>(page.entry_count, "photon references");
  if (tile) build.context.fill(page.entry_photon, none);  // that gaps have
  for (const PhotonPage& photons : photon_pages) {
    over_photons(photons, "scatter", photons.first_photon, page.entry_photon);
  }
  build.run("sort_cells", page.cell_count, page.cell_count, page.cell_start, page.entry_photon);
}

}  // namespace photile::maps
