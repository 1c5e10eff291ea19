// The radiance estimate with a bounded max-heap per hit: each work-item searches its own rings of
// cells and keeps the k nearest in order. What most implementations do, and what the selection of
// estimate.cl is measured against. The same neighbours; sums in the order of the heap.
//
// Symbols the host defines: those of estimate/arguments.clh and estimate/sums.clh, and
//   LIST_CAPACITY   k

#include "estimate/estimate_list.clh"
#include "estimate/rings.clh"

// One work-item per hit; arguments as in estimate/estimate.cl.
__kernel void estimate(uint hit_count, uint first_hit, __global const float* hit_position,
                       __global const uint* hit_map, uint first_map,
                       __global const PhotileGrid* grids, __global const uint* cell_start,
                       uint entry_stride, __global const float* entry_position,
                       __global const float* entry_flux, __global const uint* entry_photon,
                       SCENE_ARGUMENTS uint k, float radius, float least_radius,
                       __global float* irradiance) {
  const Entries entries = GIVEN_ENTRIES;
  const Hits hits = GIVEN_HITS;
  const Estimates estimates = GIVEN_ESTIMATES;
#ifdef CLIPPED
  const Surface surface = GIVEN_SURFACE;
  Clearance clearance = NO_CLEARANCE;
#endif
  for (uint h = get_global_id(0); h < hit_count; h += get_global_size(0)) {
    const uint index = first_hit + h;
    __global const PhotileGrid* grid = &grids[hit_map[index] - first_map];
    if (grid->columns == 0) continue;

    Hit hit;
    load_hit(&hits, index, &hit);
    float distances[LIST_CAPACITY];
    uint listed[LIST_CAPACITY];
    NearestList list = empty_list(distances, listed, entry_photon, k, radius);
    Search search;
    search.hit = hit.position;
    search.position = entry_position;
    search.stride = entry_stride;
#ifdef NORMALS
    const NormalFilter filter = {grid->mixed != 0, entry_normal, entry_stride, hit.face_normal,
                                 least_cosine};
    search.filter = filter;
#endif
    nearest_in_rings(&list, &search, grid, cell_start);
    estimate_list(&entries, &list, &hit, k, least_radius, &estimates CLIPPED_VALUES);
  }
}
