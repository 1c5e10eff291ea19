// Build, step 1: which maps photons enter, and how many photons each map will hold.

#include "grid/insertion.clh"
#include "shared/symbols.clh"

// One work-item per photon of a page.
// After: bit m of inserted[i] says whether photon i enters its m-th candidate.
__kernel void find_insertions(INSERTED_PHOTONS_ARGUMENTS, __global uint* restrict inserted) {
  const InsertedPhotons photons = INSERTED_PHOTONS;
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    InsertedPhoton photon;
    load_photon(&photons, i, 0u, &photon);
    const uint count = min(photon.end - photon.first, REMEMBERED);
    uint bits = 0;
    for (uint m = 0; m < count; ++m) {
      if (enters_candidate(&photons, &photon, photon.first + m)) bits |= 1u << m;
    }
    inserted[i] = bits;
  }
}

// One work-item per photon of a page.
//   map_count           per map; zero before the first page
//   normal, map_normal_filtered   with PATCHES: 3 floats per oriented face; per map, zero before
//   the first page
// After: map_count holds the photons of this page, too; map_normal_filtered is 1 for maps with a
// photon that need not agree with every triangle of the map.
__kernel void count_photons(INSERTED_PHOTONS_ARGUMENTS, __global const uint* restrict inserted,
                            __global uint* restrict map_count,
                            __global const float* restrict normal,
                            __global uint* restrict map_normal_filtered) {
  const InsertedPhotons photons = INSERTED_PHOTONS;
  for (uint i = get_global_id(0); i < page.photon_count; i += get_global_size(0)) {
    InsertedPhoton photon;
    load_photon(&photons, i, inserted[i], &photon);
    for (uint m = next_insertion(&photons, &photon, photon.first); m < photon.end;
         m = next_insertion(&photons, &photon, m + 1u)) {
      const uint map = list_members[m];
      atomic_inc(&map_count[map]);
      if (PATCHES) {
        __global const PhotileMapShape* shape = &shapes[map >> 1];
        const float3 axis = (float3)(shape->axis_x, shape->axis_y, shape->axis_z);
        const float cosine = dot3(vload3(oriented_face[i], normal), axis);
        if ((map & 1u ? -cosine : cosine) < shape->certain_cosine)
          atomic_or(&map_normal_filtered[map], 1u);
      }
    }
  }
}
