#include "trace/hit_batch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "photile/light_layers.hpp"

namespace photile::trace {

PrimaryHits hits_at(std::span<const EyeRecord> records, std::span<const HitPlace> places) {
  const bool glossy = std::any_of(records.begin(), records.end(),
                                  [](const EyeRecord& record) { return !record.glossy.empty(); });
  const bool parted = std::any_of(records.begin(), records.end(), [](const EyeRecord& record) {
    return std::any_of(record.hits.begin(), record.hits.end(),
                       [](const EyeHit& hit) { return hit.share != 1.0f; });
  });
  PrimaryHits hits;
  hits.position.resize(places.size());
  hits.sided_triangle.resize(places.size());
  hits.pixel.resize(places.size());
  hits.throughput.resize(places.size());
  hits.diffuse_albedo.resize(places.size());
  if (glossy) {
    hits.outgoing.resize(places.size());
    hits.lobe.resize(places.size());
  }
  if (parted) hits.share.resize(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const EyeRecord& record = records[places[i].record];
    const EyeHit& hit = record.hits[places[i].index];
    hits.position[i] = hit.position;
    hits.sided_triangle[i] = hit.sided_triangle;
    hits.pixel[i] = hit.pixel;
    hits.throughput[i] = hit.throughput;
    hits.diffuse_albedo[i] = hit.diffuse_albedo;
    if (parted) hits.share[i] = hit.share;
    if (!glossy) return;
    hits.outgoing[i] = record.glossy[places[i].index].outgoing;
    hits.lobe[i] = record.glossy[places[i].index].lobe;
  });
  return hits;
}

PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows,
                         std::span<const std::uint32_t> map_of) {
  PrimaryHitBatch batch;
  const std::vector<std::uint32_t> layer_of = light_groups_of(rays.scene()).group_of;
  for (const EyeRecord& row : rows) {
    batch.rays += row.rays;
    for (const SeenEmission& seen : row.emission) {
      batch.emission.push_back(seen);
      batch.emission.back().light = layer_of[seen.light];
    }
  }
  for (const EyeRecord& row : rows) {
    batch.emission.insert(batch.emission.end(), row.direct.begin(), row.direct.end());
  }
  // The scene's own box, not the batch's: the order of one pixel's hits, and so the sum the
  // renderer rounds, must not depend on how rows are split into batches.
  batch.hits = hits_at(rows, sorted_places(rows, impl_of(rays).bounds, map_of));
  return batch;
}

}  // namespace photile::trace
