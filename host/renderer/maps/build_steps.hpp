// The steps of the build on the device: each launches kernels over pages of photons.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "device/context.hpp"
#include "device/launch.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "maps/photon_pages.hpp"
#include "photile/device/build.h"
#include "photile/device/map_shape.h"

namespace photile::maps {

/// The kernels that build the maps of `store`, specialised by what its scene needs, by whether its
/// maps serve several triangles (`patches`), and by whether work-items work in groups
/// (works_in_groups).
device::KernelSet build_kernels(const MapStore& store, bool patches);

/// Per map: the number of its photons, and whether their normals may disagree with its triangles'.
struct MapCounts {
  device::Buffer<std::uint32_t> photons, normal_filtered;  ///< `normal_filtered` only with patches
};

/// The data that every step needs.
struct Build {
  device::Context& context;
  const MapStore& store;
  device::KernelSet kernels;
  bool patches;         ///< maps may be of several triangles
  float squared_reach;  ///< square metres: photons within it of a triangle enter its map
  float radius;         ///< metres, of the search
  device::Buffer<std::uint32_t> map_of = {};    ///< per oriented face
  device::Buffer<float> normals = {};           ///< 3 per oriented face; only with patches
  device::Buffer<PhotileMapShape> shapes = {};  ///< per pair of maps
  device::Buffer<float> density_ratio = {};     ///< per map
  device::Buffer<float> corners = {};           ///< 9 floats per triangle that is alone in its maps
  std::unique_ptr<PhotonPages> photon_pages = {};
  MapCounts counts = {};
};

// Errors: DeviceMemoryError, after which a step may be taken again on smaller pages.

/// Fills page.inserted.
void find_insertions(const Build& build, PhotonPage& page);

/// Counts the photons of `map_count` maps: build.counts.
void count_photons(Build& build, std::size_t map_count);

/// The whole content of a buffer.
std::vector<std::uint32_t> read_all(device::Context& context,
                                    const device::Buffer<std::uint32_t>& buffer);

/// Grids and cells of the page's maps, whose photons are counted.
void lay_out_grids(const Build& build, MapPage& page);

/// References to the photons of the page's cells: cell_start, record_count and record_photon.
void fill_cells(const Build& build, MapPage& page);

/// Brings the photons of each of page.cell_count cells into ascending order. `kernels`: of a
/// program that holds grid/sort_cells.cl.
void sort_cells(const device::KernelSet& kernels, const MapPage& page);

/// Releases photons on the host, once their one page has released them.
struct PhotonRelease {
  std::function<void()> lists;    ///< of candidate maps
  std::function<void()> records;  ///< all that records copy, except the photons' triangles
};

/// How records are gathered.
struct RecordCopying {
  /// 3 floats per oriented face, where the records keep normals; else null.
  const device::Buffer<float>* normals = nullptr;
  /// Called as soon as no kernel reads what it releases, where photons are one page; null: photons
  /// are needed for further pages of maps.
  const PhotonRelease* release = nullptr;
  device::MemoryPages memory = device::MemoryPages::large;
};

/// The pages of memory of a store's maps.
inline device::MemoryPages memory_pages(const MapStore& store) {
  return store.parameters.large_pages ? device::MemoryPages::large : device::MemoryPages::ordinary;
}

/// `build`: see build_kernels. Before: page.record_count and page.record_photon are set. After: the
/// other record buffers that the scene needs are filled.
void copy_records(const device::KernelSet& build, const SceneNeeds& needs,
                  PhotonPages& photon_pages, const RecordCopying& gathering, MapPage& page);

// Exclusive prefix sum on the device.

/// Replaces `values` by their exclusive prefix sum. `kernels`: of a program that holds
/// shared/scan.cl. With a zero appended by the caller, the last element becomes the total. Sums
/// must stay below 2^32.
void exclusive_prefix_sum(const device::KernelSet& kernels, device::Buffer<std::uint32_t>& values);

/// The exclusive prefix sum, into another buffer of the same size.
void exclusive_prefix_sum(const device::KernelSet& kernels,
                          const device::Buffer<std::uint32_t>& values,
                          device::Buffer<std::uint32_t>& scanned);

}  // namespace photile::maps
