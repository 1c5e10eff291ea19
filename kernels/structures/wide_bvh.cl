// Nearest photons in a bounding volume hierarchy of nodes with eight children and leaves of eight
// photons, both tested as one vector; the idea is that of Wald, Benthin and Boulos, "Getting rid of
// packets" (2008). Nearest children first, with a stack.

#include "structures/search.clh"
#include "structures/wide_bvh.h"

typedef struct {
  uint node;
  float squared_distance;
} Pending;

// How far the hit lies outside of the intervals of eight boxes along an axis.
static float8 distances_along(float hit, __global const float* low, __global const float* high) {
  return fmax(fmax(vload8(0, low) - hit, hit - vload8(0, high)), (float8)(0.0f));
}

// Nodes are those of structures/wide_bvh.h, the root first.
static void find_nearest(Search* search, const Structure* in, uint photons, NearestList* list) {
  Pending stack[PHOTILE_WIDE_STACK];
  int depth = 0;
  Pending here = {0, 0.0f};
  for (;;) {
    if (here.squared_distance <= cut_of(list)) {
      if (here.node & PHOTILE_WIDE_LEAF) {
        const uint first = (here.node & ~PHOTILE_WIDE_LEAF) * 8;
        offer_records(search, first, min(first + 8, in->record_count), list);
      } else {
        ++search->nodes;
        __global const uint* node = in->nodes + (size_t)here.node * PHOTILE_WIDE_NODE_WORDS;
        __global const float* box = (__global const float*)node;
        const float8 dx = distances_along(search->hit.x, box, box + 24);
        const float8 dy = distances_along(search->hit.y, box + 8, box + 32);
        const float8 dz = distances_along(search->hit.z, box + 16, box + 40);
        float distances[8];
        vstore8((dx * dx + dy * dy) + dz * dz, 0, distances);
        const int bottom = depth;
        for (int i = 0; i < 8; ++i) {
          const Pending child = {node[48 + i], distances[i]};
          // Missing boxes are infinitely far.
          if (child.squared_distance > cut_of(list)) continue;
          int slot = depth++;  // the nearest on top
          for (; slot > bottom && stack[slot - 1].squared_distance < child.squared_distance;
               --slot) {
            stack[slot] = stack[slot - 1];
          }
          stack[slot] = child;
        }
      }
    }
    if (depth == 0) break;
    here = stack[--depth];
  }
}

#include "structures/kernels.clh"
