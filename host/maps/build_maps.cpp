#include "maps/build_maps.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "maps/build_kernels.hpp"
#include "maps/candidate_maps.hpp"
#include "maps/gather_entries.hpp"
#include "maps/kdtree_builder.hpp"
#include "maps/map_pages.hpp"
#include "maps/map_shapes.hpp"
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
  bool patches = false;            ///< maps may serve several triangles
  Buffer<PhotileMapShape> shapes;  ///< per pair of maps
  Buffer<float> crowding;          ///< per map
  Buffer<float> corners;           ///< 9 floats per triangle
  std::unique_ptr<PhotonPages> photon_pages;
  float squared_reach = 0;
  float radius = 0;
  float photons_per_cell = 0;

  template <class... Args>
  void run(const char* kernel, std::size_t size, const Args&... args) {
    kernels.run(kernel, size, work_group_size, args...);
  }
};

std::vector<float> corner_coordinates(const Scene& scene) {
  std::vector<float> corners;
  corners.reserve(9 * scene.triangle_count());
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    for (const glm::vec3& corner : scene.corners(t)) {
      corners.insert(corners.end(), {corner.x, corner.y, corner.z});
    }
  }
  return corners;
}

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

void size_grids(Build& build, MapPage& page, const MapCounts& counts) {
  const std::uint32_t maps = page.last_map - page.first_map;
  page.grids = build.context.allocate<PhotileGrid>(maps, "photon map grids");
  auto first_cell = build.context.allocate<std::uint32_t>(maps + 1, "first cells of photon maps");
  build.context.fill(first_cell, 0u);
  const auto launch = [&](const auto&... patches) {
    build.run("size_grids", maps, maps, page.first_map, build.shapes, counts.photons,
              build.crowding, patches..., build.radius, build.photons_per_cell, page.grids,
              first_cell);
  };
  if (build.patches) {
    launch(counts.mixed);
  } else {
    launch();
  }
  page.cell_count = total_cells(build.context, first_cell);
  exclusive_prefix_sum(build.kernels, first_cell);
  build.run("place_grids", maps, maps, first_cell, page.grids);
}

void fill_cells(Build& build, MapPage& page) {
  auto cell_count = build.context.allocate<std::uint32_t>(page.cell_count + 1, "cell counts");
  page.cell_start = build.context.allocate<std::uint32_t>(page.cell_count + 1, "cell offsets");
  build.context.fill(cell_count, 0u);
  for (const PhotonPage& photons : *build.photon_pages) {
    build.run("count_cells", photons.count, photons.count, photons.position, photons.own_map,
              photons.list, photons.list_offsets, photons.list_members, build.shapes, build.corners,
              build.squared_reach, page.first_map, page.last_map, page.grids, cell_count);
  }
  exclusive_prefix_sum(build.kernels, cell_count, page.cell_start);

  page.entry_photon = build.context.allocate<std::uint32_t>(page.entry_count, "photon references");
  for (const PhotonPage& photons : *build.photon_pages) {
    build.run("scatter", photons.count, photons.count, photons.position, photons.own_map,
              photons.list, photons.list_offsets, photons.list_members, build.shapes, build.corners,
              build.squared_reach, page.first_map, page.last_map, page.grids, page.cell_start,
              cell_count, photons.first_photon, page.entry_photon);
  }
  build.run("sort_cells", page.cell_count, page.cell_count, page.cell_start, page.entry_photon);
  build.context.finish();  // cell_count is released here
}

/// An array of a photon page takes at most a 32nd of the memory, so that the page takes about an
/// eighth.
std::unique_ptr<PhotonPages> photon_pages(Context& context, const MapStore& store,
                                          const Patches& patches, const CandidateMaps& candidates,
                                          const Photons& photons, Progress& progress) {
  return std::make_unique<PhotonPages>(
      context,
      [&](std::uint64_t max_bytes) { return plan_photon_pages(photons, candidates, max_bytes); },
      [&](PhotonRange range) {
        progress.throw_if_cancelled();
        return upload_photon_page(context, photons, store.normals, patches, candidates, range);
      },
      std::min(context.largest_buffer(), context.memory_limit() / 32));
}

