/* Sizes of what the lanes of a group share in local memory (kernels/estimate/lane_memory.clh), as C++
   and OpenCL C both see them: the host counts it before it compiles. */
#ifndef PHOTILE_DEVICE_LANE_MEMORY_H
#define PHOTILE_DEVICE_LANE_MEMORY_H

/* Reductions combine lanes that lie so far apart, then these columns. */
#define PHOTILE_LANE_COLUMNS 8

/* Leaves of the surface's tree that wait for lanes: a power of two, at least 7 more than the widest
   group has lanes over eight. */
#define PHOTILE_LEAF_QUEUE 16

#endif
