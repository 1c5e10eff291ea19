// Exclusive prefix sum of unsigned integers, in blocks: sum each block, scan the sums (by these
// same kernels), scan each block from its sum. No barriers and no local memory: barriers inside
// loops crawl on CPU runtimes, and a scan is a hundredth of the build.

#ifndef BLOCK
#define BLOCK 2048  // values a work-item sums (512 - 8192)
#endif

// One work-item per block. After: block_sum[b] = sum of values [b * BLOCK, (b + 1) * BLOCK).
__kernel void sum_blocks(uint count, __global const uint* values, uint block_count,
                         __global uint* block_sum) {
  for (uint b = get_global_id(0); b < block_count; b += get_global_size(0)) {
    const uint end = min(count, (b + 1) * BLOCK);
    uint sum = 0;
    for (uint i = b * BLOCK; i < end; ++i) sum += values[i];
    block_sum[b] = sum;
  }
}

// One work-item per block. Before: block_start is the exclusive scan of block_sum.
// After: scanned[i] = sum of values [0, i). values and scanned may be one buffer.
__kernel void scan_blocks(uint count, __global const uint* values, uint block_count,
                          __global const uint* block_start, __global uint* scanned) {
  for (uint b = get_global_id(0); b < block_count; b += get_global_size(0)) {
    const uint end = min(count, (b + 1) * BLOCK);
    uint sum = block_start[b];
    for (uint i = b * BLOCK; i < end; ++i) {
      const uint value = values[i];
      scanned[i] = sum;
      sum += value;
    }
  }
}
