// The radiance estimate for tiles of hits: VECTOR_WIDTH neighbouring hits share one block of
// candidates (estimate/tile.clh). For maps that many hits lie on; hits that share a map with few
// others, glossy surfaces, many lights and crowded blocks are estimated one by one, as in
// estimate.cl.
//
// Symbols the host defines: those of estimate/estimate.cl, TILE_CAPACITY

#include "estimate/tile.clh"

// Fewer hits than this on a map are estimated one by one.
#define LEAST_TILE (VECTOR_WIDTH / 4 + 1)

#if !defined(GLOSSY) && !defined(MANY_LIGHTS)

// Estimates hits [first, first + count) of one map; count <= VECTOR_WIDTH. Returns false, without
// having written anything, where the hits do not suit a tile. Lanes whose k-th photon ties with the
// next are left in `undone`.
bool estimate_tile(const Entries* entries, __global const PhotileGrid* grid,
                   __global const uint* cell_start, const Hits* hits, uint first, uint count,
                   uint k, float radius, float least_radius, float* expected, int* undone,
                   const Estimates* estimates CLIPPED_PARAMETERS) {
  Tile tile;
  float coordinates[3][VECTOR_WIDTH];
  float2 low = INFINITY, high = -INFINITY;
  for (uint lane = 0; lane < VECTOR_WIDTH; ++lane) {
    const float3 hit = vload3(first + min(lane, count - 1), hits->position);
    coordinates[0][lane] = hit.x;
    coordinates[1][lane] = hit.y;
    coordinates[2][lane] = hit.z;
    const float2 uv = project(hit, grid);
    low = fmin(low, uv);
    high = fmax(high, uv);
  }
  tile.x = wide_load(coordinates[0]);
  tile.y = wide_load(coordinates[1]);
  tile.z = wide_load(coordinates[2]);
  tile.active = WIDE_LANES < (wide_int)((int)count);

  float stored[TILE_CAPACITY * VECTOR_WIDTH];
  const float squared_radius = radius * radius;
  float reach = *expected > 0.0f
                    ? fmin(radius, *expected * 1.15f)
                    : reach_for(k, radius, 0.0f, 0.5f * (low + high), grid, cell_start);
  Block block;
  uint entries_of_block;
  wide_int inside;
  float bound;
  for (;;) {
    block_around(reach, low, high, grid, &block);
    entries_of_block = entries_in(&block, cell_start);
    if (entries_of_block > TILE_CAPACITY) return false;
    bound = fmin(reach * reach, squared_radius);
    inside = store_tile(&tile, entries, &block, cell_start, bound, stored);
    if (reach >= radius || !any_lane(inside < (wide_int)((int)k))) break;
    reach = fmin(radius, 1.2f * reach);
  }

  // Lanes with fewer than k photons within the radius take all of them.
  const wide_int full = inside >= (wide_int)((int)k);
  const wide_int wanted = select(inside, (wide_int)((int)k - 1), full);
  const WideBracket bracket = {0.0f, bound, 0, inside};
  wide_float below = tile_bounds(stored, entries_of_block, wanted, full & tile.active,
                                 *expected * *expected, bracket);
  below = select((wide_float)(as_float(as_int(squared_radius) + 1)), below, full);

  float disc[VECTOR_WIDTH], area[VECTOR_WIDTH];
#ifdef RADIUS_FIRST
  const wide_float nearest = nearest_beyond_lanes(stored, entries_of_block, below);
  const wide_float squared_disc = select((wide_float)(squared_radius), nearest, full);
  wide_store(squared_disc, disc);
#endif
#ifdef WEIGHTED
  const wide_float per_squared_radius = 1.0f / fmax(squared_disc, (least_radius * least_radius));
#endif
#ifdef CLIPPED
  for (uint lane = 0; lane < count; ++lane) {
    Hit hit;
    load_hit(hits, first + lane, &hit);
    // Photons off a hit's plane are left out hit by hit.
    if (clip_disc_of_hit(surface, &hit, disc[lane], least_radius, clearance, area + lane) !=
        INFINITY) {
      return false;
    }
  }
#endif

  wide_float sums[LIGHT_COUNT][3];
  for (uint light = 0; light < LIGHT_COUNT; ++light) {
    sums[light][0] = sums[light][1] = sums[light][2] = 0.0f;
  }
#ifndef RADIUS_FIRST
  wide_float beyond = INFINITY;
#endif
  wide_int found = 0;
  const wide_float zero = 0.0f;
  const float* next = stored;
  uint cell = block.first_cell;
  for (uint row = 0; row < block.height; ++row, cell += block.columns) {
    const uint end = cell_start[cell + block.width];
    for (uint entry = cell_start[cell]; entry < end; ++entry, next += VECTOR_WIDTH) {
      const wide_float d = wide_load(next);
      const wide_int is_near = d < below;
#ifndef RADIUS_FIRST
      beyond = select(fmin(beyond, d), beyond, is_near);
#endif
      found += TRUE_LANES(is_near);
      const uint light = light_of(entries, entry);
#ifdef WEIGHTED
      const wide_float weight = KERNEL_AT(d * per_squared_radius);
      const wide_float red = weight * entries->flux[entry];
      const wide_float green = weight * entries->flux[entries->stride + entry];
      const wide_float blue = weight * entries->flux[2 * entries->stride + entry];
#else
      const wide_float red = entries->flux[entry];
      const wide_float green = entries->flux[entries->stride + entry];
      const wide_float blue = entries->flux[2 * entries->stride + entry];
#endif
      sums[light][0] += select(zero, red, is_near);
      sums[light][1] += select(zero, green, is_near);
      sums[light][2] += select(zero, blue, is_near);
    }
  }

#ifndef RADIUS_FIRST
  wide_store(select((wide_float)(squared_radius), beyond, full), disc);
#endif
#ifndef CLIPPED
  for (uint lane = 0; lane < count; ++lane) area[lane] = estimate_area(disc[lane], least_radius);
#endif
  wide_store((found < wanted) & tile.active, undone);
  for (uint light = 0; light < LIGHT_COUNT; ++light) {
    float lanes[3][VECTOR_WIDTH];
    for (uint c = 0; c < 3; ++c) wide_store(sums[light][c], lanes[c]);
    for (uint lane = 0; lane < count; ++lane) {
      const float per_area = 1.0f / area[lane];
      vstore3((float3)(lanes[0][lane], lanes[1][lane], lanes[2][lane]) * per_area,
              (first + lane) * LIGHT_COUNT + light, estimates->irradiance);
    }
  }
  *expected = sqrt(disc[count - 1]);
  return true;
}

