// Build, step 2: the frame and the number of cells of each map's grid.

#include "photile/device/grid.h"
#include "photile/device/map_shape.h"
#include "shared/symbols.clh"

// Cells of a grid at most, per side: a bound for needle triangles.
#define MAX_CELLS_PER_SIDE 8192

// One work-item per map of a page.
//   first_map        the page's first map
//   shapes           one per pair of maps
//   map_count        photons per map, from count_photons
//   map_density_ratio     per map: density around a photon over the mean density of the surface
//   map_normal_filtered        per map, from count_photons; with PATCHES
//   radius           metres
//   photons_per_cell aimed at
// After: grids[i] is complete except for first_cell; cell_total[i] = columns * rows, 0 without
// photons.
//
// The cell size aims at photons_per_cell where photons are, on the surface grown by the radius (its
// Minkowski sum with a disc), which is where photons of the map can be.
__kernel void size_grids(uint map_total, uint first_map,
                         __global const PhotileMapShape* restrict shapes,
                         __global const uint* restrict map_count,
                         __global const float* restrict map_density_ratio,
                         __global const uint* restrict map_normal_filtered, float radius,
                         float photons_per_cell, __global PhotileGrid* restrict grids,
                         __global uint* restrict cell_total) {
  for (uint i = get_global_id(0); i < map_total; i += get_global_size(0)) {
    const uint map = first_map + i;
    const uint count = map_count[map];
    PhotileGrid grid = {0};
    cell_total[i] = 0;
    if (count == 0) {
      grids[i] = grid;
      continue;
    }
    __global const PhotileMapShape* shape = &shapes[map >> 1];
    const float width_u = shape->width_u + 2.0f * radius;
    const float width_v = shape->width_v + 2.0f * radius;
    const float area = shape->area + shape->perimeter * radius + 3.14159265f * radius * radius;
    // Infinite where the radius is near the root of the largest float; a map with photons must have
    // cells.
    const float cell_area =
        fmin(area * photons_per_cell / ((float)count * map_density_ratio[map]), FLT_MAX);
    const float cell_width = fmax(sqrt(cell_area / (float)PHOTILE_CELL_ASPECT),
                                  fmax(width_u, width_v) / (float)(MAX_CELLS_PER_SIDE - 1));
    const float cell_height = (float)PHOTILE_CELL_ASPECT * cell_width;

    grid.origin_x = shape->origin_x;
    grid.origin_y = shape->origin_y;
    grid.origin_z = shape->origin_z;
    grid.u_axis_x = shape->u_axis_x;
    grid.u_axis_y = shape->u_axis_y;
    grid.u_axis_z = shape->u_axis_z;
    grid.v_axis_x = shape->v_axis_x;
    grid.v_axis_y = shape->v_axis_y;
    grid.v_axis_z = shape->v_axis_z;
    grid.minimum_u = -radius;
    grid.minimum_v = -radius;
    grid.cell_width = cell_width;
    grid.cell_height = cell_height;
    grid.inverse_cell_width = 1.0f / cell_width;
    grid.inverse_cell_height = 1.0f / cell_height;
    grid.slack = 16.0f * FLT_EPSILON * (width_u + width_v);
    grid.columns = (uint)ceil(width_u / cell_width);
    grid.rows = (uint)ceil(width_v / cell_height);
    if (PATCHES) grid.normal_filtered = map_normal_filtered[map];
    grids[i] = grid;
    cell_total[i] = grid.columns * grid.rows;
  }
}

// One work-item per map. Before: first_cell holds the exclusive scan of cell_total.
__kernel void lay_out_grids(uint map_total, __global const uint* restrict first_cell,
                            __global PhotileGrid* restrict grids) {
  for (uint i = get_global_id(0); i < map_total; i += get_global_size(0)) {
    grids[i].first_cell = first_cell[i];
  }
}
