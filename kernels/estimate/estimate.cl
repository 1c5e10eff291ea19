// The radiance estimate (Jensen 2001, equation 7.6; Graglia et al. 2012, section 5): per hit and
// light, the flux of the nearest photons over the area they fell on.
//
// Symbols the host defines:
//   VECTOR_WIDTH     see shared/wide.clh
//   CAPACITY         see estimate/candidates.clh
//   HITS_PER_ITEM    hits in a row that a work-item estimates, each expecting the radius of the last
//   MULTIPLE_LIGHTS, GLOSSY   see estimate/accumulate.clh

#include "estimate/accumulate.clh"
#include "estimate/area.clh"
#include "estimate/neighbourhood.clh"

#ifndef HITS_PER_ITEM
#define HITS_PER_ITEM 1  // (1 on GPUs, 8 - 64 on CPUs)
#endif

#if !defined(MULTIPLE_LIGHTS) && !defined(GLOSSY)
#define FLUX_ONLY  // nothing but flux is summed: a vector of photons at a time
#endif

// One work-item per HITS_PER_ITEM hits of one map page.
//   hit_count, first_hit   the hits [first_hit, first_hit + hit_count) of the batch lie in this page
//   hit_position           3 floats per hit of the batch; hit_map: its sided triangle
//   first_map              the page's first sided triangle
//   entry_stride           plane distance of entry_position, entry_flux, entry_incoming
//   k, radius              at most k neighbours, none farther than radius
//   light_count            estimates per hit
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
  const uint begin = get_global_id(0) * HITS_PER_ITEM;
  const uint end_hit = first_hit + min(begin + HITS_PER_ITEM, hit_count);
  float expected = 0.0f;  // radius of the last hit's neighbourhood, if on the same map
  uint expected_map = 0xFFFFFFFFu;
  for (uint hit = first_hit + begin; hit < end_hit; ++hit) {
    __global float* hit_irradiance = irradiance + 3 * hit * light_count;
    for (uint i = 0; i < 3 * light_count; ++i) hit_irradiance[i] = 0.0f;
#ifdef GLOSSY
    __global float* hit_radiance = radiance + 3 * hit * light_count;
    for (uint i = 0; i < 3 * light_count; ++i) hit_radiance[i] = 0.0f;
    const Surface surface = {vload3(hit, hit_outgoing), vload3(hit, hit_normal),
                             vload3(hit, hit_albedo), vload3(hit, hit_specular),
                             hit_roughness[hit]};
#endif

    const uint map = hit_map[hit];
    __global const PhotileGrid* grid = &grids[map - first_map];
    if (grid->columns == 0) continue;
    if (map != expected_map) expected = 0.0f;

    Candidates candidates;
    candidates.hit = vload3(hit, hit_position);
    candidates.cell_start = cell_start;
    candidates.position = entry_position;
    candidates.stride = entry_stride;
    DECLARE_STORED(stored);
    const Neighbourhood near =
        find_neighbourhood(&candidates, stored, k, max(k - 1u, 1u), radius, expected, grid);

    Entries entries;
    entries.flux = entry_flux;
#ifdef MULTIPLE_LIGHTS
    entries.light = entry_light;
#endif
#ifdef GLOSSY
    entries.incoming = entry_incoming;
#endif

    uint found = 0;
#ifdef FLUX_ONLY
    wide_float red = 0.0f, green = 0.0f, blue = 0.0f;
    wide_int lanes_found = 0;
#endif
    wide_float beyond = INFINITY;  // the nearest that is no neighbour
    uint first_of_row = 0;         // in the stored distances
    uint cell = candidates.block.first_cell;
    for (uint row = 0; row < candidates.block.height; ++row, cell += candidates.block.columns) {
      const uint start = cell_start[cell];
      const uint end = cell_start[cell + candidates.block.width];
      // From a multiple of the vector width, so that an entry's lane, and with it the order of the
      // sum, does not depend on the block.
      for (uint entry = start - start % VECTOR_WIDTH; entry < end; entry += VECTOR_WIDTH) {
        const wide_float d = fits(&candidates)
                                 ? wide_load(stored + ((int)first_of_row + (int)(entry - start)))
                                 : squared_distances(&candidates, entry);
        const wide_int in_row = (WIDE_LANES < (wide_int)((int)(end - entry))) &
                                (WIDE_LANES >= (wide_int)((int)(start - entry)));
        const wide_int is_near = (d < near.below) & in_row;
        beyond = select(beyond, d, (d >= near.below) & (d < beyond) & in_row);
#ifdef FLUX_ONLY
        const wide_float zero = 0.0f;
        red += select(zero, wide_load(entry_flux + entry), is_near);
        green += select(zero, wide_load(entry_flux + entry_stride + entry), is_near);
        blue += select(zero, wide_load(entry_flux + 2 * entry_stride + entry), is_near);
        lanes_found += TRUE_LANES(is_near);
#else
        int lanes[VECTOR_WIDTH];
        wide_store(is_near, lanes);
        for (uint lane = 0; lane < VECTOR_WIDTH; ++lane) {
          if (!lanes[lane]) continue;
          ++found;
          add_entry(&entries, entry + lane, entry_stride,
#ifdef GLOSSY
                    &surface, hit_radiance,
#endif
                    hit_irradiance);
        }
#endif
      }
      first_of_row += end - start;
    }
#ifdef FLUX_ONLY
    found = (uint)count_lanes(lanes_found);
    vstore3((float3)(sum_lanes(red), sum_lanes(green), sum_lanes(blue)), 0, hit_irradiance);
#endif

    if (found < near.count) {
      const uint last = last_tied_photon(&candidates, near.below, near.count - found, entry_photon);
      cell = candidates.block.first_cell;
      for (uint row = 0; row < candidates.block.height; ++row, cell += candidates.block.columns) {
        const uint end = cell_start[cell + candidates.block.width];
        for (uint entry = cell_start[cell]; entry < end; ++entry) {
          if (entry_photon[entry] > last) continue;
          if (squared_distance(&candidates, entry) != near.below) continue;
          add_entry(&entries, entry, entry_stride,
#ifdef GLOSSY
                    &surface, hit_radiance,
#endif
                    hit_irradiance);
        }
      }
    }

    float squared_radius = near.squared_radius;
    if (squared_radius == 0.0f) {
      squared_radius = k > 1 ? smallest_lane(beyond) : largest_within(&candidates, near.below);
    }
    expected = sqrt(squared_radius);
    expected_map = map;
    const float per_area = 1.0f / estimate_area(squared_radius, radius);
    for (uint i = 0; i < 3 * light_count; ++i) hit_irradiance[i] *= per_area;
#ifdef GLOSSY
    for (uint i = 0; i < 3 * light_count; ++i) hit_radiance[i] *= per_area;
#endif
  }
}
