// The estimates of hits with many lights, without the slots that no light took.

#include "shared/scan.cl"
#include "shared/symbols.clh"

// One work-item per hit.
//   first                                      where the estimates of a hit begin; hit_count + 1
//   slot_light, slot_irradiance, slot_radiance   LIGHT_SLOTS per hit: see estimate/sums.clh
// After: light[first[hit] ... first[hit + 1]) and irradiance; with GLOSSY also radiance.
__kernel void pack_estimates(uint hit_count, __global const uint* restrict first,
                             __global const ushort* restrict slot_light,
                             __global const float* restrict slot_irradiance,
                             __global const float* restrict slot_radiance,
                             __global ushort* restrict light, __global float* restrict irradiance,
                             __global float* restrict radiance) {
  for (uint hit = get_global_id(0); hit < hit_count; hit += get_global_size(0)) {
    uint slot = hit * LIGHT_SLOTS;
    for (uint i = first[hit]; i < first[hit + 1]; ++i, ++slot) {
      light[i] = slot_light[slot];
      vstore3(vload3(slot, slot_irradiance), i, irradiance);
      if (GLOSSY) vstore3(vload3(slot, slot_radiance), i, radiance);
    }
  }
}
