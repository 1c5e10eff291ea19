// The k nearest photons of each hit, as a list: for tests and inspection. The estimate itself needs
// no list.

#include "estimate/neighbourhood.clh"

// One work-item, or with LANES one group, per hit of one map page; arguments as in estimate.cl.
// After: neighbours[hit * k ...] holds photon indices in any order, 0xFFFFFFFF beyond the last;
// squared_radius[hit] is that of the estimate's disc.
__kernel GROUP_OF_LANES void nearest(
    uint hit_count, uint first_hit, __global const float* hit_position,
    __global const uint* hit_map, uint first_map, __global const PhotileGrid* grids,
    __global const uint* cell_start, uint entry_stride, __global const float* entry_position,
    __global const uint* entry_photon,
#ifdef NORMALS
    __global const float* entry_normal, __global const float* hit_face_normal, float least_cosine,
#endif
    uint k, float radius, __global uint* neighbours, __global float* squared_radius) {
  LANE_MEMORY
  for (uint h = WORKER; h < hit_count; h += WORKERS) {
    const uint hit = first_hit + h;
    __global uint* list = neighbours + hit * k;
    if (FIRST_LANE) {
      for (uint i = 0; i < k; ++i) list[i] = 0xFFFFFFFFu;
      squared_radius[hit] = radius * radius;
    }

    __global const PhotileGrid* grid = &grids[hit_map[hit] - first_map];
    if (grid->columns == 0) continue;

    Candidates candidates;
#ifdef LANES
    candidates.lanes = lanes;
#endif
    candidates.hit = vload3(hit, hit_position);
    candidates.cell_start = cell_start;
    candidates.position = entry_position;
    candidates.stride = entry_stride;
#ifdef NORMALS
    const NormalFilter filter = {grid->mixed != 0, entry_normal, entry_stride,
                                 vload3(hit, hit_face_normal), least_cosine};
    candidates.filter = filter;
#endif
    Chunks chunks;
    Neighbourhood near;
    find_neighbourhood(&candidates, &chunks, k, k, radius, 0.0f, grid, &near);

    float farthest = 0.0f;
    uint found = 0;
    uint last_tied = 0;
    for (int pass = 0; pass < 2; ++pass) {
      uint cell = candidates.block.first_cell;
      for (uint row = 0; row < candidates.block.height; ++row, cell += candidates.block.columns) {
        const uint end = cell_start[cell + candidates.block.width];
        for (uint entry = cell_start[cell]; entry < end; ++entry) {
          const float d = squared_distance(&candidates, entry);
          const bool is_near =
              pass == 0 ? d < near.below : d == near.below && entry_photon[entry] <= last_tied;
          if (!is_near) continue;
          if (FIRST_LANE) list[found] = entry_photon[entry];
          ++found;
          farthest = fmax(farthest, d);
        }
      }
      if (near.tied == 0) break;
      last_tied = last_tied_photon(&candidates, near.below, near.tied, entry_photon);
    }
    // The k-th is the farthest of the neighbours.
    if (FIRST_LANE) {
      squared_radius[hit] = near.squared_radius > 0.0f ? near.squared_radius : farthest;
    }
  }
}
