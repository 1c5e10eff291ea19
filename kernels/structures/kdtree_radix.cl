// A kd-tree in the plane of each map, with the selection of the grid: the leaves within reach are
// the rows of a block (estimate/block.clh), and all else is the grid's. The difference of its time
// from kdtree.cl is due to the selection, and that from the grid to the structure.
#define BLOCKS_OF_LEAVES 1
#define TREE_2D 1

#include "grid/cell.clh"
#include "structures/kdtree.h"

#ifndef LEAF_SIZE
#define LEAF_SIZE 64  // photons of a leaf at most
#endif
#ifndef WORDS_PER_ITEM
#define WORDS_PER_ITEM 256  // that a work-item writes for itself
#endif
#define BLOCK_RANGES (WORDS_PER_ITEM / 2)

// Rows are ranges of records, written where cell offsets are read: row r from `ranges[2 * r]` on.
typedef struct {
  uint first_cell, columns, width, height;
  __global const PhotileTreeNode* nodes;
  uint root;
  __global uint* ranges;
} Block;

static void begin_block(Block* block, __global const uint* nodes, uint root,
                        __global uint* ranges) {
  block->first_cell = 0;
  block->columns = 2;
  block->width = 1;
  block->height = 0;
  block->nodes = (__global const PhotileTreeNode*)nodes;
  block->root = root;
  block->ranges = ranges;
}

// Consecutive leaves form a row; the last row takes those for which there is no other.
static void add_row(Block* block, PhotileTreeNode leaf) {
  if (leaf.first == leaf.last) return;
  __global uint* const end = block->ranges + 2 * block->height;
  if (block->height > 0 && (end[-1] == leaf.first || block->height == BLOCK_RANGES)) {
    end[-1] = leaf.last;
    return;
  }
  end[0] = leaf.first;
  end[1] = leaf.last;
  ++block->height;
}

typedef struct {
  uint node;
  float2 offset;  // from the hit to the region, per axis
} PendingLeaf;

static void block_within(float reach, float2 hit, __global const PhotileGrid* grid, Block* block) {
  const float bound = reach + grid->slack;
  PendingLeaf stack[PHOTILE_TREE_DEPTH];
  int depth = 0;
  PendingLeaf here = {block->root, (float2)(0.0f, 0.0f)};
  block->height = 0;
  for (;;) {
    const PhotileTreeNode node = block->nodes[here.node];
    if (node.axis == PHOTILE_TREE_LEAF) {
      add_row(block, node);
    } else {
      const float to_plane = (node.axis == 0 ? hit.x : hit.y) - node.split;
      float2 farther = here.offset;
      if (node.axis == 0) farther.x = to_plane;
      if (node.axis == 1) farther.y = to_plane;
      const bool reaches_both = dot(farther, farther) <= bound * bound;
      // The lower child first, so that records ascend.
      if (to_plane < 0.0f) {
        if (reaches_both) {
          stack[depth].node = node.first;
          stack[depth++].offset = farther;
        }
        here.node = here.node + 1;
        continue;
      }
      if (reaches_both) {
        stack[depth].node = node.first;
        stack[depth++].offset = here.offset;
        here.node = here.node + 1;
        here.offset = farther;
      } else {
        here.node = node.first;
      }
      continue;
    }
    if (depth == 0) return;
    here = stack[--depth];
  }
}

// Leaves extend beyond the disc by half a side; they have some 0.7 LEAF_SIZE photons each.
static float predicted_within(float reach, uint records, const Block* block,
                              __global const PhotileGrid* grid) {
  const float half_width =
      0.5f * fmax(sqrt((float)records) - sqrt(0.7f * (float)LEAF_SIZE), 0.1f * sqrt((float)records));
  return 3.14159265f * half_width * half_width;
}

#include "structures/kdtree.cl"

#include "estimate/estimate_hit.clh"

// As estimate_by_list (structures/kernels.clh); workers take HITS_PER_ITEM hits in a row.
//   rows   WORDS_PER_ITEM per work-item, for its block
__kernel void estimate_by_radix(
    const PhotileQuery query, __global const PhotileHit* restrict hits,
    __global const uint* restrict order,
    __global const PhotileHitSurface* restrict hit_surfaces,
    __global const PhotileHitLobe* restrict hit_lobes, uint record_count,
    __global const uint* restrict root, __global const PhotileGrid* restrict frames,
    __global const uint* restrict nodes, __global const uint* restrict cell_start,
    __global const uint* restrict record_photon, __global const float* restrict record_position,
    __global const float* restrict record_flux, __global const LightIndex* restrict record_light,
    __global const float* restrict record_incoming, __global const float* restrict record_normal,
    __global const PhotileSurfaceNode* restrict surface_nodes,
    __global const PhotileSurfaceLeaf* restrict surface_leaves,
    __global float* restrict list_distance, __global uint* restrict list_record,
    __global uint* restrict rows, __global float* restrict irradiance,
    __global float* restrict radiance, __global ushort* restrict slot_light,
    __global uint* restrict slots_taken) {
  WorkerMemory memory;
  const PhotonRecords records = {query.record_stride, record_photon, record_position,
                                 record_flux,         record_light,  record_incoming};
  const Surface surface = {surface_nodes, surface_leaves, query.least_cosine};
  const Estimates estimates = {irradiance, radiance, slot_light, slots_taken};
  __global uint* const ranges = rows + get_global_id(0) * WORDS_PER_ITEM;
  EmptyRadius empty = NO_EMPTY_RADIUS;
  for (uint begin = get_global_id(0) * HITS_PER_ITEM; begin < query.hit_count;
       begin += get_global_size(0) * HITS_PER_ITEM) {
    const uint end = query.first_hit + min(begin + HITS_PER_ITEM, query.hit_count);
    float expected = 0.0f;
    uint expected_map = 0xFFFFFFFFu;
    for (uint i = query.first_hit + begin; i < end; ++i) {
      const uint index = hit_at(i, order);
      if (!is_on_page(&query, &hits[index])) continue;
      const uint map = hits[index].map;
      const uint tree = root[map - query.first_map];
      if (tree == 0xFFFFFFFFu) continue;
      __global const PhotileGrid* grid = &frames[map - query.first_map];
      if (map != expected_map) expected = 0.0f;
      expected_map = map;
      Hit hit;
      load_hit(index, hits, hit_surfaces, hit_lobes, &hit);
      Candidates candidates;
      begin_candidates(&candidates, &query, grid, ranges, record_photon, record_position,
                     record_normal, &hit);
      begin_block(&candidates.block, nodes, tree, ranges);
      expected = estimate_hit(&candidates, &records, grid, &surface, &hit, &query, expected,
                              &empty, &estimates, &memory);
    }
  }
}
