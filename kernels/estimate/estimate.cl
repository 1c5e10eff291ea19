// The radiance estimate (Jensen 2001, equation 7.6; Graglia et al. 2012, section 5): per hit and
// light, the flux of the nearest photons over the area they fell on.
//
// Symbols the host defines:
//   VECTOR_WIDTH     see shared/wide.clh
//   CAPACITY         see estimate/candidates.clh
//   HITS_PER_ITEM    hits in a row that a work-item estimates, each expecting the radius of the last
//   MULTIPLE_LIGHTS, GLOSSY   see estimate/accumulate.clh

#include "estimate/estimate_hit.clh"

#ifndef HITS_PER_ITEM
#define HITS_PER_ITEM 1  // (1 on GPUs, 8 - 64 on CPUs)
#endif

// One work-item per HITS_PER_ITEM hits of one map page.
//   hit_count, first_hit   the hits [first_hit, first_hit + hit_count) of the batch lie in this page
//   hit_position           3 floats per hit of the batch; hit_map: its sided triangle
//   first_map              the page's first sided triangle
//   entry_stride           plane distance of entry_position, entry_flux, entry_incoming
//   k, radius              at most k neighbours, none farther than radius
//   light_count            estimates per hit
// Before: irradiance and radiance are zero where maps hold no photons.
// After: irradiance[(hit * light_count + light) * 3 ...] in flux per square metre; radiance likewise.
__kernel void estimate(uint hit_count, uint first_hit, __global const float* hit_position,
                       __global const uint* hit_map, uint first_map,
                       __global const PhotileGrid* grids, __global const uint* cell_start,
                       uint entry_stride, __global const float* entry_position,
                       __global const float* entry_flux, __global const uint* entry_photon,
#ifdef MULTIPLE_LIGHTS
                       __global const ushort* entry_light,
#endif
#ifdef GLOSSY
                       __global const float* entry_incoming, __global const float* hit_outgoing,
                       __global const float* hit_normal, __global const float* hit_albedo,
                       __global const float* hit_specular, __global const float* hit_roughness,
                       __global float* radiance,
#endif
                       uint k, float radius, uint light_count, __global float* irradiance) {
  Entries entries;
  entries.stride = entry_stride;
  entries.position = entry_position;
  entries.flux = entry_flux;
  entries.photon = entry_photon;
#ifdef MULTIPLE_LIGHTS
  entries.light = entry_light;
#endif
#ifdef GLOSSY
  entries.incoming = entry_incoming;
#endif
  const uint begin = get_global_id(0) * HITS_PER_ITEM;
  const uint end = first_hit + min(begin + HITS_PER_ITEM, hit_count);
  float expected = 0.0f;  // radius of the last hit's neighbourhood, if on the same map
  uint expected_map = 0xFFFFFFFFu;
  for (uint hit = first_hit + begin; hit < end; ++hit) {
    const uint map = hit_map[hit];
    __global const PhotileGrid* grid = &grids[map - first_map];
    if (grid->columns == 0) continue;
    if (map != expected_map) expected = 0.0f;
    expected_map = map;
#ifdef GLOSSY
    const Surface surface = {vload3(hit, hit_outgoing), vload3(hit, hit_normal),
                             vload3(hit, hit_albedo), vload3(hit, hit_specular),
                             hit_roughness[hit]};
#endif
    expected = estimate_hit(&entries, grid, cell_start, vload3(hit, hit_position), k, radius,
                            expected, light_count,
#ifdef GLOSSY
                            &surface, radiance + 3 * hit * light_count,
#endif
                            irradiance + 3 * hit * light_count);
  }
}
