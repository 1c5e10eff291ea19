// What the uniform grid is compared with, each by its name: other ways to find the k nearest
// photons. docs/kernels/structures.md says how to add one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/context.hpp"
#include "photile/device/grid.h"
#include "photile/photon_maps.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::structures {

/// The photons that a structure is built over, list by list: those of each map of a page, or in
/// one list all that there are.
struct PhotonLists {
  device::Context& context;
  const Photons& photons;
  float radius;  ///< metres: no search goes farther
  /// Indices of photons, ascending in each list.
  std::vector<std::uint32_t> members;
  std::vector<std::uint32_t> first;      ///< per list among `members`, and the end of the last
  std::vector<PhotileGrid> planes = {};  ///< per list that of its map; empty for one list of all
  /// Of those grids: the members in the order of their cells, and per cell where its first is.
  std::vector<std::uint32_t> in_cells = {}, cell_start = {};

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t list) const {
    return std::span(members).subspan(first[list], first[list + 1] - first[list]);
  }
};

/// The lists in a structure, on the device. What a structure does not have is empty.
struct Index {
  /// Indices of photons, in the order in which the structure keeps them: its records. Those of a
  /// list stay where they were among all members.
  device::Buffer<std::uint32_t> record_photon = {};
  device::Buffer<std::uint32_t> root = {};   ///< per list: its first node; none without photons
  device::Buffer<std::uint32_t> nodes = {};  ///< words, as the structure's kernel reads them
  device::Buffer<std::uint32_t> cell_start =
      {};  ///< per cell its first record, and the end of the last
};

/// A way to find the k nearest photons. All find the same.
struct Structure {
  std::string name;  ///< of options and of rows
  /// Builds it over lists of photons. Null: grids, which the library builds and queries.
  Index (*build)(const PhotonLists& lists) = nullptr;
  /// One for all photons, filtered by normal, in place of one for each map.
  bool global = false;
  std::string kernel = {};  ///< kernels/structures/KERNEL.cl; "": NAME, with _ for -
  std::string symbol = {};  ///< that the kernel is compiled with
  long long symbol_value = 1;
  /// Of kernels that select as the grid's do, by estimate_by_radix: words that a work-item writes
  /// for itself. 0: estimate_by_list.
  std::uint32_t words_per_item = 0;
  float photons_per_cell = 0;  ///< of grids; 0: as asked

  /// Whether the library's kernels query it.
  bool is_grid() const { return build == nullptr; }
  std::string kernel_file() const;
};

/// All that are registered, by their names.
std::span<const Structure> all();

/// Errors: UsageError where there is none of the name.
const Structure& named(std::string_view name);

/// Registers a structure; a constant of its source.
struct Registration {
  explicit Registration(Structure structure);
};

/// Photon maps in the structure; estimators query them as those of the library. Errors: those of
/// PhotonMaps; UsageError for a global one with naive groups; DeviceError where all photons do not
/// fit in one buffer of the device.
PhotonMaps build(const Structure& structure, Device& device, const Scene& scene,
                 const Photons& photons, const NeighbourGroups& groups,
                 const PhotonMapParameters& parameters);

/// Photons and points without a scene, each on an oriented face of its own.
struct Points {
  const Photons& photons;
  std::span<const glm::vec3> normals;  ///< per oriented face: of photons and of points
  double angle_degrees;                ///< largest between the normals of neighbours
};

/// A global structure over photons without a scene. Errors: as build.
PhotonMaps build_over(const Structure& structure, Device& device, const Points& points,
                      double radius);

}  // namespace photile::structures
