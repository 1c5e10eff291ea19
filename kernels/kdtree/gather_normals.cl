// Build of the global tree: the normal of each entry's sided triangle.

// One work-item per entry.
//   own_map      sided triangle of each photon
//   map_normal   3 floats per sided triangle
// After: component c of entry i's normal is entry_normal[c * entry_stride + i].
__kernel void gather_normals(uint entry_count, uint entry_stride,
                             __global const uint* entry_photon, __global const uint* own_map,
                             __global const float* map_normal, __global float* entry_normal) {
  for (uint i = get_global_id(0); i < entry_count; i += get_global_size(0)) {
    const uint map = own_map[entry_photon[i]];
    for (uint c = 0; c < 3; ++c) entry_normal[c * entry_stride + i] = map_normal[3 * map + c];
  }
}
