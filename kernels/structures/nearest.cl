// The k nearest photons of each hit, as a list; structures/estimate.cl has the arguments.

#include "structures/query.clh"

// After: neighbours[hit * k ...] holds photon indices in any order, 0xFFFFFFFF beyond the last;
// squared_radius[hit] is that of the estimate's disc; with COUNT_VISITS visits[2 * hit] is the number
// of nodes or cells looked at, visits[2 * hit + 1] that of photons.
__kernel void nearest(uint hit_count, uint first_hit, __global const float* hit_position,
                      __global const uint* hit_map, uint first_map, STRUCTURE_ARGUMENTS,
                      uint entry_stride, __global const float* entry_position,
                      __global const uint* entry_photon,
#ifdef NORMALS
                      __global const float* entry_normal, __global const float* hit_face_normal,
                      float least_cosine,
#endif
#ifdef COUNT_VISITS
                      __global uint* visits,
#endif
                      LIST_ARGUMENTS uint k, float radius, __global uint* neighbours,
                      __global float* squared_radius) {
  const Structure structure = GIVEN_STRUCTURE;
  for (uint h = get_global_id(0); h < hit_count; h += get_global_size(0)) {
    const uint hit = first_hit + h;
    LIST_MEMORY
    NearestList list = empty_list(distances, listed, entry_photon, k, radius);
    Search search = {
        .hit = vload3(hit, hit_position), .position = entry_position, .stride = entry_stride};
    SET_NORMALS(search, vload3(hit, hit_face_normal))
    find_nearest(&search, &structure, hit_map[hit] - first_map, &list);
    for (uint i = 0; i < k; ++i) {
      neighbours[(size_t)hit * k + i] = i < list.size ? entry_photon[list.entry[i]] : 0xFFFFFFFFu;
    }
    squared_radius[hit] = squared_radius_of(&list);
#ifdef COUNT_VISITS
    visits[2 * hit] = search.nodes;
    visits[2 * hit + 1] = search.photons;
#endif
  }
}
