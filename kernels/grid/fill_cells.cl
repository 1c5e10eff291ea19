// Build, steps 3 and 5: count the photons of each cell, then scatter references to them.

#include "grid/entry.clh"

// Symbols of the program:
//   TILE   the page holds a tile of one map; its bounds are further arguments of both kernels

#ifdef TILE
#include "grid/tile.clh"
#define TILE_PARAMETERS , TILE_ARGUMENTS
#else
#define TILE_PARAMETERS
#endif

// One array, cell_start, is at first the photons of each cell and in the end the starts of the
// cells: what belongs to cell c is kept at c + 1. Scanned, that is where c starts; scattering moves
// it to where c ends, which is where the next cell starts.

// Arguments of both kernels, besides:
//   first_map, last_map   the maps of the page
//   grids                 one per map of the page

// One work-item per photon. Before: cell_start is zero. After: photons per cell.
__kernel void count_cells(ENTERED_CANDIDATES, uint first_map, uint last_map,
                          __global const PhotileGrid* grids,
                          __global uint* cell_start TILE_PARAMETERS) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    for (FOR_EACH_ENTERED(i)) {
      const uint map = list_members[m];
      if (map < first_map || map >= last_map) continue;
      __global const PhotileGrid* grid = &grids[map - first_map];
      int2 cell = cell_of(project(photon, grid), grid);
#ifdef TILE
      if (!counted_cell(&cell, TILE_BOUNDS)) continue;
#endif
      atomic_inc(&cell_start[cell_index(cell, grid) + 1u]);
    }
  }
}

#ifdef TILE
// One work-item per row of the tile, in both kernels.

// After: what gaps stand for is taken modulo the widest vector.
__kernel void narrow_gaps(__global const PhotileGrid* grid, __global uint* cell_start,
                          TILE_ARGUMENTS) {
  const uint gap = gap_column(TILE_BOUNDS);
  if (gap >= grid->columns) return;  // the tile is as wide as the grid
  for (uint row = first_row + get_global_id(0); row < last_row; row += get_global_size(0)) {
    cell_start[cell_index((int2)((int)gap, (int)row), grid) + 1u] %= WIDEST_VECTOR;
  }
}

// Before: cell_start is scanned. After: gaps end where the next cell starts, though nothing is
// scattered to them.
__kernel void skip_gaps(__global const PhotileGrid* grid, __global uint* cell_start,
                        TILE_ARGUMENTS) {
  const uint gap = gap_column(TILE_BOUNDS);
  if (gap >= grid->columns) return;
  for (uint row = first_row + get_global_id(0); row < last_row; row += get_global_size(0)) {
    const uint cell = cell_index((int2)((int)gap, (int)row), grid);
    cell_start[cell + 1u] = cell_start[cell + 2u];
  }
}
#endif

// One work-item per photon. Before: cell_start is the exclusive scan of what count_cells left.
//   first_photon   index of the page's first photon among all photons
// After: entry_photon holds the photons of each cell in the order in which work-items came
// (sort_cells makes it stable); once all pages are scattered, cell_start[c] is where cell c starts.
__kernel void scatter(ENTERED_CANDIDATES, uint first_map, uint last_map,
                      __global const PhotileGrid* grids, __global uint* cell_start,
                      uint first_photon, __global uint* entry_photon TILE_PARAMETERS) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    for (FOR_EACH_ENTERED(i)) {
      const uint map = list_members[m];
      if (map < first_map || map >= last_map) continue;
      __global const PhotileGrid* grid = &grids[map - first_map];
      const int2 place = cell_of(project(photon, grid), grid);
#ifdef TILE
      if (!in_tile(place, TILE_BOUNDS)) continue;
#endif
      entry_photon[atomic_inc(&cell_start[cell_index(place, grid) + 1u])] = first_photon + i;
    }
  }
}
