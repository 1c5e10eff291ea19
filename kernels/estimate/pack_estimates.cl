// The estimates of hits with many lights, without the slots that no light took.
//
// Symbols the host defines: LIGHT_SLOTS and GLOSSY, see estimate/sums.clh

#include "shared/scan.clh"

// One work-item per hit.
//   first   where the estimates of a hit begin; hit_count + 1
// After: light[first[hit] ... first[hit + 1]) and what belongs to them.
__kernel void pack_estimates(uint hit_count, __global const uint* first,
                             __global const ushort* slot_light,
                             __global const float* slot_irradiance, __global ushort* light,
                             __global float* irradiance
#ifdef GLOSSY
                             ,
                             __global const float* slot_radiance, __global float* radiance
#endif
) {
  for (uint hit = get_global_id(0); hit < hit_count; hit += get_global_size(0)) {
    uint slot = hit * LIGHT_SLOTS;
    for (uint i = first[hit]; i < first[hit + 1]; ++i, ++slot) {
      light[i] = slot_light[slot];
      vstore3(vload3(slot, slot_irradiance), i, irradiance);
#ifdef GLOSSY
      vstore3(vload3(slot, slot_radiance), i, radiance);
#endif
    }
  }
}
