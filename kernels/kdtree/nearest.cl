// The k nearest photons of each hit by kd-tree, as a list; kdtree/estimate.cl has the arguments.

#include "kdtree/query.clh"

// After: neighbours[hit * k ...] holds photon indices in any order, 0xFFFFFFFF beyond the last;
// squared_radius[hit] is that of the estimate's disc.
__kernel void nearest(uint hit_count, uint first_hit, __global const float* hit_position,
                      __global const uint* hit_map, uint first_map, __global const uint* root,
                      __global const PhotileGrid* frames, __global const PhotileTreeNode* nodes,
                      uint entry_stride, __global const float* entry_position,
                      __global const uint* entry_photon,
#ifdef NORMALS
                      __global const float* entry_normal, __global const float* hit_face_normal,
                      float least_cosine,
#endif
#ifdef LIST_IN_GLOBAL_MEMORY
                      __global float* list_distance, __global uint* list_entry,
#endif
                      uint k, float radius, __global uint* neighbours,
                      __global float* squared_radius) {
  for (uint h = get_global_id(0); h < hit_count; h += get_global_size(0)) {
    const uint hit = first_hit + h;
    const uint map = hit_map[hit];
#ifdef LIST_IN_GLOBAL_MEMORY
    __global float* distances = list_distance + (size_t)get_global_id(0) * k;
    __global uint* listed = list_entry + (size_t)get_global_id(0) * k;
#else
    float distances[LIST_CAPACITY];
    uint listed[LIST_CAPACITY];
#endif
    NearestList list = empty_list(distances, listed, entry_photon, k, radius);
    Tree tree;
    tree.nodes = nodes;
    tree.position = entry_position;
    tree.stride = entry_stride;
#ifdef NORMALS
    tree.normal = entry_normal;
    tree.hit_normal = vload3(hit, hit_face_normal);
    tree.least_cosine = least_cosine;
#endif
    nearest_in_tree(&tree, root[map - first_map], vload3(hit, hit_position),
                    frames + (map - first_map), &list);
    for (uint i = 0; i < k; ++i) {
      neighbours[(size_t)hit * k + i] = i < list.size ? entry_photon[list.entry[i]] : 0xFFFFFFFFu;
    }
    squared_radius[hit] = squared_radius_of(&list);
  }
}
