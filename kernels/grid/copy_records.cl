// Build, step 7: copy what the estimate streams into the order of the cells. A record is a copy of
// its photon's values, so that the rows of a block of cells are read front to back; following
// references instead would read a cache line per photon.

#include "photile/device/build.h"
#include "shared/symbols.clh"

// One work-item per record of a map page, in both kernels; handles those whose photon is in the
// photon page.
//   record_stride   records of the page with padding: component c of record i is [c * stride + i]

//   light, record_light         where there are several lights
//   incoming, record_incoming   with GLOSSY
__kernel void copy_records(
    const PhotilePhotonPage page, uint record_count, uint record_stride,
    __global const uint* restrict record_photon, __global const float* restrict position,
    __global const float* restrict flux, __global const ushort* restrict light,
    __global const float* restrict incoming, __global float* restrict record_position,
    __global float* restrict record_flux, __global LightIndex* restrict record_light,
    __global float* restrict record_incoming) {
  for (uint i = get_global_id(0); i < record_count; i += get_global_size(0)) {
    const uint photon = record_photon[i] - page.first_photon;
    if (photon >= page.photon_count) continue;  // also photons before the page: it wraps
    for (uint c = 0; c < 3; ++c) {
      record_position[c * record_stride + i] = position[3 * photon + c];
      record_flux[c * record_stride + i] = flux[3 * photon + c];
      if (GLOSSY) record_incoming[c * record_stride + i] = incoming[3 * photon + c];
    }
    if (LIGHT_BYTES > 0) record_light[i] = (LightIndex)light[photon];
  }
}

// For pages with a map whose queries compare normals.
//   oriented_face   per photon
//   normal           3 floats per oriented face
__kernel void gather_normals(const PhotilePhotonPage page, uint record_count, uint record_stride,
                             __global const uint* restrict record_photon,
                             __global const uint* restrict oriented_face,
                             __global const float* restrict normal,
                             __global float* restrict record_normal) {
  for (uint i = get_global_id(0); i < record_count; i += get_global_size(0)) {
    const uint photon = record_photon[i] - page.first_photon;
    if (photon >= page.photon_count) continue;
    const uint s = oriented_face[photon];
    for (uint c = 0; c < 3; ++c) record_normal[c * record_stride + i] = normal[3 * s + c];
  }
}
