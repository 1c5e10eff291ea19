// How the photons of one map spread over its grid, to cut it into tiles.

#include "grid/entry.clh"

// One work-item per photon.
//   photon_count ... squared_reach   as in count_photons
//   map, grid               that photons are counted of; one grid
//   bin_width, bin_height   cells of a bin
//   columns                 of bins
// Before: bin_count is zero, or holds the photons of other pages. After: photons per bin.
__kernel void count_bins(uint photon_count, __global const float* position,
                         __global const uint* own_map, __global const uint* list,
                         __global const uint* list_offsets, __global const uint* list_members,
                         __global const PhotileMapShape* shapes, __global const float* corners,
                         float squared_reach, uint map, __global const PhotileGrid* grid,
                         uint bin_width, uint bin_height, uint columns, __global uint* bin_count) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    const uint end = list_offsets[list[i] + 1];
    for (uint m = list_offsets[list[i]]; m < end; ++m) {
      if (list_members[m] != map) continue;
      if (!enters_map(photon, own_map[i], map, shapes, corners, squared_reach)) continue;
      const int2 cell = cell_of(project(photon, grid), grid);
      atomic_inc(&bin_count[(uint)cell.y / bin_height * columns + (uint)cell.x / bin_width]);
    }
  }
}
