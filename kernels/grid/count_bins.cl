// How the photons of one map spread over its grid, to cut it into tiles.

#include "grid/cell.clh"
#include "grid/entry.clh"

// One work-item per photon; arguments as members of EnteringPhotons, and:
//   map, grid               that photons are counted of; one grid
//   bin_width, bin_height   cells of a bin
//   columns                 of bins
// Before: bin_count is zero, or holds the photons of other pages. After: photons per bin.
__kernel void count_bins(const PhotilePhotonPage page, __global const float* position,
                         __global const uint* sided_triangle, __global const uint* map_of,
                         __global const uint* list, __global const uint* list_offsets,
                         __global const uint* list_members, __global const PhotileMapShape* shapes,
                         __global const float* corners, __global const uint* entered, uint map,
                         __global const PhotileGrid* grid, uint bin_width, uint bin_height,
                         uint columns, __global uint* bin_count) {
  const EnteringPhotons photons = {position,        sided_triangle,    map_of,       list,
                                   page.first_list, list_offsets,      list_members, shapes,
                                   corners,         page.squared_reach};
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    EnteringPhoton photon;
    load_photon(&photons, i, entered[i], &photon);
    for (uint m = next_entered(&photons, &photon, photon.first); m < photon.end;
         m = next_entered(&photons, &photon, m + 1u)) {
      if (list_members[m] != map) continue;
      const int2 cell = cell_of(project(photon.position, grid), grid);
      atomic_inc(&bin_count[(uint)cell.y / bin_height * columns + (uint)cell.x / bin_width]);
    }
  }
}
