// Exclusive prefix sum of unsigned integers, in blocks: sum each block, scan the sums (by these
// same kernels), scan each block from its sum. On CPUs a work-item does a block, without barriers
// and local memory: barriers inside loops are very slow there, and a scan is a hundredth of the
// build. Elsewhere (IN_GROUPS) a group does, in local memory.

#include "photile/device/constants.h"
#include "shared/symbols.clh"

// Arguments of both kernels:
//   block_size   values of a block (512 - 8192), a multiple of PHOTILE_COOPERATIVE_GROUP

#if IN_GROUPS

#define SCAN_GROUP PHOTILE_COOPERATIVE_GROUP

// The sum of the work-item's part of a block, consecutive values.
static uint sum_of_part(__global const uint* values, uint begin, uint end) {
  uint sum = 0;
  for (uint i = begin; i < end; ++i) sum += values[i];
  return sum;
}

// Hillis and Steele, "Data parallel algorithms" (1986). After: sums[SCAN_GROUP - 1] is the sum of
// all values; the result is the sum of the work-items before this one.
static uint scan_group(uint value, __local uint* sums) {
  const uint item = (uint)get_local_id(0);
  sums[item] = value;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (uint step = 1; step < SCAN_GROUP; step *= 2) {
    const uint before = item >= step ? sums[item - step] : 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    sums[item] += before;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  return sums[item] - value;
}

// One group per block. After: as below.
__kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void sum_blocks(
    uint count, __global const uint* restrict values, uint block_size, uint block_count,
    __global uint* restrict block_sum) {
  __local uint sums[SCAN_GROUP];
  const uint item = (uint)get_local_id(0), b = (uint)get_group_id(0);
  const uint part = block_size / SCAN_GROUP;
  const uint begin = b < block_count ? b * block_size + item * part : count;
  const uint sum = sum_of_part(values, begin, min(count, begin + part));
  const uint before = scan_group(sum, sums);
  if (item == SCAN_GROUP - 1 && b < block_count) block_sum[b] = before + sum;
}

// One group per block. Before and after: as below.
__kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void scan_blocks(
    uint count, __global const uint* values, uint block_size, uint block_count,
    __global const uint* block_start, __global uint* scanned) {
  __local uint sums[SCAN_GROUP];
  const uint item = (uint)get_local_id(0), b = (uint)get_group_id(0);
  const uint part = block_size / SCAN_GROUP;
  const uint begin = b < block_count ? b * block_size + item * part : count;
  const uint end = min(count, begin + part);
  uint sum = scan_group(sum_of_part(values, begin, end), sums);
  if (begin < end) sum += block_start[b];
  for (uint i = begin; i < end; ++i) {
    const uint value = values[i];
    scanned[i] = sum;
    sum += value;
  }
}

#else

// One work-item per block. After: block_sum[b] = sum of values
// [b * block_size, (b + 1) * block_size).
__kernel void sum_blocks(uint count, __global const uint* restrict values, uint block_size,
                         uint block_count, __global uint* restrict block_sum) {
  for (uint b = get_global_id(0); b < block_count; b += get_global_size(0)) {
    const uint end = min(count, (b + 1) * block_size);
    uint sum = 0;
    for (uint i = b * block_size; i < end; ++i) sum += values[i];
    block_sum[b] = sum;
  }
}

// One work-item per block. Before: block_start is the exclusive scan of block_sum.
// After: scanned[i] = sum of values [0, i). values and scanned may be one buffer.
__kernel void scan_blocks(uint count, __global const uint* values, uint block_size,
                          uint block_count, __global const uint* block_start,
                          __global uint* scanned) {
  for (uint b = get_global_id(0); b < block_count; b += get_global_size(0)) {
    const uint end = min(count, (b + 1) * block_size);
    uint sum = block_start[b];
    for (uint i = b * block_size; i < end; ++i) {
      const uint value = values[i];
      scanned[i] = sum;
      sum += value;
    }
  }
}

#endif
