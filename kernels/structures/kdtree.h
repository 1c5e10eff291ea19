/* A node of a kd-tree over photons, as C++ and OpenCL C both see it. */
#ifndef PHOTILE_DEVICE_KDTREE_H
#define PHOTILE_DEVICE_KDTREE_H

#define PHOTILE_TREE_LEAF 3u /* in `axis`: the node is a leaf */

/* No path from a root is longer: the traversal stack is this deep. */
#define PHOTILE_TREE_DEPTH 48

/* Nodes are in depth-first order: the lower child of an inner node follows it. */
typedef struct {
  float split;        /* inner node: coordinate of the plane */
  unsigned int axis;  /* 0, 1, 2, or PHOTILE_TREE_LEAF */
  unsigned int first; /* leaf: first record; inner node: index of the upper child */
  unsigned int last;  /* leaf: one past the last record */
} PhotileTreeNode;

#endif
