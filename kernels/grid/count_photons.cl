// Build, step 1: how many photons each map will hold.

#include "grid/entry.clh"

// One work-item per photon of a page.
//   position        3 floats per photon of the page
//   own_map         sided triangle of each photon
//   list            of candidate maps, per photon: list_members[list_offsets[list] ...]
//   map_count       per sided triangle; zero before the first page
// After: map_count holds the photons of this page, too.
__kernel void count_photons(uint photon_count, __global const float* position,
                            __global const uint* own_map, __global const uint* list,
                            __global const uint* list_offsets,
                            __global const uint* list_members, __global const float* corners,
                            float squared_reach, __global uint* map_count) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    const uint own = own_map[i];
    const uint end = list_offsets[list[i] + 1];
    for (uint m = list_offsets[list[i]]; m < end; ++m) {
      const uint map = list_members[m];
      if (enters_map(photon, own, map, corners, squared_reach)) atomic_inc(&map_count[map]);
    }
  }
}