#endif

// One work-item per VECTOR_WIDTH hits; arguments as in estimate/estimate.cl.
__kernel void estimate(uint hit_count, uint first_hit, __global const float* hit_position,
                       __global const uint* hit_map, uint first_map,
                       __global const PhotileGrid* grids, __global const uint* cell_start,
                       uint entry_stride, __global const float* entry_position,
                       __global const float* entry_flux, __global const uint* entry_photon,
                       SCENE_ARGUMENTS uint k, float radius, float least_radius,
                       __global float* irradiance) {
  const Entries entries = GIVEN_ENTRIES;
  const Hits hits = GIVEN_HITS;
  const Estimates estimates = GIVEN_ESTIMATES;
#ifdef CLIPPED
  const Surface surface = GIVEN_SURFACE;
  Clearance clearance = NO_CLEARANCE;
#endif
  const uint begin = get_global_id(0) * VECTOR_WIDTH;
  const uint end = first_hit + min(begin + VECTOR_WIDTH, hit_count);
  for (uint first = first_hit + begin; first < end;) {
    const uint map = hit_map[first];
    uint count = 1;
    while (first + count < end && hit_map[first + count] == map) ++count;
    __global const PhotileGrid* grid = &grids[map - first_map];
    if (grid->columns == 0) {
      first += count;
      continue;
    }
    float expected = 0.0f;
    int undone[VECTOR_WIDTH];
    bool one_by_one = true;
#if !defined(GLOSSY) && !defined(MANY_LIGHTS)
    // Hits on a mixed map differ in which candidates they may take.
    if (count >= LEAST_TILE && k > 1 && !grid->mixed) {
      one_by_one = !estimate_tile(&entries, grid, cell_start, &hits, first, count, k, radius,
                                  least_radius, &expected, undone, &estimates CLIPPED_VALUES);
    }
#endif
    for (uint i = 0; i < count; ++i) {
      if (!one_by_one && !undone[i]) continue;
      Hit hit;
      load_hit(&hits, first + i, &hit);
      expected = estimate_hit(&entries, grid, cell_start, &hit, k, radius, least_radius, expected,
                              &estimates CLIPPED_VALUES);
    }
    first += count;
  }
}