/// A page of maps takes at most half of the memory: beside it lie a page of photons and what the
/// build needs, later a batch of hits and its estimates.
PageLimits page_limits(const Context& context, const MapStore& store, float photons_per_cell,
                       bool normals) {
  const SceneNeeds& needs = store.needs;
  const std::uint64_t record =
      7 * sizeof(float) + (needs.light_count > 1 ? sizeof(std::uint16_t) : 0) +
      (needs.glossy ? 3 * sizeof(float) : 0) + (normals ? 3 * sizeof(float) : 0);
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
  page.entry_count = static_cast<std::uint32_t>(range.entries);
  size_grids(build, page, map_counts);
  fill_cells(build, page);
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

}  // namespace

void build_maps_of_groups(MapStore& store, const Scene& scene, const Photons& photons,
                          const NeighbourGroups& groups, Progress& progress) {
  Context& context = store.device->context();
  const float reach = reach_of(scene, store.parameters.radius);
  const Patches& patches = groups.patches;
  store.map_of = patches.map_of;
  if (!patches.empty()) store.normals = sided_normals(scene);
  Build build{context,
              store,
              build_kernels(store),
              !patches.empty(),
              {},
              {},
              {},
              {},
              reach * reach,
              static_cast<float>(store.parameters.radius),
              photons_per_cell(store.parameters)};
  const std::vector<float> corners = corner_coordinates(scene);
  build.corners = context.upload(std::span<const float>(corners), "triangle corners");
  const std::vector<PhotileMapShape> shapes =
      map_shapes(scene, patches, glm::radians(groups.angle_degrees));
  build.shapes = context.upload(std::span<const PhotileMapShape>(shapes), "map shapes");
  build.crowding = context.upload(std::span<const float>(photon_crowding(scene, photons, patches)),
                                  "photon crowding");
  const CandidateMaps candidates = find_candidate_maps(scene, photons, groups, reach);
  build.photon_pages = photon_pages(context, store, patches, candidates, photons, progress);

  const std::size_t map_total = 2 * shapes.size();
  MapCounts map_counts;
  map_counts.photons = context.allocate<std::uint32_t>(map_total, "photons per map");
  map_counts.mixed = context.allocate<std::uint32_t>(build.patches ? map_total : 0, "mixed maps");
  for (bool counted = false; !counted;) {
    try {
      count_photons(build, map_counts);
      counted = true;
    } catch (const DeviceMemoryError&) {
      if (!build.photon_pages->halve()) throw;
    }
  }
  const std::vector<std::uint32_t> counts = read_all(context, map_counts.photons);
  const std::vector<std::uint32_t> mixed = read_all(context, map_counts.mixed);

  PhotonMapStatistics& statistics = store.statistics;
  statistics.mixed_maps = static_cast<std::uint64_t>(std::count(mixed.begin(), mixed.end(), 1u));
  std::vector<MapRange> ranges = plan_map_pages(
      counts, page_limits(context, store, build.photons_per_cell, statistics.mixed_maps > 0),
      patches);
  std::reverse(ranges.begin(), ranges.end());
  while (!ranges.empty()) {
    progress.throw_if_cancelled();
    const MapRange range = ranges.back();
    ranges.pop_back();
    try {
      add_page(store, build_page(build, photons, range, counts, mixed, map_counts));
      progress.advance(range.entries);
    } catch (const DeviceMemoryError&) {
      const auto halves = halves_of(range, counts);
      if (!build.photon_pages->halve() && !halves) throw;
      if (halves) {
        ranges.insert(ranges.end(), {halves->second, halves->first});
      } else {
        ranges.push_back(range);
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
  const std::vector<std::uint32_t> counts{count};
  if (plan_map_pages(counts, {.largest_buffer = context.largest_buffer()}).size() != 1) return;
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
        return upload_photon_records(context, photons, store.normals, {}, range);
      },
      context.largest_buffer());
  gather_entries(build_kernels(store), store.needs, pages, true, page);
  context.finish();
  store.statistics.maps = 1;
  store.statistics.largest_map = count;
  add_page(store, std::move(page));
}

}  // namespace photile::maps
