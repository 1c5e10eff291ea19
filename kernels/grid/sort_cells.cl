// Build, step 6: put the photons of each cell into ascending order. Work-items scatter in any
// order; sorted, the map is the same on every run and runtime.
//
// Cells up to PHOTILE_INSERTION_LIMIT are sorted by insertion, larger ones by heap sort, or with
// IN_GROUPS by a group: on a GPU one work-item alone takes minutes (a million photons may lie in
// one point).

#include "photile/device/constants.h"
#include "shared/symbols.clh"

static void insertion_sort(__global uint* values, uint count) {
  for (uint i = 1; i < count; ++i) {
    const uint value = values[i];
    uint j = i;
    for (; j > 0 && values[j - 1] > value; --j) values[j] = values[j - 1];
    values[j] = value;
  }
}

// Moves values[root] down until the max-heap below it is restored.
static void sift_down(__global uint* values, uint root, uint count) {
  const uint value = values[root];
  uint child = 2 * root + 1;
  while (child < count) {
    if (child + 1 < count && values[child + 1] > values[child]) ++child;
    if (values[child] <= value) break;
    values[root] = values[child];
    root = child;
    child = 2 * root + 1;
  }
  values[root] = value;
}

static void heap_sort(__global uint* values, uint count) {
  for (uint root = count / 2; root-- > 0;) sift_down(values, root, count);
  for (uint last = count - 1; last > 0; --last) {
    const uint largest = values[0];
    values[0] = values[last];
    values[last] = largest;
    sift_down(values, 0, last);
  }
}

// One work-item per cell: sorts it, or with IN_GROUPS lists crowded ones in crowded_cell. Before:
// crowded[0] is zero.
__kernel void sort_cells(uint cell_count, __global const uint* restrict cell_start,
                         __global uint* restrict record_photon, __global uint* restrict crowded,
                         __global uint* restrict crowded_cell) {
  for (uint cell = get_global_id(0); cell < cell_count; cell += get_global_size(0)) {
    const uint start = cell_start[cell];
    const uint count = cell_start[cell + 1] - start;
    if (count <= PHOTILE_INSERTION_LIMIT) {
      insertion_sort(record_photon + start, count);
    } else if (IN_GROUPS) {
      crowded_cell[atomic_inc(crowded)] = cell;
    } else {
      heap_sort(record_photon + start, count);
    }
  }
}

#if IN_GROUPS

#define SORT_GROUP PHOTILE_COOPERATIVE_GROUP

// One group per crowded cell, in turn. The order of the list does not matter: the exchanges of a
// cell are those of Batcher's merge exchange (Knuth, "The Art of Computer Programming", 5.2.2,
// algorithm M), for any number of values.
__kernel __attribute__((reqd_work_group_size(SORT_GROUP, 1, 1))) void sort_crowded(
    __global const uint* restrict cell_start, __global uint* restrict record_photon,
    __global const uint* restrict crowded, __global const uint* restrict crowded_cell) {
  const uint cells = crowded[0];
  for (uint i = get_group_id(0); i < cells; i += get_num_groups(0)) {
    const uint cell = crowded_cell[i];
    __global uint* values = record_photon + cell_start[cell];
    const uint count = cell_start[cell + 1] - cell_start[cell];
    const uint top = 1u << (31 - clz(count - 1u));  // the largest power of two below count
    for (uint p = top; p > 0; p /= 2) {
      uint q = top, rest = 0, distance = p;
      for (;;) {
        for (uint at = get_local_id(0); at + distance < count; at += SORT_GROUP) {
          if ((at & p) != rest) continue;
          const uint low = values[at], high = values[at + distance];
          if (low > high) {
            values[at] = high;
            values[at + distance] = low;
          }
        }
        barrier(CLK_GLOBAL_MEM_FENCE);
        if (q == p) break;
        distance = q - p;
        q /= 2;
        rest = p;
      }
    }
  }
}

#endif
