/* A uniform grid in space whose cells are kept in a hash table, as C++ and OpenCL C both see it. */
#ifndef PHOTILE_DEVICE_HASHED_GRID_H
#define PHOTILE_DEVICE_HASHED_GRID_H

/* Cells are cubes; a point p lies in cell floor((p - low) * inverse_cell_side), per axis. Those of
   one hash share a bucket. */
typedef struct {
  float low_x, low_y, low_z; /* of the photons' box */
  float high_x, high_y, high_z;
  float cell_side, inverse_cell_side; /* metres, and its inverse */
  unsigned int mask;                  /* the number of buckets, a power of two, less one */
} PhotileHashedGrid;

#endif
