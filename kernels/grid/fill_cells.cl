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

// Arguments of both kernels:
//   photon_count ... squared_reach   as in count_photons
//   first_map, last_map   the maps of the page
//   grids                 one per map of the page

// One work-item per photon. Before: cell_count is zero. After: photons per cell.
__kernel void count_cells(uint photon_count, __global const float* position,
                          __global const uint* own_map, __global const uint* list,
                          __global const uint* list_offsets, __global const uint* list_members,
                          __global const PhotileMapShape* shapes, __global const float* corners,
                          float squared_reach, uint first_map, uint last_map,
                          __global const PhotileGrid* grids,
                          __global uint* cell_count TILE_PARAMETERS) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    const uint own = own_map[i];
    const uint end = list_offsets[list[i] + 1];
    for (uint m = list_offsets[list[i]]; m < end; ++m) {
      const uint map = list_members[m];
      if (map < first_map || map >= last_map) continue;
      if (!enters_map(photon, own, map, shapes, corners, squared_reach)) continue;
      __global const PhotileGrid* grid = &grids[map - first_map];
      int2 cell = cell_of(project(photon, grid), grid);
#ifdef TILE
      if (!counted_cell(&cell, TILE_BOUNDS)) continue;
#endif
      atomic_inc(&cell_count[cell_index(cell, grid)]);
    }
  }
}

#ifdef TILE
// One work-item per row of the tile. After: what gaps stand for is taken modulo the widest vector.
__kernel void narrow_gaps(__global const PhotileGrid* grid, __global uint* cell_count,
                          TILE_ARGUMENTS) {
  const uint gap = gap_column(TILE_BOUNDS);
  if (gap >= grid->columns) return;  // the tile is as wide as the grid
  for (uint row = first_row + get_global_id(0); row < last_row; row += get_global_size(0)) {
    cell_count[cell_index((int2)((int)gap, (int)row), grid)] %= WIDEST_VECTOR;
  }
}
#endif

// One work-item per photon. Before: cell_start is the exclusive scan of cell_count.
//   first_photon   index of the page's first photon among all photons
// After: entry_photon holds the photons of each cell in the order in which work-items came
// (sort_cells makes it stable); cell_count is zero again, but for gaps.
__kernel void scatter(uint photon_count, __global const float* position,
                      __global const uint* own_map, __global const uint* list,
                      __global const uint* list_offsets, __global const uint* list_members,
                      __global const PhotileMapShape* shapes, __global const float* corners,
                      float squared_reach, uint first_map, uint last_map,
                      __global const PhotileGrid* grids, __global const uint* cell_start,
                      __global uint* cell_count, uint first_photon,
                      __global uint* entry_photon TILE_PARAMETERS) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    const uint own = own_map[i];
    const uint end = list_offsets[list[i] + 1];
    for (uint m = list_offsets[list[i]]; m < end; ++m) {
      const uint map = list_members[m];
      if (map < first_map || map >= last_map) continue;
      if (!enters_map(photon, own, map, shapes, corners, squared_reach)) continue;
      __global const PhotileGrid* grid = &grids[map - first_map];
      const int2 place = cell_of(project(photon, grid), grid);
#ifdef TILE
      if (!in_tile(place, TILE_BOUNDS)) continue;
#endif
      const uint cell = cell_index(place, grid);
      const uint slot = cell_start[cell] + atomic_dec(&cell_count[cell]) - 1u;
      entry_photon[slot] = first_photon + i;
    }
  }
}
