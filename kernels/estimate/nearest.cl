// The k nearest photons of each hit, as a list: for tests and inspection. The estimate itself needs
// no list.

#include "estimate/neighbourhood.clh"

// One worker per hit of one map page; arguments as in estimate.cl.
// After: neighbours[hit * k ...] holds photon indices in any order, 0xFFFFFFFF beyond the last;
// squared_radius[hit] is that of the estimate's disc.
__kernel WORKER_GROUP void nearest_by_selection(
    const PhotileQuery query, __global const PhotileHit* hits,
    __global const PhotileHitSurface* hit_surfaces, __global const PhotileGrid* grids,
    __global const uint* cell_start, __global const uint* record_photon,
    __global const float* record_position, __global const float* record_normal,
    __global uint* neighbours, __global float* squared_radius) {
  WORKER_SPACE WorkerMemory memory;
  const uint k = query.k;
  for (uint h = WORKER; h < query.hit_count; h += WORKERS) {
    const uint index = query.first_hit + h;
    __global uint* list = neighbours + (size_t)index * k;
    if (LANE == 0) {
      for (uint i = 0; i < k; ++i) list[i] = 0xFFFFFFFFu;
      squared_radius[index] = query.radius * query.radius;
    }

    __global const PhotileGrid* grid = &grids[hits[index].map - query.first_map];
    if (grid->columns == 0) continue;

    Hit hit;
    hit.position = vload3(0, hits[index].position);
    if (NORMALS) hit.face_normal = vload3(0, hit_surfaces[index].normal);
    Candidates candidates;
    begin_candidates(&candidates, &query, grid, cell_start, record_position, record_normal, &hit);
    Chunks chunks;
    Neighbourhood near;
    find_neighbourhood(&candidates, &chunks, k, k, query.radius, 0.0f, grid, &near, &memory);

    float farthest = 0.0f;
    uint found = 0;
    uint last_tied = 0;
    for (int pass = 0; pass < 2; ++pass) {
      uint cell = candidates.block.first_cell;
      for (uint row = 0; row < candidates.block.height; ++row, cell += candidates.block.columns) {
        const uint end = cell_start[cell + candidates.block.width];
        for (uint record = cell_start[cell]; record < end; ++record) {
          const float d = squared_distance(&candidates, record);
          const bool is_near =
              pass == 0 ? d < near.below : d == near.below && record_photon[record] <= last_tied;
          if (!is_near) continue;
          if (LANE == 0) list[found] = record_photon[record];
          ++found;
          farthest = fmax(farthest, d);
        }
      }
      if (near.tied == 0) break;
      last_tied = last_tied_photon(&candidates, near.below, near.tied, record_photon);
    }
    // The k-th is the farthest of the neighbours.
    if (LANE == 0) {
      squared_radius[index] = near.squared_radius > 0.0f ? near.squared_radius : farthest;
    }
  }
}
