// What pages that hold a tile of a map need in place of their kernels in build.cl, with TILE: a
// program of its own, since few scenes need it.

#include "grid/count_bins.cl"
#include "grid/fill_cells.cl"
#include "grid/gaps.cl"
