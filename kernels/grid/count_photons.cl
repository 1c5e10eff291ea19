// Build, step 1: which maps photons enter, and how many photons each map will hold.

#include "grid/entry.clh"

// Symbols the host defines:
//   PATCHES   maps serve several triangles, whose normals may differ

// One work-item per photon of a page. After: bit m of entered[i] says whether photon i enters its
// m-th candidate.
__kernel void find_entered(CANDIDATES, __global uint* entered) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    const uint own = map_of[sided_triangle[i]];
    const uint first = list_offsets[list[i] - first_list];
    const uint count = min(list_offsets[list[i] - first_list + 1u] - first, REMEMBERED);
    uint bits = 0;
    for (uint m = 0; m < count; ++m) {
      if (enters_map(photon, own, list_members[first + m], shapes, corners, squared_reach)) {
        bits |= 1u << m;
      }
    }
    entered[i] = bits;
  }
}

// One work-item per photon of a page.
//   map_count   per map; zero before the first page
//   normal      3 floats per sided triangle
//   map_mixed   per map; zero before the first page
// After: map_count holds the photons of this page, too; map_mixed is 1 for maps with a photon that
// need not agree with every triangle of the map.
__kernel void count_photons(ENTERED_CANDIDATES, __global uint* map_count
#ifdef PATCHES
                            ,
                            __global const float* normal, __global uint* map_mixed
#endif
) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    for (FOR_EACH_ENTERED(i)) {
      const uint map = list_members[m];
      atomic_inc(&map_count[map]);
#ifdef PATCHES
      __global const PhotileMapShape* shape = &shapes[map >> 1];
      const float3 axis = (float3)(shape->axis_x, shape->axis_y, shape->axis_z);
      const float cosine = dot3(vload3(sided_triangle[i], normal), axis);
      if ((map & 1u ? -cosine : cosine) < shape->certain_cosine) atomic_or(&map_mixed[map], 1u);
#endif
    }
  }
}
