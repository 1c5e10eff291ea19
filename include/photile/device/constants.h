/* The numbers that host and kernels must agree on, as C++ and OpenCL C both see them. What only one
   side needs is defined there. */
#ifndef PHOTILE_DEVICE_CONSTANTS_H
#define PHOTILE_DEVICE_CONSTANTS_H

#define PHOTILE_PI 3.14159265358979f

/* Height of a grid's cells over their width: see photile/device/grid.h. */
#define PHOTILE_CELL_ASPECT 4

/* Photons of a cell that are sorted by insertion; cells of more are sorted by a group on GPUs
   (kernels/grid/sort_cells.cl). 16 to 64. */
#define PHOTILE_INSERTION_LIMIT 48

/* Work-items of the groups that scan and sort together (kernels/shared/scan.cl,
   kernels/grid/sort_cells.cl). */
#define PHOTILE_COOPERATIVE_GROUP 256

/* Floats of the widest vector, of a group whose work-items are lanes; records of photons are padded
   to it. */
#define PHOTILE_MOST_LANES 64

/* Reductions combine lanes that lie so far apart, then these columns. */
#define PHOTILE_LANE_COLUMNS 8

/* Smallest GGX alpha. Narrower lobes lose their peak to single precision and no density of photons
   would resolve them; smoother surfaces are mirrors. */
#define PHOTILE_MIN_GGX_ALPHA 0.02f

/* Pieces of surface in a leaf of the surface's tree, and children of a node. */
#define PHOTILE_SURFACE_WIDTH 8

/* Height of the slab around a hit's plane in which surface and photons count, over the radius: with
   0.1 thin curved shells go dark, without a slab plates a few centimetres below bleed through. */
#define PHOTILE_SLAB 0.2f

/* No path from the root of the surface's tree to a node is longer, and no stack of a traversal
   deeper. */
#define PHOTILE_SURFACE_STACK 160

/* Leaves of the surface's tree that wait for lanes: a power of two, at least 7 more than the widest
   group has lanes over eight. */
#define PHOTILE_LEAF_QUEUE 16

/* Kernels of the density estimate: values of the symbol DENSITY_KERNEL, which
   kernels/shared/density_kernel.clh explains. */
#define PHOTILE_CONSTANT_KERNEL 0
#define PHOTILE_CONE_KERNEL 1

#endif
