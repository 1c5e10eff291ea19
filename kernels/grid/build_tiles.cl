// What pages that hold a tile of a map need in place of their kernels in build.cl: a program of its
// own, since few scenes need it.

#define TILE
#include "grid/count_bins.cl"
#include "grid/fill_cells.cl"
