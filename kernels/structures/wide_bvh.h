/* The layout of a bounding volume hierarchy of eight children a node, as C++ and OpenCL C both see
   it. A node is 56 words: eight floats each of the children's least x, y, z and largest x, y, z,
   then eight words, one for each child: a node's index, or with PHOTILE_WIDE_LEAF the number of a
   leaf. Leaf i holds the records from 8 i on, eight except in the last leaf. Missing children have
   a box from infinity to less than that. */
#ifndef PHOTILE_DEVICE_WIDE_BVH_H
#define PHOTILE_DEVICE_WIDE_BVH_H

#define PHOTILE_WIDE_NODE_WORDS 56

/* Flag in the word of a child: it is a leaf. */
#define PHOTILE_WIDE_LEAF 0x80000000u

/* Nodes that wait while a path is walked down: seven of each of ten levels, for 2^31 photons fill
   2^28 leaves and each level divides their number by eight, and the last one. */
#define PHOTILE_WIDE_STACK 80

#endif
