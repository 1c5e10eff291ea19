// The k nearest photons of each hit, as a list: for tests and inspection. The estimate itself needs
// no list.

#include "estimate/neighbourhood.clh"

// One worker per hit of one map page; arguments as in estimate.cl.
// Before: neighbours is 0xFFFFFFFF, squared_radius the square of the search radius.
// After: neighbours[hit * k ...] of hits on maps with photons holds photon indices in any order,
// followed by what was there; squared_radius[hit] is that of the estimate's disc.
__kernel WORKER_GROUP void nearest_by_selection(
    const PhotileQuery query, __global const PhotileHit* restrict hits,
    __global const uint* restrict order,
    __global const PhotileHitSurface* restrict hit_surfaces,
    __global const PhotileGrid* restrict grids, __global const uint* restrict cell_start,
    __global const uint* restrict record_photon, __global const float* restrict record_position,
    __global const float* restrict record_normal, __global uint* restrict neighbours,
    __global float* restrict squared_radius) {
  WORKER_MEMORY(WorkerMemory, memory);
  WORKER_MEMORY(uint, listed);
  const uint k = query.k;
  for (uint h = WORKER; h < query.hit_count; h += WORKERS) {
    const uint index = hit_at(query.first_hit + h, order);
    if (!is_on_page(&query, &hits[index])) continue;
    __global const PhotileGrid* grid = &grids[hits[index].map - query.first_map];
    if (grid->columns == 0) continue;

    Hit hit;
    hit.position = vload3(0, hits[index].position);
    if (NORMALS) hit.face_normal = vload3(0, hit_surfaces[index].normal);
    Candidates candidates;
    begin_candidates(&candidates, &query, grid, cell_start, record_photon, record_position,
                     record_normal, &hit);
    Chunks chunks;
    Neighbourhood near;
    find_neighbourhood(&candidates, &chunks, k, k, query.radius, 0.0f, grid, &near, memory);

    __global uint* list = neighbours + (size_t)index * k;
    simd_float farther = 0.0f;  // negative, so that the smallest is the farthest
    synchronise_lanes();        // all have read the count of the list before
    if (LANE == 0) *listed = 0;
    Walk walk;
    begin_walk(&walk, &candidates);
    do {
      next_chunks(&candidates, &walk, &chunks, memory);
      for (uint i = 0; i < chunks.count; ++i) {
        const simd_float d = kept_distances(&chunks, memory, i);
        const uint record = kept_record(&chunks, memory, i);
        const simd_int is_near = neighbour_lanes(&candidates, &near, record, d);
        list_lanes(record_photon, record, is_near, list, listed);
        farther = select(farther, -d, is_near & (-d < farther));
      }
    } while (walk.row < candidates.block.height);
    const float farthest = -smallest_lane(farther, memory);
    // The k-th is the farthest of the neighbours.
    if (LANE == 0) {
      squared_radius[index] = near.squared_radius > 0.0f ? near.squared_radius : farthest;
    }
  }
}
