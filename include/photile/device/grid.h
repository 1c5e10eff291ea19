/* The uniform grid of one photon map, as C++ and OpenCL C both see it. Scalar members only: a
   float3 is 16 bytes on the device. The size is asserted in host/renderer/maps/map_page.hpp and
   compared with the device's in tests/device. */
#ifndef PHOTILE_DEVICE_GRID_H
#define PHOTILE_DEVICE_GRID_H

#include "photile/device/constants.h"

/* Grid over the plane of a triangle or patch. A point p projects to
     u = (p - origin) . u_axis,  v = (p - origin) . v_axis      (metres)
   and falls in column (u - minimum_u) / cell_width and row (v - minimum_v) / cell_height, clamped
   to the grid. Cells are PHOTILE_CELL_ASPECT times as high as wide: a query that reads the cells of
   a disc streams a few long ranges, which extend little beyond the disc at their ends.

       v ^   rows
         |  +--+--+--+--+
         |  |  |  |  |  |      cells in row-major order, first_cell + row * columns + column;
         |  +--+--+--+--+      their records are contiguous, so the cells
         |  |  |  |  |  |      [column0, column1] of a row are one range of records
         |  +--+--+--+--+
   minimum ----------------> u   columns

   The grid covers the surface's rectangle grown by the radius. A map without photons has no
   columns. */
typedef struct {
  float origin_x, origin_y, origin_z;
  float u_axis_x, u_axis_y, u_axis_z;
  float v_axis_x, v_axis_y, v_axis_z;
  float minimum_u, minimum_v;
  float cell_width, cell_height;
  float inverse_cell_width, inverse_cell_height;
  float slack; /* how far rounding may move a projected point across a cell border, metres */
  unsigned int columns, rows;
  unsigned int first_cell; /* into cell_start of the map's page */
  unsigned int
      normal_filtered; /* 1 if the normal of a photon may disagree with a triangle of the map */
} PhotileGrid;

#endif
