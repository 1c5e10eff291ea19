// The radiance estimate by a bounded max-heap per hit, over kd-trees and other structures, for
// comparison with the selection: the same neighbours, the same sums (estimate/sums.clh) in the order
// of the heap.
//
// Symbols the host defines: those of estimate/arguments.clh, estimate/sums.clh and
// structures/query.clh

#include "structures/query.clh"
#include "estimate/estimate_list.clh"

// Work-items stride over the hits [first_hit, first_hit + hit_count) of one page; arguments as in
// estimate/estimate.cl and structures/search.clh.
__kernel void estimate(uint hit_count, uint first_hit, __global const float* hit_position,
                       __global const uint* hit_map, uint first_map, STRUCTURE_ARGUMENTS,
                       uint entry_stride, __global const float* entry_position,
                       __global const float* entry_flux, __global const uint* entry_photon,
                       LIST_ARGUMENTS SCENE_ARGUMENTS uint k, float radius, float least_radius,
                       __global float* irradiance) {
  const Entries entries = GIVEN_ENTRIES;
  const Hits hits = GIVEN_HITS;
  const Estimates estimates = GIVEN_ESTIMATES;
  const Structure structure = GIVEN_STRUCTURE;
#ifdef CLIPPED
  const Surface surface = GIVEN_SURFACE;
  Clearance clearance = NO_CLEARANCE;
#endif
  for (uint h = get_global_id(0); h < hit_count; h += get_global_size(0)) {
    const uint index = first_hit + h;
    LIST_MEMORY
    Hit hit;
    load_hit(&hits, index, &hit);
    NearestList list = empty_list(distances, listed, entry_photon, k, radius);
    Search search = {.hit = hit.position, .position = entry_position, .stride = entry_stride};
    SET_NORMALS(search, hit.face_normal)
    find_nearest(&search, &structure, hit_map[index] - first_map, &list);
    if (list.size == 0) continue;

    estimate_list(&entries, &list, &hit, k, least_radius, &estimates CLIPPED_VALUES);
  }
}
