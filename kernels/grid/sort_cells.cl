// Build, step 6: bring the photons of each cell into ascending order. Work-items scatter in any
// order; sorted, the map is the same on every run and runtime.

// Cells up to this size are sorted by insertion, larger ones by heap sort (a million photons may
// lie in one point).
#ifndef INSERTION_LIMIT
#define INSERTION_LIMIT 48  // (16 - 64)
#endif

void insertion_sort(__global uint* values, uint count) {
  for (uint i = 1; i < count; ++i) {
    const uint value = values[i];
    uint j = i;
    for (; j > 0 && values[j - 1] > value; --j) values[j] = values[j - 1];
    values[j] = value;
  }
}

// Moves values[root] down until the max-heap below it is restored.
void sift_down(__global uint* values, uint root, uint count) {
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

void heap_sort(__global uint* values, uint count) {
  for (uint root = count / 2; root-- > 0;) sift_down(values, root, count);
  for (uint last = count - 1; last > 0; --last) {
    const uint largest = values[0];
    values[0] = values[last];
    values[last] = largest;
    sift_down(values, 0, last);
  }
}

// One work-item per cell.
__kernel void sort_cells(uint cell_count, __global const uint* cell_start,
                         __global uint* entry_photon) {
  for (uint cell = get_global_id(0); cell < cell_count; cell += get_global_size(0)) {
    const uint start = cell_start[cell];
    const uint count = cell_start[cell + 1] - start;
    if (count <= INSERTION_LIMIT) {
      insertion_sort(entry_photon + start, count);
    } else {
      heap_sort(entry_photon + start, count);
    }
  }
}
