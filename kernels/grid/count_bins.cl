// How the photons of one map spread over its grid, to cut it into tiles.

#include "grid/entry.clh"

// One work-item per photon.
//   map, grid               that photons are counted of; one grid
//   bin_width, bin_height   cells of a bin
//   columns                 of bins
// Before: bin_count is zero, or holds the photons of other pages. After: photons per bin.
__kernel void count_bins(ENTERED_CANDIDATES, uint map, __global const PhotileGrid* grid,
                         uint bin_width, uint bin_height, uint columns, __global uint* bin_count) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    for (FOR_EACH_ENTERED(i)) {
      if (list_members[m] != map) continue;
      const int2 cell = cell_of(project(photon, grid), grid);
      atomic_inc(&bin_count[(uint)cell.y / bin_height * columns + (uint)cell.x / bin_width]);
    }
  }
}
