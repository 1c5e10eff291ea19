#include "trace/hit_batch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>

#include "common/touched_memory.hpp"
#include "geometry/radix_sort.hpp"
#include "photile/light_layers.hpp"

namespace photile::trace {

namespace {

constexpr std::uint32_t cells_per_axis = 1u << HitCells::bits_per_axis;
constexpr int code_bits = 3 * HitCells::bits_per_axis;
constexpr std::uint32_t no_map = (1u << (64 - code_bits)) - 1;  // after all others, within 64 bits

struct Key {
  std::uint64_t order;   ///< map, Morton code
  std::uint32_t number;  ///< of the hit, counted through all records
};

}  // namespace

HitCells::HitCells(const geometry::Box& box) : low_(box.lower) {
  const glm::vec3 extent = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (extent[axis] > 0) cells_per_metre_[axis] = float{cells_per_axis} / extent[axis];
  }
}

std::uint64_t HitCells::morton_code(const glm::vec3& position) const {
  const glm::vec3 cell = cells_per_metre_ * (position - low_);
  return geometry::morton_code(glm::uvec3(glm::clamp(cell, 0.0f, float{cells_per_axis - 1})));
}

std::vector<HitIndex> sorted_indices(std::span<const EyeRecord> records, const geometry::Box& box,
                                     std::span<const std::uint32_t> map_of) {
  std::vector<std::uint32_t> first{0};
  for (const EyeRecord& record : records) {
    first.push_back(first.back() + static_cast<std::uint32_t>(record.hits.size()));
  }
  const HitCells cells(box);
  std::vector<Key> keys(first.back());
  std::vector<std::uint32_t> record_of(first.back());
  std::vector<std::uint32_t> last_map(records.size());
  tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t record) {
    std::uint32_t number = first[record];
    for (const EyeHit& hit : records[record].hits) {
      const std::uint32_t own = hit.oriented_face;
      const std::uint32_t map = std::min(map_of.empty() ? own : map_of[own], no_map);
      last_map[record] = std::max(last_map[record], map);
      keys[number] = {std::uint64_t{map} << code_bits | cells.morton_code(hit.position), number};
      record_of[number++] = static_cast<std::uint32_t>(record);
    }
  });
  std::uint32_t last = 0;
  for (const std::uint32_t map : last_map) last = std::max(last, map);
  geometry::radix_sort(keys, code_bits + std::bit_width(last),
                       [](const Key& key) { return key.order; });
  std::vector<HitIndex> indices(keys.size());
  tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
    const std::uint32_t record = record_of[keys[i].number];
    indices[i] = {record, keys[i].number - first[record]};
  });
  return indices;
}

PrimaryHits hits_at(std::span<const EyeRecord> records, std::span<const HitIndex> indices) {
  const bool glossy = std::any_of(records.begin(), records.end(),
                                  [](const EyeRecord& record) { return !record.glossy.empty(); });
  std::atomic<bool> split = false;
  tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t i) {
    const std::vector<EyeHit>& of_record = records[i].hits;
    if (std::any_of(of_record.begin(), of_record.end(),
                    [](const EyeHit& hit) { return hit.fraction != 1.0f; })) {
      split = true;
    }
  });
  PrimaryHits hits;
  hits.position.resize(indices.size());
  hits.oriented_face.resize(indices.size());
  hits.pixel.resize(indices.size());
  hits.throughput.resize(indices.size());
  hits.diffuse_albedo.resize(indices.size());
  if (glossy) {
    hits.outgoing.resize(indices.size());
    hits.lobe.resize(indices.size());
  }
  if (split) hits.fraction.resize(indices.size());
  tbb::parallel_for(std::size_t{0}, indices.size(), [&](std::size_t i) {
    const EyeRecord& record = records[indices[i].record];
    const EyeHit& hit = record.hits[indices[i].index];
    hits.position[i] = hit.position;
    hits.oriented_face[i] = hit.oriented_face;
    hits.pixel[i] = hit.pixel;
    hits.throughput[i] = hit.throughput;
    hits.diffuse_albedo[i] = hit.diffuse_albedo;
    if (split) hits.fraction[i] = hit.fraction;
    if (!glossy) return;
    hits.outgoing[i] = record.glossy[indices[i].index].outgoing;
    hits.lobe[i] = record.glossy[indices[i].index].lobe;
  });
  return hits;
}

PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows,
                         std::span<const std::uint32_t> map_of) {
  PrimaryHitBatch batch;
  const std::vector<std::uint32_t> layer_of = light_groups_of(rays.scene()).group_of;
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t row) {
    for (VisibleEmission& seen : rows[row].emission) seen.light = layer_of[seen.light];
  });
  for (const EyeRecord& row : rows) batch.rays += row.rays;
  batch.emission = joined(
      2 * rows.size(), [&](std::size_t i) -> const auto& {
        return i < rows.size() ? rows[i].emission : rows[i - rows.size()].direct;
      });
  // The scene's own box, not the batch's: the order of one pixel's hits, and so the sum the
  // renderer rounds, must not depend on how rows are split into batches.
  batch.hits = hits_at(rows, sorted_indices(rows, impl_of(rays).bounds, map_of));
  return batch;
}

}  // namespace photile::trace
