#include "maps/build_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "maps/map_page.hpp"
#include "photile/device/grid.h"
#include "photile/errors.hpp"

namespace photile::maps {

device::KernelSet build_kernels(const MapStore& store, bool patches) {
  device::Defines defines = group_defines(store.device->info());
  set_record_defines(defines, store.needs);
  if (patches) defines.set("PATCHES");
  return {device::context_of(*store.device), "grid/build.cl", std::move(defines)};
}

namespace {

using device::Buffer;
using device::Context;

/// Groups that sort crowded cells: enough to fill any GPU with what there is of them.
constexpr std::size_t sorting_groups = 1024;

PhotilePhotonPage photon_page(const PhotonPage& photons, float squared_reach) {
  return {.photon_count = photons.count,
          .first_photon = photons.first_photon,
          .first_list = photons.first_list,
          .squared_reach = squared_reach};
}

/// A launch over photons of a page, given what tells which maps they enter.
device::Launch photon_launch(const Build& build, const char* kernel, const PhotonPage& photons) {
  device::Launch launch = build.kernels.launch(kernel);
  launch.set("page", photon_page(photons, build.squared_reach))
      .set("position", photons.position)
      .set("oriented_face", photons.oriented_face)
      .set("map_of", build.map_of)
      .set("list", photons.list)
      .set("list_offsets", photons.list_offsets)
      .set("list_members", photons.list_members)
      .set("shapes", build.shapes)
      .set("corners", build.corners);
  return launch;
}

/// A launch over the photons where the maps that they are inserted into are found.
device::Launch entered_launch(const Build& build, const char* kernel, const PhotonPage& photons) {
  device::Launch launch = photon_launch(build, kernel, photons);
  launch.set("inserted", photons.inserted);
  return launch;
}

/// Counts with the pages of photons as they are. Errors: DeviceMemoryError where they do not fit.
void try_to_count(Build& build) {
  build.context.fill(build.counts.photons, 0u);
  build.context.fill(build.counts.normal_filtered, 0u);
  build.photon_pages->for_each([&](const PhotonPage& page) {
    device::Launch launch = entered_launch(build, "count_photons", page);
    launch.set("map_count", build.counts.photons)
        .set("normal", build.normals)
        .set("map_normal_filtered", build.counts.normal_filtered);
    launch.run(page.count, work_group_size);
  });
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

/// Grids of the page's maps, without their first cells. Returns cells per map, and a zero.
Buffer<std::uint32_t> size_grids(const Build& build, MapPage& page) {
  const std::uint32_t maps = page.last_map - page.first_map;
  page.grids = build.context.allocate<PhotileGrid>(maps, "photon map grids");
  auto cells = build.context.allocate<std::uint32_t>(maps + 1, "first cells of photon maps");
  build.context.fill(cells, 0u);
  device::Launch launch = build.kernels.launch("size_grids");
  launch.set("map_total", maps)
      .set("first_map", page.first_map)
      .set("shapes", build.shapes)
      .set("map_count", build.counts.photons)
      .set("map_density_ratio", build.density_ratio)
      .set("map_normal_filtered", build.counts.normal_filtered)
      .set("radius", build.radius)
      .set("photons_per_cell", build.store.parameters.photons_per_cell)
      .set("grids", page.grids)
      .set("cell_total", cells);
  launch.run(maps, work_group_size);
  return cells;
}

}  // namespace

void sort_cells(const device::KernelSet& kernels, const MapPage& page) {
  device::Context& context = kernels.context();
  device::Launch launch = kernels.launch("sort_cells");
  launch.set("cell_count", page.cell_count)
      .set("cell_start", page.cell_start)
      .set("record_photon", page.record_photon);
  const bool in_groups = works_in_groups(context.info());
  auto crowded = context.allocate<std::uint32_t>(in_groups ? 1 : 0, "number of crowded cells");
  auto crowded_cell = context.allocate<std::uint32_t>(
      in_groups ? page.record_count / PHOTILE_INSERTION_LIMIT + 1 : 0, "crowded cells");
  context.fill(crowded, 0u);
  launch.set("crowded", crowded).set("crowded_cell", crowded_cell);
  launch.run(page.cell_count, work_group_size);
  if (!in_groups) return;
  kernels.launch("sort_crowded")
      .set("cell_start", page.cell_start)
      .set("record_photon", page.record_photon)
      .set("crowded", crowded)
      .set("crowded_cell", crowded_cell)
      .run_no_more(sorting_groups * group_size, group_size);
}

void find_insertions(const Build& build, PhotonPage& page) {
  page.inserted = build.context.allocate<std::uint32_t>(page.count, "maps that photons enter");
  photon_launch(build, "find_insertions", page)
      .set("inserted", page.inserted)
      .run(page.count, work_group_size);
}

void count_photons(Build& build, std::size_t map_count) {
  build.counts.photons = build.context.allocate<std::uint32_t>(map_count, "photons per map");
  build.counts.normal_filtered =
      build.context.allocate<std::uint32_t>(build.patches ? map_count : 0, "normal-filtered maps");
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

void lay_out_grids(const Build& build, MapPage& page) {
  auto first_cell = size_grids(build, page);
  page.cell_count = total_cells(build.context, first_cell);
  exclusive_prefix_sum(build.kernels, first_cell);
  const std::uint32_t maps = page.last_map - page.first_map;
  build.kernels.launch("lay_out_grids")
      .set("map_total", maps)
      .set("first_cell", first_cell)
      .set("grids", page.grids)
      .run(maps, work_group_size);
}

void fill_cells(const Build& build, MapPage& page) {
  page.cell_start = build.context.allocate<std::uint32_t>(
      std::size_t{page.cell_count} + 2, "cell offsets", memory_pages(build.store));
  build.context.fill(page.cell_start, 0u);
  const auto over_photons = [&](const char* kernel, const PhotonPage& photons) {
    device::Launch launch = entered_launch(build, kernel, photons);
    launch.set("maps", PhotileMapRange{page.first_map, page.last_map})
        .set("grids", page.grids)
        .set("cell_start", page.cell_start);
    return launch;
  };
  const auto for_each_entering = [&](const auto& visit) {
    build.photon_pages->for_each_entering(page.first_map, page.last_map, visit);
  };
  for_each_entering([&](const PhotonPage& photons) {
    over_photons("count_cells", photons).run(photons.count, work_group_size);
  });
  exclusive_prefix_sum(build.kernels, page.cell_start);
  build.context.read(page.cell_start, std::span(&page.record_count, 1),
                     std::size_t{page.cell_count} + 1);

  page.record_photon =
      build.context.allocate<std::uint32_t>(page.record_count, "photon references");
  for_each_entering([&](const PhotonPage& photons) {
    over_photons("scatter", photons)
        .set("record_photon", page.record_photon)
        .run(photons.count, work_group_size);
  });
  sort_cells(build.kernels, page);
}

void copy_records(const device::KernelSet& build, const SceneNeeds& needs,
                  PhotonPages& photon_pages, const RecordCopying& gathering, MapPage& page) {
  device::Context& context = build.context();
  page.record_stride = record_stride(page.record_count);
  // Vector loads reach into padding; what they find there is masked, but must be a number.
  const auto planes = [&](std::string_view what) {
    auto buffer =
        context.allocate<float>(3 * std::size_t{page.record_stride}, what, gathering.memory);
    for (std::size_t plane = 0; plane < 3; ++plane) {
      context.fill(buffer, 0.0f, plane * page.record_stride + page.record_count,
                   page.record_stride - page.record_count);
    }
    return buffer;
  };
  page.record_position = planes("photon map positions");
  page.record_flux = planes("photon map flux");
  if (needs.several_lights()) {
    page.record_light =
        context.allocate<std::uint8_t>(std::size_t{bytes_per_light(needs)} * page.record_stride,
                                       "photon map lights", gathering.memory);
  }
  if (needs.glossy) page.record_incoming = planes("photon map directions");
  if (gathering.normals != nullptr) page.record_normal = planes("photon map normals");
  const PhotonRelease* const release = photon_pages.single() ? gathering.release : nullptr;
  photon_pages.for_each_entering(page.first_map, page.last_map, [&](const PhotonPage& photons) {
    if (release != nullptr) {  // all memory is allocated: the page in use stays to the end
      context.finish();
      photon_pages.release_lists();
      release->lists();
    }
    const auto launch_of = [&](const char* kernel) {
      device::Launch launch = build.launch(kernel);
      launch.set("page", photon_page(photons, 0))
          .set("record_count", page.record_count)
          .set("record_stride", page.record_stride)
          .set("record_photon", page.record_photon);
      return launch;
    };
    device::Launch gather = launch_of("copy_records");
    gather.set("position", photons.position)
        .set("flux", photons.flux)
        .set("light", photons.light)
        .set("incoming", photons.incoming)
        .set("record_position", page.record_position)
        .set("record_flux", page.record_flux)
        .set("record_light", page.record_light)
        .set("record_incoming", page.record_incoming);
    gather.run(page.record_count, work_group_size);
    if (release != nullptr) {
      context.finish();
      photon_pages.release_records();
      release->records();
    }
    if (gathering.normals != nullptr) {
      launch_of("gather_normals")
          .set("oriented_face", photons.oriented_face)
          .set("normal", *gathering.normals)
          .set("record_normal", page.record_normal)
          .run(page.record_count, work_group_size);
    }
  });
}

namespace {

constexpr std::uint32_t scan_block = 2048;

}  // namespace

void exclusive_prefix_sum(const device::KernelSet& kernels,
                          const device::Buffer<std::uint32_t>& values,
                          device::Buffer<std::uint32_t>& scanned) {
  const auto count = static_cast<std::uint32_t>(values.size());
  if (count == 0) return;
  const std::uint32_t blocks = (count + scan_block - 1) / scan_block;
  device::Context& context = kernels.context();
  const bool in_groups = works_in_groups(context.info());
  const auto run = [&](device::Launch& launch) {
    if (in_groups) {
      launch.run(blocks * group_size, group_size);
    } else {
      launch.run(blocks, work_group_size);
    }
  };
  auto block_sum = context.allocate<std::uint32_t>(blocks, "block sums of a prefix sum");
  if (blocks == 1) {
    context.fill(block_sum, 0u);
  } else {
    device::Launch launch = kernels.launch("sum_blocks");
    launch.set("count", count)
        .set("values", values)
        .set("block_size", scan_block)
        .set("block_count", blocks)
        .set("block_sum", block_sum);
    run(launch);
    exclusive_prefix_sum(kernels, block_sum, block_sum);
  }
  device::Launch launch = kernels.launch("scan_blocks");
  launch.set("count", count)
      .set("values", values)
      .set("block_size", scan_block)
      .set("block_count", blocks)
      .set("block_start", block_sum)
      .set("scanned", scanned);
  run(launch);
}

void exclusive_prefix_sum(const device::KernelSet& kernels, device::Buffer<std::uint32_t>& values) {
  exclusive_prefix_sum(kernels, values, values);
}

}  // namespace photile::maps
