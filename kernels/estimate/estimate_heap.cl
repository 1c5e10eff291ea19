// The radiance estimate with a bounded max-heap per hit: each work-item searches its own rings of
// cells and keeps the k nearest in order. What most implementations do, and what the counting of
// estimate.cl is measured against. The same neighbours; sums in the order of the heap.
//
// Symbols the host defines: those of estimate/accumulate.clh, and
//   LIST_CAPACITY   k

#include "estimate/accumulate.clh"
#include "estimate/area.clh"
#include "estimate/rings.clh"

// One work-item per hit; arguments as in estimate/estimate.cl.
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
  for (uint h = get_global_id(0); h < hit_count; h += get_global_size(0)) {
    const uint hit = first_hit + h;
    __global float* hit_irradiance = irradiance + 3 * hit * light_count;
#ifdef GLOSSY
    __global float* hit_radiance = radiance + 3 * hit * light_count;
    const Surface surface = {vload3(hit, hit_outgoing), vload3(hit, hit_normal),
                             vload3(hit, hit_albedo), vload3(hit, hit_specular),
                             hit_roughness[hit]};
#endif
    __global const PhotileGrid* grid = &grids[hit_map[hit] - first_map];
    if (grid->columns == 0) continue;

    float distances[LIST_CAPACITY];
    uint listed[LIST_CAPACITY];
    NearestList list = empty_list(distances, listed, entry_photon, k, radius);
    nearest_in_rings(&list, vload3(hit, hit_position), grid, cell_start, entry_position,
                     entry_stride);
    // A full list's farthest photon, at 0, only sets the radius (but for k = 1).
    for (uint i = list.size == k && k > 1 ? 1 : 0; i < list.size; ++i) {
      add_entry(&entries, list.entry[i],
#ifdef GLOSSY
                &surface, hit_radiance,
#endif
                hit_irradiance);
    }
    scale_sums(1.0f / estimate_area(squared_radius_of(&list), radius), light_count,
#ifdef GLOSSY
               hit_radiance,
#endif
               hit_irradiance);
  }
}
