// Build, step 1: how many photons each map will hold.

#include "grid/entry.clh"

// Symbols the host defines:
//   PATCHES   maps serve several triangles, whose normals may differ

// One work-item per photon of a page.
//   position        3 floats per photon of the page
//   own_map         map of each photon's own sided triangle
//   list            of candidate maps, per photon: list_members[list_offsets[list] ...]
//   shapes, corners, squared_reach   see enters_map
//   map_count       per map; zero before the first page
//   normal          3 floats per photon: of its sided triangle
//   map_mixed       per map; zero before the first page
// After: map_count holds the photons of this page, too; map_mixed is 1 for maps with a photon that
// need not agree with every triangle of the map.
__kernel void count_photons(uint photon_count, __global const float* position,
                            __global const uint* own_map, __global const uint* list,
                            __global const uint* list_offsets, __global const uint* list_members,
                            __global const PhotileMapShape* shapes, __global const float* corners,
                            float squared_reach, __global uint* map_count
#ifdef PATCHES
                            ,
                            __global const float* normal, __global uint* map_mixed
#endif
) {
  for (uint i = get_global_id(0); i < photon_count; i += get_global_size(0)) {
    const float3 photon = vload3(i, position);
    const uint own = own_map[i];
    const uint end = list_offsets[list[i] + 1];
    for (uint m = list_offsets[list[i]]; m < end; ++m) {
      const uint map = list_members[m];
      if (!enters_map(photon, own, map, shapes, corners, squared_reach)) continue;
      atomic_inc(&map_count[map]);
#ifdef PATCHES
      __global const PhotileMapShape* shape = &shapes[map >> 1];
      const float3 axis = (float3)(shape->axis_x, shape->axis_y, shape->axis_z);
      const float cosine = dot3(vload3(i, normal), axis);
      if ((map & 1u ? -cosine : cosine) < shape->certain_cosine) atomic_or(&map_mixed[map], 1u);
#endif
    }
  }
}
