// The radiance estimate over kd-trees, for comparison with the uniform grid: the same neighbours,
// the same sums (estimate/sums.clh).
//
// Symbols the host defines: those of estimate/arguments.clh, estimate/sums.clh and
// kdtree/traverse.clh, and
//   LIST_CAPACITY   k, where the list is in private memory; else LIST_IN_GLOBAL_MEMORY

#include "estimate/estimate_list.clh"
#include "kdtree/query.clh"

// Work-items stride over the hits [first_hit, first_hit + hit_count) of one page.
//   root            per map of the page: its root node, 0xFFFFFFFF without photons
//   frames          per map of the page: the frame of its plane (TREE_2D)
//   list_*          k per work-item (LIST_IN_GLOBAL_MEMORY)
// Others as in estimate/estimate.cl.
__kernel void estimate(uint hit_count, uint first_hit, __global const float* hit_position,
                       __global const uint* hit_map, uint first_map, __global const uint* root,
                       __global const PhotileGrid* frames, __global const PhotileTreeNode* nodes,
                       uint entry_stride, __global const float* entry_position,
                       __global const float* entry_flux, __global const uint* entry_photon,
#ifdef LIST_IN_GLOBAL_MEMORY
                       __global float* list_distance, __global uint* list_entry,
#endif
                       SCENE_ARGUMENTS uint k, float radius, float least_radius,
                       __global float* irradiance) {
  const Entries entries = GIVEN_ENTRIES;
  const Hits hits = GIVEN_HITS;
  const Estimates estimates = GIVEN_ESTIMATES;
#ifdef CLIPPED
  const Surface surface = GIVEN_SURFACE;
  Clearance clearance = NO_CLEARANCE;
#endif
  for (uint h = get_global_id(0); h < hit_count; h += get_global_size(0)) {
    const uint index = first_hit + h;
    const uint map = hit_map[index];
#ifdef LIST_IN_GLOBAL_MEMORY
    __global float* distances = list_distance + (size_t)get_global_id(0) * k;
    __global uint* listed = list_entry + (size_t)get_global_id(0) * k;
#else
    float distances[LIST_CAPACITY];
    uint listed[LIST_CAPACITY];
#endif
    Hit hit;
    load_hit(&hits, index, &hit);
    NearestList list = empty_list(distances, listed, entry_photon, k, radius);
    Tree tree;
    tree.nodes = nodes;
    tree.position = entry_position;
    tree.stride = entry_stride;
#ifdef NORMALS
    tree.normal = entry_normal;
    tree.hit_normal = hit.face_normal;
    tree.least_cosine = least_cosine;
#endif
    nearest_in_tree(&tree, root[map - first_map], hit.position, frames + (map - first_map), &list);
    if (list.size == 0) continue;

    estimate_list(&entries, &list, &hit, k, least_radius, &estimates CLIPPED_VALUES);
  }
}
