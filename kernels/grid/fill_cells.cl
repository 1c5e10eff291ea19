// Build, steps 3 and 5: count the photons of each cell, then scatter references to them.
//
// One array, cell_start, is at first the photons of each cell and in the end the starts of the
// cells: what belongs to cell c is kept at c + 1. Scanned, that is where c starts; scattering moves
// it to where c ends, which is where the next cell starts.

#include "grid/cell.clh"
#include "grid/entry.clh"

// Arguments of both kernels, besides members of EnteringPhotons:
//   maps    of the page
//   grids   one per map of the page

// One work-item per photon. Before: cell_start is zero. After: photons per cell.
__kernel void count_cells(const PhotilePhotonPage page, const PhotileMapRange maps,
                          __global const float* position, __global const uint* oriented_face,
                          __global const uint* map_of, __global const uint* list,
                          __global const uint* list_offsets, __global const uint* list_members,
                          __global const PhotileMapShape* shapes, __global const float* corners,
                          __global const uint* entered, __global const PhotileGrid* grids,
                          __global uint* cell_start) {
  const EnteringPhotons photons = {position,        oriented_face,    map_of,       list,
                                   page.first_list, list_offsets,      list_members, shapes,
                                   corners,         page.squared_reach};
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    EnteringPhoton photon;
    load_photon(&photons, i, entered[i], &photon);
    for (uint m = next_entered(&photons, &photon, photon.first); m < photon.end;
         m = next_entered(&photons, &photon, m + 1u)) {
      const uint map = list_members[m];
      if (map < maps.first_map || map >= maps.last_map) continue;
      __global const PhotileGrid* grid = &grids[map - maps.first_map];
      const int2 cell = cell_of(project(photon.position, grid), grid);
      atomic_inc(&cell_start[cell_index(cell, grid) + 1u]);
    }
  }
}

// One work-item per photon. Before: cell_start is the exclusive scan of what count_cells left.
// After: entry_photon holds the photons of each cell in the order in which work-items came
// (sort_cells makes it stable); once all pages are scattered, cell_start[c] is where cell c starts.
__kernel void scatter(const PhotilePhotonPage page, const PhotileMapRange maps,
                      __global const float* position, __global const uint* oriented_face,
                      __global const uint* map_of, __global const uint* list,
                      __global const uint* list_offsets, __global const uint* list_members,
                      __global const PhotileMapShape* shapes, __global const float* corners,
                      __global const uint* entered, __global const PhotileGrid* grids,
                      __global uint* cell_start, __global uint* entry_photon) {
  const EnteringPhotons photons = {position,        oriented_face,    map_of,       list,
                                   page.first_list, list_offsets,      list_members, shapes,
                                   corners,         page.squared_reach};
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    EnteringPhoton photon;
    load_photon(&photons, i, entered[i], &photon);
    for (uint m = next_entered(&photons, &photon, photon.first); m < photon.end;
         m = next_entered(&photons, &photon, m + 1u)) {
      const uint map = list_members[m];
      if (map < maps.first_map || map >= maps.last_map) continue;
      __global const PhotileGrid* grid = &grids[map - maps.first_map];
      const int2 cell = cell_of(project(photon.position, grid), grid);
      const uint entry = atomic_inc(&cell_start[cell_index(cell, grid) + 1u]);
      entry_photon[entry] = page.first_photon + i;
    }
  }
}
