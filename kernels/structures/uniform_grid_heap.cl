// The cells of the grid, with a list of the nearest in place of its selection: the difference of
// its time from the grid is due to the list, and that from a kd-tree to the structure.
#include "estimate/block.clh"
#include "structures/search.clh"

// Offers the rows of the block, from that of the hit outwards.
static void offer_block(Search* search, const Structure* in, const Block* block, uint home,
                        NearestList* list) {
  for (uint i = 0; i < 2 * block->height; ++i) {
    const int row = (int)home + ((i & 1) ? (int)(i + 1) / 2 : -(int)i / 2);
    if (row < 0 || row >= (int)block->height) continue;
    const uint cell = block->first_cell + (uint)row * block->columns;
    ++search->nodes;
    offer_records(search, in->cell_start[cell], in->cell_start[cell + block->width], list);
  }
}

static void find_nearest(Search* search, const Structure* in, uint photons, NearestList* list) {
  __global const PhotileGrid* grid = &in->frames[photons];
  if (grid->columns == 0) return;
  const float2 hit = project(search->hit, grid);
  const float radius = sqrt(list->outer_bound);
  Block block;
  float reach = reach_for(list->capacity, radius, 0.0f, hit, grid, in->cell_start, &block);
  for (;;) {
    block_within(reach, hit, grid, &block);
    const uint first_row = (block.first_cell - grid->first_cell) / grid->columns;
    offer_block(search, in, &block, (uint)cell_of(hit, grid).y - first_row, list);
    if (reach >= radius || cut_of(list) <= reach * reach) return;
    reach = fmin(radius, list->size < list->capacity ? 1.4f * reach
                                                     : sqrt(cut_of(list)) * 1.000001f);
    list->size = 0;
  }
}

#include "structures/kernels.clh"
