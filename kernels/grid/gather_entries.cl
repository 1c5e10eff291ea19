// Build, step 7: copy what the estimate streams into the order of the cells. An entry repeats its
// photon's record, so that the rows of a block of cells are read front to back; following
// references instead would touch a cache line per photon.

#include "photile/device/build.h"
#include "shared/symbols.clh"

// One work-item per entry of a map page, in both kernels; handles those whose photon is in the
// photon page.
//   entry_stride   entries of the page with padding: component c of entry i is [c * stride + i]

//   light, entry_light         where there are several lights
//   incoming, entry_incoming   with GLOSSY
__kernel void gather_entries(const PhotilePhotonPage page, uint entry_count, uint entry_stride,
                             __global const uint* entry_photon, __global const float* position,
                             __global const float* flux, __global const ushort* light,
                             __global const float* incoming, __global float* entry_position,
                             __global float* entry_flux, __global LightIndex* entry_light,
                             __global float* entry_incoming) {
  for (uint i = get_global_id(0); i < entry_count; i += get_global_size(0)) {
    const uint photon = entry_photon[i] - page.first_photon;
    if (photon >= page.photon_count) continue;  // also photons before the page: it wraps
    for (uint c = 0; c < 3; ++c) {
      entry_position[c * entry_stride + i] = position[3 * photon + c];
      entry_flux[c * entry_stride + i] = flux[3 * photon + c];
      if (GLOSSY) entry_incoming[c * entry_stride + i] = incoming[3 * photon + c];
    }
    if (LIGHT_BYTES > 0) entry_light[i] = (LightIndex)light[photon];
  }
}

// For pages with a map whose queries compare normals.
//   oriented_face   per photon
//   normal           3 floats per oriented face
__kernel void gather_normals(const PhotilePhotonPage page, uint entry_count, uint entry_stride,
                             __global const uint* entry_photon, __global const uint* oriented_face,
                             __global const float* normal, __global float* entry_normal) {
  for (uint i = get_global_id(0); i < entry_count; i += get_global_size(0)) {
    const uint photon = entry_photon[i] - page.first_photon;
    if (photon >= page.photon_count) continue;
    const uint s = oriented_face[photon];
    for (uint c = 0; c < 3; ++c) entry_normal[c * entry_stride + i] = normal[3 * s + c];
  }
}
