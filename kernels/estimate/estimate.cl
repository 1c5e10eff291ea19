// The radiance estimate (Jensen 2001, equation 7.6; Graglia et al. 2012): per hit and
// light, the flux of the nearest photons over the area they fell on.
//
// Symbols the host defines:
//   VECTOR_WIDTH     see shared/wide.clh
//   CAPACITY         see estimate/candidates.clh
//   HITS_PER_ITEM    hits in a row of a work-item or group of lanes, each expecting the radius of
//                    the one before
//   those of estimate/arguments.clh and estimate/sums.clh

#include "estimate/estimate_hit.clh"

#ifndef HITS_PER_ITEM
#define HITS_PER_ITEM 1  // (4 on GPUs, 8 - 64 on CPUs)
#endif

// One work-item, or with LANES one group, per HITS_PER_ITEM hits of one map page.
//   hit_count, first_hit   hits [first_hit, first_hit + hit_count) of the batch lie in this page
//   hit_map                the map that each hit of the batch lies on
//   first_map              the page's first map
//   entry_stride           plane distance of entry_position, entry_flux, entry_incoming
//   k, radius              at most k neighbours, none farther than radius
//   least_radius           that a smaller disc is taken to have
//   others                 see estimate/arguments.clh
// Before: the estimates are zero.
// After: those of hits on maps with photons are written. irradiance[(hit * LIGHT_COUNT + light) * 3
// ...] in flux per square metre; radiance likewise. With many lights the first slots_taken[hit] of
// LIGHT_SLOTS slots in place of lights.
__kernel GROUP_OF_LANES void estimate(
    uint hit_count, uint first_hit, __global const float* hit_position,
    __global const uint* hit_map, uint first_map, __global const PhotileGrid* grids,
    __global const uint* cell_start, uint entry_stride, __global const float* entry_position,
    __global const float* entry_flux, __global const uint* entry_photon, SCENE_ARGUMENTS uint k,
    float radius, float least_radius, __global float* irradiance) {
  LANE_MEMORY
  const Entries entries = GIVEN_ENTRIES;
  const Hits hits = GIVEN_HITS;
  const Estimates estimates = GIVEN_ESTIMATES;
  const uint begin = WORKER * HITS_PER_ITEM;
  const uint end = first_hit + min(begin + HITS_PER_ITEM, hit_count);
#ifdef CLIPPED
  const Surface surface = GIVEN_SURFACE;
  Clearance clearance = NO_CLEARANCE;
#endif
  float expected = 0.0f;  // radius of the last hit's neighbourhood, if on the same map
  uint expected_map = 0xFFFFFFFFu;
  for (uint index = first_hit + begin; index < end; ++index) {
    const uint map = hit_map[index];
    __global const PhotileGrid* grid = &grids[map - first_map];
    if (grid->columns == 0) continue;
    if (map != expected_map) expected = 0.0f;
    expected_map = map;
    Hit hit;
    load_hit(&hits, index, &hit);
    expected = estimate_hit(&entries, grid, cell_start, &hit, k, radius, least_radius, expected,
                            &estimates CLIPPED_VALUES LANES_VALUE);
  }
}
