// Nearest photons in a hashed grid in space: the cells around the hit's, shell by shell, until no
// cell of a shell can be within the cut.

#include "structures/search.clh"

// How far a position lies outside of cell i along an axis, in cells.
static float cells_to(float position, int i) {
  return fmax(fmax((float)i - position, position - (float)(i + 1)), 0.0f);
}

// Words hold one PhotileHashedGrid.
static void find_nearest(Search* search, const Structure* in, uint photons, NearestList* list) {
  __global const PhotileHashedGrid* grid = (__global const PhotileHashedGrid*)in->nodes;
  search->grid = grid;
  const float3 hit = search->hit;
  const float3 low = (float3)(grid->low_x, grid->low_y, grid->low_z);
  const float3 high = (float3)(grid->high_x, grid->high_y, grid->high_z);
  if (squared_length(fmax(fmax(low - hit, hit - high), 0.0f)) > list->outer_bound) return;

  const float3 position = position_in_cells(grid, hit);
  const int3 centre = convert_int3_rtn(position);
  const int3 last = hashed_cell_of(grid, high);
  // The rounding of positions, in cells: they are quotients with a few roundings.
  const float3 largest = fmax(fabs(position), convert_float3(last));
  const float slack = 1e-6f * (1.0f + fmax(fmax(largest.x, largest.y), largest.z));
  const float3 inside = position - convert_float3(centre);
  const float3 to_border = fmin(inside, 1.0f - inside);
  const float margin = fmin(fmin(to_border.x, to_border.y), to_border.z) - slack;
  const int shells = (int)(sqrt(list->outer_bound) * grid->inverse_cell_side + slack) + 1;
  for (int shell = 0; shell <= shells; ++shell) {
    const float to_shell = fmax((float)(shell - 1) + margin, 0.0f) * grid->cell_side;
    if (shell > 0 && to_shell * to_shell > cut_of(list)) break;
    const int3 from = max(centre - shell, (int3)(0)), to = min(centre + shell, last);
    for (int z = from.z; z <= to.z; ++z) {
      const float dz = cells_to(position.z, z);
      for (int y = from.y; y <= to.y; ++y) {
        const float dy = cells_to(position.y, y);
        const bool whole_row = abs(z - centre.z) == (uint)shell || abs(y - centre.y) == (uint)shell;
        // Only the two ends of other rows belong to the shell.
        const int step = whole_row ? 1 : 2 * shell;
        for (int x = whole_row ? from.x : centre.x - shell; x <= centre.x + shell; x += step) {
          if (x < from.x || x > to.x) continue;
          const float dx = cells_to(position.x, x);
          const float gap =
              fmax(sqrt((dx * dx + dy * dy) + dz * dz) - 2.0f * slack, 0.0f) * grid->cell_side;
          if (gap * gap > cut_of(list)) continue;
          ++search->nodes;
          search->cell = (int3)(x, y, z);
          const uint bucket = bucket_of(grid, search->cell);
          offer_records(search, in->cell_start[bucket], in->cell_start[bucket + 1], list);
        }
      }
    }
  }
}

#include "structures/kernels.clh"
