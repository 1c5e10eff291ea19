#include "trace/hit_batch.hpp"

#include <tbb/parallel_for.h>

#include <utility>

#include "photile/light_groups.hpp"
#include "trace/hit_order.hpp"

namespace photile::trace {
namespace {

/// One record of all rows, in their order.
EyeRecord concatenate(std::vector<EyeRecord>& rows) {
  EyeRecord all;
  std::size_t hits = 0, emission = 0, direct = 0;
  for (const EyeRecord& row : rows) {
    hits += row.hits.size();
    emission += row.emission.size();
    direct += row.direct.size();
    all.rays += row.rays;
  }
  all.hits.reserve(hits);
  all.emission.reserve(emission + direct);
  all.direct.reserve(direct);
  for (EyeRecord& row : rows) {
    all.hits.insert(all.hits.end(), row.hits.begin(), row.hits.end());
    all.emission.insert(all.emission.end(), row.emission.begin(), row.emission.end());
    all.direct.insert(all.direct.end(), row.direct.begin(), row.direct.end());
    row = {};
  }
  return all;
}

template <class T>
std::vector<T> gather(const std::vector<EyeHit>& hits, const std::vector<std::uint32_t>& order,
                      T EyeHit::*member) {
  std::vector<T> values(order.size());
  tbb::parallel_for(std::size_t{0}, order.size(),
                    [&](std::size_t i) { values[i] = hits[order[i]].*member; });
  return values;
}

}  // namespace

PrimaryHits in_order(const std::vector<EyeHit>& hits, const std::vector<std::uint32_t>& order,
                     bool glossy) {
  PrimaryHits result;
  result.position = gather(hits, order, &EyeHit::position);
  result.sided_triangle = gather(hits, order, &EyeHit::sided_triangle);
  result.pixel = gather(hits, order, &EyeHit::pixel);
  result.throughput = gather(hits, order, &EyeHit::throughput);
  result.diffuse_albedo = gather(hits, order, &EyeHit::diffuse_albedo);
  if (glossy) {
    result.outgoing = gather(hits, order, &EyeHit::outgoing);
    result.lobe = gather(hits, order, &EyeHit::lobe);
  }
  return result;
}

PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows,
                         std::span<const std::uint32_t> map_of) {
  EyeRecord all = concatenate(rows);
  PrimaryHitBatch batch;
  batch.rays = all.rays;
  batch.emission = std::move(all.emission);
  const std::vector<std::uint32_t> layer_of = light_groups_of(rays.scene()).group_of;
  for (SeenEmission& seen : batch.emission) seen.light = layer_of[seen.light];
  batch.emission.insert(batch.emission.end(), all.direct.begin(), all.direct.end());
  // The scene's own box, not the batch's: the order of one pixel's hits, and so the sum the
  // renderer rounds, must not depend on how rows are split into batches.
  const auto order = sorted_order(all.hits, rays.impl().bounds, map_of);
  batch.hits = in_order(all.hits, order, rays.needs().glossy);
  return batch;
}

}  // namespace photile::trace
