// Build, step 7: copy what the estimate streams into the order of the cells. An entry repeats its
// photon's record, so that the rows of a block of cells are read front to back; following
// references instead would touch a cache line per photon.

// Symbols the host defines:
//   LIGHT_INDEX   type of an entry's light; undefined with one light
//   GLOSSY        entries keep their incoming direction

// One work-item per entry of a map page, in both kernels; handles those whose photon is in the
// photon page.
//   entry_stride   entries of the page with padding: component c of entry i is [c * stride + i]

__kernel void gather_entries(uint entry_count, uint entry_stride, __global const uint* entry_photon,
                             uint first_photon, uint photon_count, __global const float* position,
                             __global const float* flux, __global float* entry_position,
                             __global float* entry_flux
#ifdef LIGHT_INDEX
                             ,
                             __global const ushort* light, __global LIGHT_INDEX* entry_light
#endif
#ifdef GLOSSY
                             ,
                             __global const float* incoming, __global float* entry_incoming
#endif
) {
  for (uint i = get_global_id(0); i < entry_count; i += get_global_size(0)) {
    const uint photon = entry_photon[i] - first_photon;
    if (photon >= photon_count) continue;  // also photons before the page: the difference wraps
    for (uint c = 0; c < 3; ++c) {
      entry_position[c * entry_stride + i] = position[3 * photon + c];
      entry_flux[c * entry_stride + i] = flux[3 * photon + c];
#ifdef GLOSSY
      entry_incoming[c * entry_stride + i] = incoming[3 * photon + c];
#endif
    }
#ifdef LIGHT_INDEX
    entry_light[i] = (LIGHT_INDEX)light[photon];
#endif
  }
}

// For pages with a map whose queries compare normals.
//   sided_triangle   per photon
//   normal           3 floats per sided triangle
__kernel void gather_normals(uint entry_count, uint entry_stride, __global const uint* entry_photon,
                             uint first_photon, uint photon_count,
                             __global const uint* sided_triangle, __global const float* normal,
                             __global float* entry_normal) {
  for (uint i = get_global_id(0); i < entry_count; i += get_global_size(0)) {
    const uint photon = entry_photon[i] - first_photon;
    if (photon >= photon_count) continue;
    const uint s = sided_triangle[photon];
    for (uint c = 0; c < 3; ++c) entry_normal[c * entry_stride + i] = normal[3 * s + c];
  }
}
