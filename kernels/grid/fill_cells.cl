// Build, steps 3 and 5: count the photons of each cell, then scatter references to them.
//
// One array, cell_start, first holds the number of photons of each cell, and in the end the starts
// of the cells: what belongs to cell c is kept at c + 1. Scanned, that is where c starts;
// scattering moves it to where c ends, which is where the next cell starts.

#include "grid/cell.clh"
#include "grid/insertion.clh"

// Arguments of both kernels, besides the photons:
//   maps    of the page
//   grids   one per map of the page

// One work-item per photon. Before: cell_start is zero. After: photons per cell.
__kernel void count_cells(INSERTED_PHOTONS_ARGUMENTS, const PhotileMapRange maps,
                          __global const uint* restrict inserted,
                          __global const PhotileGrid* restrict grids,
                          __global uint* restrict cell_start) {
  const InsertedPhotons photons = INSERTED_PHOTONS;
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    InsertedPhoton photon;
    load_photon(&photons, i, inserted[i], &photon);
    for (uint m = next_insertion(&photons, &photon, photon.first); m < photon.end;
         m = next_insertion(&photons, &photon, m + 1u)) {
      const uint map = list_members[m];
      if (map < maps.first_map || map >= maps.last_map) continue;
      __global const PhotileGrid* grid = &grids[map - maps.first_map];
      const int2 cell = cell_of(project(photon.position, grid), grid);
      atomic_inc(&cell_start[cell_index(cell, grid) + 1u]);
    }
  }
}

// One work-item per photon. Before: cell_start is the exclusive scan of what count_cells left.
// After: record_photon holds the photons of each cell in the order in which work-items came
// (sort_cells makes it stable); once all pages are scattered, cell_start[c] is where cell c starts.
__kernel void scatter(INSERTED_PHOTONS_ARGUMENTS, const PhotileMapRange maps,
                      __global const uint* restrict inserted,
                      __global const PhotileGrid* restrict grids,
                      __global uint* restrict cell_start, __global uint* restrict record_photon) {
  const InsertedPhotons photons = INSERTED_PHOTONS;
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    InsertedPhoton photon;
    load_photon(&photons, i, inserted[i], &photon);
    for (uint m = next_insertion(&photons, &photon, photon.first); m < photon.end;
         m = next_insertion(&photons, &photon, m + 1u)) {
      const uint map = list_members[m];
      if (map < maps.first_map || map >= maps.last_map) continue;
      __global const PhotileGrid* grid = &grids[map - maps.first_map];
      const int2 cell = cell_of(project(photon.position, grid), grid);
      const uint record = atomic_inc(&cell_start[cell_index(cell, grid) + 1u]);
      record_photon[record] = page.first_photon + i;
    }
  }
}
