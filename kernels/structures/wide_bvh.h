/* The layout of a bounding volume hierarchy of eight children a node, as C++ and OpenCL C both see
   it. A node is 56 words: eight floats each of the children's least x, y, z and largest x, y, z,
   then eight words that say what the children are: a node's index, or with PHOTILE_WIDE_LEAF the
   number of a leaf. Leaf i holds the records from 8 i on, eight but for the last. Children that are
   not there have a box from infinity to less than that. */
#ifndef PHOTILE_DEVICE_WIDE_BVH_H
#define PHOTILE_DEVICE_WIDE_BVH_H

#define PHOTILE_WIDE_NODE_WORDS 56

/* In what a child is: it is a leaf. */
#define PHOTILE_WIDE_LEAF 0x80000000u

/* Nodes that wait while a path is walked down: seven of each of ten levels, for 2^31 photons fill
   2^28 leaves and each level divides their number by eight, and the last one. */
#define PHOTILE_WIDE_STACK 80

#endif
