// The build of a hashed grid: photons are counted in buckets, the counts scanned, references
// scattered to their buckets and brought into ascending order there (sort_cells), so that their
// order does not depend on that of the work-items. As in grid/fill_cells.cl, what belongs to bucket
// b is kept at b + 1: scanned, that is where b starts, and scattering moves it to where b ends.

#include "grid/sort_cells.cl"
#include "shared/scan.cl"
#include "structures/hashed_cells.clh"

// One work-item per photon, in both kernels.
//   position   3 floats per photon

// Before: cell_start is zero. After: photons per bucket.
__kernel void count_buckets(uint photon_count, __global const float* restrict position,
                            __global const PhotileHashedGrid* restrict grid,
                            __global uint* restrict cell_start) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const uint bucket = bucket_of(grid, hashed_cell_of(grid, vload3(i, position)));
    atomic_inc(&cell_start[bucket + 1u]);
  }
}

// Before: cell_start is scanned.
__kernel void fill_buckets(uint photon_count, __global const float* restrict position,
                           __global const PhotileHashedGrid* restrict grid,
                           __global uint* restrict cell_start,
                           __global uint* restrict record_photon) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const uint bucket = bucket_of(grid, hashed_cell_of(grid, vload3(i, position)));
    record_photon[atomic_inc(&cell_start[bucket + 1u])] = i;
  }
}
