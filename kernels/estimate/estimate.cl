// The radiance estimate (Jensen 2001, equation 7.6; Graglia et al. 2012): per hit and light, the
// flux of the nearest photons over the area they fell on. shared/symbols.clh has the symbols that
// specialise it.

#include "estimate/estimate_hit.clh"

// One worker per HITS_PER_ITEM hits, each of which expects the radius of the one before. Photon
// records lie in planes of query.record_stride; arrays that no surface of the scene needs are
// empty.
//   hit_surfaces                   with CLIPPED or NORMALS
//   hit_lobes, record_incoming      with GLOSSY
//   grids                          per map of the page
//   record_light                    where there are several lights
//   record_normal                   with NORMALS
//   surface_nodes, surface_leaves  with CLIPPED
//   radiance                       with GLOSSY
//   slot_light, slots_taken        with many lights
// Before: the estimates are zero.
// After: those of hits on maps with photons are written. irradiance[(hit * LIGHT_COUNT + light) * 3
// ...] in flux per square metre; radiance likewise. With many lights, the first slots_taken[hit] of
// LIGHT_SLOTS slots take the place of lights.
__kernel WORKER_GROUP void estimate_by_selection(
    const PhotileQuery query, __global const PhotileHit* restrict hits,
    __global const uint* restrict order,
    __global const PhotileHitSurface* restrict hit_surfaces,
    __global const PhotileHitLobe* restrict hit_lobes, __global const PhotileGrid* restrict grids,
    __global const uint* restrict cell_start, __global const uint* restrict record_photon,
    __global const float* restrict record_position, __global const float* restrict record_flux,
    __global const LightIndex* restrict record_light,
    __global const float* restrict record_incoming, __global const float* restrict record_normal,
    __global const PhotileSurfaceNode* restrict surface_nodes,
    __global const PhotileSurfaceLeaf* restrict surface_leaves, __global float* restrict irradiance,
    __global float* restrict radiance, __global ushort* restrict slot_light,
    __global uint* restrict slots_taken) {
  WORKER_MEMORY(WorkerMemory, memory);
  const PhotonRecords records = {query.record_stride, record_photon, record_position,
                                 record_flux,         record_light,  record_incoming};
  const Surface surface = {surface_nodes, surface_leaves, query.least_cosine};
  const Estimates estimates = {irradiance, radiance, slot_light, slots_taken};
  EmptyRadius empty = NO_EMPTY_RADIUS;
  const uint begin = WORKER * HITS_PER_ITEM;
  const uint end = query.first_hit + min(begin + HITS_PER_ITEM, query.hit_count);
  float expected = 0.0f;  // radius of the last hit's neighbourhood, if on the same map
  uint expected_map = 0xFFFFFFFFu;
  for (uint i = query.first_hit + begin; i < end; ++i) {
    const uint index = hit_at(i, order);
    if (!is_on_page(&query, &hits[index])) continue;
    const uint map = hits[index].map;
    __global const PhotileGrid* grid = &grids[map - query.first_map];
    if (grid->columns == 0) continue;
    if (map != expected_map) expected = 0.0f;
    expected_map = map;
    Hit hit;
    load_hit(index, hits, hit_surfaces, hit_lobes, &hit);
    Candidates candidates;
    begin_candidates(&candidates, &query, grid, cell_start, record_photon, record_position,
                     record_normal, &hit);
    expected = estimate_hit(&candidates, &records, grid, &surface, &hit, &query, expected, &empty,
                            &estimates, memory);
  }
}
