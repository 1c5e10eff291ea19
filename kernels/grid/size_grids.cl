// Build, step 2: the frame and the number of cells of each map's grid.

#include "photile/device/grid.h"
#include "shared/vectors.clh"

// Cells of a grid at most, per side: a bound for needle triangles.
#ifndef MAX_CELLS_PER_SIDE
#define MAX_CELLS_PER_SIDE 8192
#endif

// One work-item per map of a page.
//   first_map        sided triangle of the page's first map
//   map_count        photons per sided triangle, from count_photons
//   radius           metres
//   photons_per_cell aimed at
// After: grids[i] is complete but for first_cell; cell_total[i] = columns * rows, 0 without photons.
//
// The u axis follows the longest edge, so that the rectangle around the triangle is at most twice
// its area. The cell size aims at photons_per_cell over the triangle grown by the radius (its
// Minkowski sum with a disc), which is where photons of the map can be.
__kernel void size_grids(uint map_total, uint first_map, __global const float* corners,
                         __global const uint* map_count, float radius, float photons_per_cell,
                         __global PhotileGrid* grids, __global uint* cell_total) {
  for (uint i = get_global_id(0); i < map_total; i += get_global_size(0)) {
    const uint map = first_map + i;
    const uint count = map_count[map];
    PhotileGrid grid = {0};
    cell_total[i] = 0;
    if (count == 0) {
      grids[i] = grid;
      continue;
    }

    float3 a = vload3(3 * (map >> 1), corners);
    float3 b = vload3(3 * (map >> 1) + 1, corners);
    float3 c = vload3(3 * (map >> 1) + 2, corners);
    const float ab2 = squared_length(b - a);
    const float bc2 = squared_length(c - b);
    const float ca2 = squared_length(a - c);
    if (bc2 > ab2 && bc2 >= ca2) {  // rotate so that ab is the longest edge
      const float3 first = a;
      a = b;
      b = c;
      c = first;
    } else if (ca2 > ab2) {
      const float3 last = c;
      c = b;
      b = a;
      a = last;
    }
    const float length_ab = sqrt(squared_length(b - a));
    const float3 u_axis = (b - a) / length_ab;
    const float along = dot3(c - a, u_axis);
    const float3 across = (c - a) - u_axis * along;
    const float height = sqrt(squared_length(across));
    // Needles: any axis perpendicular to u serves, for the triangle has no height.
    const float3 helper = fabs(u_axis.x) < 0.6f ? (float3)(1, 0, 0) : (float3)(0, 1, 0);
    const float3 perpendicular = cross3(u_axis, helper);
    const float3 v_axis = height > 1e-5f * length_ab
                              ? across / height
                              : perpendicular / sqrt(squared_length(perpendicular));

    const float width_u = length_ab + 2.0f * radius;
    const float width_v = height + 2.0f * radius;
    const float perimeter = length_ab + sqrt(squared_length(c - b)) + sqrt(squared_length(a - c));
    const float area = 0.5f * length_ab * height + perimeter * radius +
                       3.14159265f * radius * radius;
    const float cell_size =
        fmax(sqrt(area * photons_per_cell / (float)count),
             fmax(width_u, width_v) / (float)(MAX_CELLS_PER_SIDE - 1));

    grid.origin_x = a.x;
    grid.origin_y = a.y;
    grid.origin_z = a.z;
    grid.u_axis_x = u_axis.x;
    grid.u_axis_y = u_axis.y;
    grid.u_axis_z = u_axis.z;
    grid.v_axis_x = v_axis.x;
    grid.v_axis_y = v_axis.y;
    grid.v_axis_z = v_axis.z;
    grid.minimum_u = -radius;
    grid.minimum_v = -radius;
    grid.cell_size = cell_size;
    grid.inverse_cell_size = 1.0f / cell_size;
    grid.slack = 16.0f * FLT_EPSILON * (width_u + width_v);
    grid.columns = (uint)ceil(width_u / cell_size);
    grid.rows = (uint)ceil(width_v / cell_size);
    grids[i] = grid;
    cell_total[i] = grid.columns * grid.rows;
  }
}

// One work-item per map. Before: first_cell holds the exclusive scan of cell_total.
__kernel void place_grids(uint map_total, __global const uint* first_cell,
                          __global PhotileGrid* grids) {
  for (uint i = get_global_id(0); i < map_total; i += get_global_size(0)) {
    grids[i].first_cell = first_cell[i];
  }
}
