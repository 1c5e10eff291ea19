// Nearest photons in a kd-tree: depth first, nearer child first, with a stack.
// Source of the bound: Arya & Mount, "Algorithms for fast vector quantization" (1993): the squared
// distance to a subtree's region is kept up to date axis by axis.

#include "grid/cell.clh"
#include "structures/kdtree.h"
#include "structures/search.clh"

#ifndef TREE_2D
#define TREE_2D 0  // 1: splits are in the plane of the map's triangle, else in space
#endif

typedef struct {
  uint node;
  float3 offset;  // from the point to the region, per axis
} Pending;

// Offers every photon of the subtree that can be among the nearest.
//   point     where splits are compared: the hit, or its coordinates (u, v, 0) in the plane
//   slack     what rounding may add to the distance of a projected point, metres
static void nearest_in_subtree(Search* search, uint root, __global const PhotileTreeNode* nodes,
                               float3 point, float slack, NearestList* list) {
  // A region is skipped if even its border is beyond the cut, by more than rounding explains.
  const float slack_squared = 2.0f * slack * sqrt(list->outer_bound) + slack * slack;
  Pending stack[PHOTILE_TREE_DEPTH];
  int depth = 0;
  Pending here = {root, (float3)(0.0f, 0.0f, 0.0f)};
  for (;;) {
    if (squared_length(here.offset) <= cut_of(list) * 1.000002f + slack_squared) {
      ++search->nodes;
      PhotileTreeNode node = nodes[here.node];
      while (node.axis != PHOTILE_TREE_LEAF) {
        const float coordinate = node.axis == 0 ? point.x : node.axis == 1 ? point.y : point.z;
        const float to_plane = coordinate - node.split;
        Pending farther = here;
        if (node.axis == 0) farther.offset.x = to_plane;
        if (node.axis == 1) farther.offset.y = to_plane;
        if (node.axis == 2) farther.offset.z = to_plane;
        if (to_plane < 0.0f) {
          farther.node = node.first;
          here.node = here.node + 1;
        } else {
          farther.node = here.node + 1;
          here.node = node.first;
        }
        stack[depth++] = farther;
        ++search->nodes;
        node = nodes[here.node];
      }
      offer_records(search, node.first, node.last, list);
    }
    if (depth == 0) break;
    here = stack[--depth];
  }
}

// Nodes are PhotileTreeNode.
static void find_nearest(Search* search, const Structure* in, uint photons, NearestList* list) {
  const uint root = in->root[photons];
  if (root == 0xFFFFFFFFu) return;
  __global const PhotileTreeNode* tree = (__global const PhotileTreeNode*)in->nodes;
  float3 point = search->hit;
  float slack = 0.0f;
  if (TREE_2D) {
    __global const PhotileGrid* frame = &in->frames[photons];
    point = (float3)(project(search->hit, frame), 0.0f);
    slack = frame->slack;
  }
  nearest_in_subtree(search, root, tree, point, slack, list);
}

#include "structures/kernels.clh"
