#include "maps/build_uniform_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "maps/candidate_maps.hpp"
#include "maps/map_pages.hpp"
#include "maps/photon_pages.hpp"
#include "maps/prefix_sum.hpp"

namespace photile::maps {
namespace {

using device::Buffer;
using device::Context;
using device::Defines;

/// What every step of the build needs.
struct Build {
  Context& context;
  const UniformGrid& grid;
  Buffer<float> corners;  ///< 9 floats per triangle
  std::vector<PhotonPage> photon_pages;
  float squared_reach = 0;
  float radius = 0;

  template <class... Args>
  void run(const char* file, const char* kernel, std::size_t size, const Args&... args) {
    context.run(context.kernel(file, kernel, Defines{}), size, work_group_size, args...);
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

std::vector<std::uint32_t> count_photons(Build& build, std::size_t map_total,
                                         Buffer<std::uint32_t>& map_count) {
  build.context.fill(map_count, 0u);
  for (const PhotonPage& page : build.photon_pages) {
    build.run("grid/count_photons.cl", "count_photons", page.count, page.count, page.position,
              page.own_map, page.list, page.list_offsets, page.list_members, build.corners,
              build.squared_reach, map_count);
  }
  std::vector<std::uint32_t> counts(map_total);
  build.context.read(map_count, std::span(counts));
  return counts;
}

/// The last element of a scanned buffer: the total.
std::uint32_t read_total(Context& context, const Buffer<std::uint32_t>& scanned) {
  std::uint32_t total = 0;
  context.read(scanned, std::span(&total, 1), scanned.size() - 1);
  return total;
}

void size_grids(Build& build, MapPage& page, const Buffer<std::uint32_t>& map_count) {
  const std::uint32_t maps = page.last_map - page.first_map;
  page.grids = build.context.allocate<PhotileGrid>(maps, "photon map grids");
  auto first_cell = build.context.allocate<std::uint32_t>(maps + 1, "first cells of photon maps");
  build.context.fill(first_cell, 0u);
  build.run("grid/size_grids.cl", "size_grids", maps, maps, page.first_map, build.corners,
            map_count, build.radius, build.grid.parameters.photons_per_cell, page.grids,
            first_cell);
  exclusive_prefix_sum(build.context, first_cell);
  build.run("grid/size_grids.cl", "place_grids", maps, maps, first_cell, page.grids);
  page.cell_count = read_total(build.context, first_cell);
}

void fill_cells(Build& build, MapPage& page) {
  auto cell_count = build.context.allocate<std::uint32_t>(page.cell_count + 1, "cell counts");
  page.cell_start = build.context.allocate<std::uint32_t>(page.cell_count + 1, "cell offsets");
  build.context.fill(cell_count, 0u);
  for (const PhotonPage& photons : build.photon_pages) {
    build.run("grid/fill_cells.cl", "count_cells", photons.count, photons.count, photons.position,
              photons.own_map, photons.list, photons.list_offsets, photons.list_members,
              build.corners, build.squared_reach, page.first_map, page.last_map, page.grids,
              cell_count);
  }
  exclusive_prefix_sum(build.context, cell_count, page.cell_start);

  page.entry_photon = build.context.allocate<std::uint32_t>(page.entry_count, "photon references");
  for (const PhotonPage& photons : build.photon_pages) {
    build.run("grid/fill_cells.cl", "scatter", photons.count, photons.count, photons.position,
              photons.own_map, photons.list, photons.list_offsets, photons.list_members,
              build.corners, build.squared_reach, page.first_map, page.last_map, page.grids,
              page.cell_start, cell_count, photons.first_photon, page.entry_photon);
  }
  build.run("grid/sort_cells.cl", "sort_cells", page.cell_count, page.cell_count, page.cell_start,
            page.entry_photon);
  build.context.finish();  // cell_count is released here
}

void gather_entries(Build& build, MapPage& page) {
  Context& context = build.context;
  const SceneNeeds& needs = build.grid.needs;
  page.entry_stride = page.entry_count + entry_padding;
  page.entry_position = context.allocate<float>(3 * page.entry_stride, "photon map positions");
  page.entry_flux = context.allocate<float>(3 * page.entry_stride, "photon map flux");
  // Vector loads reach into the padding; what they find there is masked, but must be a number.
  context.fill(page.entry_position, 0.0f);
  context.fill(page.entry_flux, 0.0f);
  Defines defines;
  if (needs.light_count > 1) {
    defines.set("MULTIPLE_LIGHTS");
    page.entry_light = context.allocate<std::uint16_t>(page.entry_count, "photon map lights");
  }
  if (needs.glossy) {
    defines.set("GLOSSY");
    page.entry_incoming = context.allocate<float>(3 * page.entry_stride, "photon map directions");
  }
  const device::Kernel kernel = context.kernel("grid/gather_entries.cl", "gather_entries", defines);
  for (const PhotonPage& photons : build.photon_pages) {
    const auto launch = [&](const auto&... optional) {
      context.run(kernel, page.entry_count, work_group_size, page.entry_count, page.entry_stride,
                  page.entry_photon, photons.first_photon, photons.count, photons.position,
                  photons.flux, page.entry_position, page.entry_flux, optional...);
    };
    if (needs.light_count > 1 && needs.glossy) {
      launch(photons.light, page.entry_light, photons.incoming, page.entry_incoming);
    } else if (needs.light_count > 1) {
      launch(photons.light, page.entry_light);
    } else if (needs.glossy) {
      launch(photons.incoming, page.entry_incoming);
    } else {
      launch();
    }
  }
}

void upload_photons(Build& build, const CandidateMaps& candidates, const Photons& photons,
                    Progress& progress) {
  const std::uint64_t max_bytes = build.context.info().max_allocation_bytes;
  for (const PhotonRange range : plan_photon_pages(photons, candidates, max_bytes)) {
    progress.throw_if_cancelled();
    build.photon_pages.push_back(upload_photon_page(build.context, photons, candidates, range));
  }
}

}  // namespace

std::uint64_t MapPage::device_bytes() const {
  return grids.bytes() + cell_start.bytes() + entry_photon.bytes() + entry_position.bytes() +
         entry_flux.bytes() + entry_light.bytes() + entry_incoming.bytes();
}

void build_uniform_grid(UniformGrid& grid, const Scene& scene, const Photons& photons,
                        const NeighbourGroups& groups, Progress& progress) {
  Context& context = grid.device->context();
  const std::uint64_t max_bytes = context.info().max_allocation_bytes;
  Build build{context, grid, {}, {}, 0, static_cast<float>(grid.parameters.radius)};
  const float reach = reach_of(scene, grid.parameters.radius);
  build.squared_reach = reach * reach;
  const std::vector<float> corners = corner_coordinates(scene);
  build.corners = context.upload(std::span<const float>(corners), "triangle corners");
  upload_photons(build, find_candidate_maps(scene, photons, groups, reach), photons, progress);

  const std::size_t map_total = 2 * scene.triangle_count();
  auto map_count = context.allocate<std::uint32_t>(map_total, "photons per map");
  const std::vector<std::uint32_t> counts = count_photons(build, map_total, map_count);

  PhotonMapStatistics& statistics = grid.statistics;
  for (const MapRange range : plan_map_pages(counts, max_bytes)) {
    progress.throw_if_cancelled();
    MapPage page;
    page.first_map = range.first;
    page.last_map = range.last;
    page.entry_count = static_cast<std::uint32_t>(range.entries);
    size_grids(build, page, map_count);
    fill_cells(build, page);
    gather_entries(build, page);
    context.finish();
    statistics.references += range.entries;
    statistics.cells += page.cell_count;
    statistics.device_bytes += page.device_bytes();
    grid.pages.push_back(std::move(page));
    progress.advance(range.entries);
  }
  statistics.photons = photons.size();
  statistics.pages = grid.pages.size();
  statistics.maps = static_cast<std::uint64_t>(
      std::count_if(counts.begin(), counts.end(), [](std::uint32_t count) { return count > 0; }));
  statistics.largest_map = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
}

}  // namespace photile::maps
