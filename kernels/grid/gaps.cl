// The cells of a page that stand for the photons beside its tile: see grid/tile.clh.

#include "grid/cell.clh"
#include "grid/tile.clh"

// One work-item per row of the tile, in both kernels; `grid` is that of the page.

// After: what gaps stand for is taken modulo the widest vector.
__kernel void narrow_gaps(const PhotileMapRange tile, __global const PhotileGrid* grid,
                          __global uint* cell_start) {
  const uint gap = gap_column(&tile);
  if (gap >= grid->columns) return;  // the tile is as wide as the grid
  for (uint row = tile.first_row + get_global_id(0); row < tile.last_row;
       row += get_global_size(0)) {
    cell_start[cell_index((int2)((int)gap, (int)row), grid) + 1u] %= WIDEST_VECTOR;
  }
}

// Before: cell_start is scanned. After: gaps end where the next cell starts, though nothing is
// scattered to them.
__kernel void skip_gaps(const PhotileMapRange tile, __global const PhotileGrid* grid,
                        __global uint* cell_start) {
  const uint gap = gap_column(&tile);
  if (gap >= grid->columns) return;
  for (uint row = tile.first_row + get_global_id(0); row < tile.last_row;
       row += get_global_size(0)) {
    const uint cell = cell_index((int2)((int)gap, (int)row), grid);
    cell_start[cell + 1u] = cell_start[cell + 2u];
  }
}
