#include "trace/hit_batch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "common/touched_memory.hpp"
#include "geometry/radix_sort.hpp"
#include "photile/light_layers.hpp"

namespace photile::trace {

namespace {

constexpr std::uint32_t cells_per_axis = 1u << HitCells::bits_per_axis;
constexpr int code_bits = 3 * HitCells::bits_per_axis;
constexpr std::uint32_t no_map = (1u << (64 - code_bits)) - 1;  // after all others, within 64 bits

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

namespace {

/// Brings the hits of each pixel into the order map, Morton code of their cell, sample: the order
/// of the sum of a pixel's light must not depend on how its samples were traced.
void sort_in_pixels(EyeRecord& row, std::uint32_t runs, const HitCells& cells,
                    std::span<const std::uint32_t> map_of) {
  const std::vector<EyeHit>& hits = row.hits;
  std::vector<std::pair<std::uint64_t, std::size_t>> keys;  // of a pixel's hits, and their numbers
  for (std::size_t first = 0, last = 0; first < hits.size(); first = last) {
    while (last < hits.size() && hits[last].pixel / runs == hits[first].pixel / runs) ++last;
    if (last - first < 2) continue;
    keys.clear();
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t own = hits[i].oriented_face;
      const std::uint64_t map = std::min(map_of.empty() ? own : map_of[own], no_map);
      keys.emplace_back(map << code_bits | cells.morton_code(hits[i].position), i);
    }
    std::sort(keys.begin(), keys.end());
    const auto sort = [&](auto& values) {
      if (values.empty()) return;
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector before(begin, begin + static_cast<std::ptrdiff_t>(last - first));
      for (std::size_t i = 0; i < keys.size(); ++i) {
        values[first + i] = before[keys[i].second - first];
      }
    };
    sort(row.hits);
    sort(row.glossy);
  }
}

}  // namespace

PrimaryHits hits_of(std::span<const EyeRecord> records) {
  std::vector<std::size_t> first{0};
  for (const EyeRecord& record : records) first.push_back(first.back() + record.hits.size());
  const std::size_t count = first.back();
  const auto for_each = [&](const auto& visit) {
    tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t record) {
      tbb::parallel_for(std::size_t{0}, records[record].hits.size(),
                        [&](std::size_t i) { visit(records[record], i, first[record] + i); });
    });
  };
  const bool glossy = std::any_of(records.begin(), records.end(),
                                  [](const EyeRecord& record) { return !record.glossy.empty(); });
  std::atomic<bool> split = false;
  for_each([&](const EyeRecord& record, std::size_t i, std::size_t) {
    if (record.hits[i].fraction != 1.0f) split = true;
  });
  PrimaryHits hits;
  hits.position = touched_vector<glm::vec3>(count);
  hits.oriented_face = touched_vector<std::uint32_t>(count);
  hits.pixel = touched_vector<std::uint32_t>(count);
  hits.throughput = touched_vector<glm::vec3>(count);
  hits.diffuse_albedo = touched_vector<glm::vec3>(count);
  if (glossy) {
    hits.outgoing = touched_vector<glm::vec3>(count);
    hits.lobe.resize(count);
  }
  if (split) hits.fraction.resize(count);
  for_each([&](const EyeRecord& record, std::size_t i, std::size_t to) {
    const EyeHit& hit = record.hits[i];
    hits.position[to] = hit.position;
    hits.oriented_face[to] = hit.oriented_face;
    hits.pixel[to] = hit.pixel;
    hits.throughput[to] = hit.throughput;
    hits.diffuse_albedo[to] = hit.diffuse_albedo;
    if (split) hits.fraction[to] = hit.fraction;
    if (!glossy) return;
    hits.outgoing[to] = record.glossy[i].outgoing;
    hits.lobe[to] = record.glossy[i].lobe;
  });
  return hits;
}

PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows, int runs,
                         std::span<const std::uint32_t> map_of) {
  PrimaryHitBatch batch;
  const std::vector<std::uint32_t> layer_of = light_groups_of(rays.scene()).group_of;
  // The scene's own box, not the batch's: the order of one pixel's hits, and so the sum the
  // renderer rounds, must not depend on how rows are split into batches.
  const HitCells cells(impl_of(rays).bounds);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t row) {
    sort_in_pixels(rows[row], static_cast<std::uint32_t>(runs), cells, map_of);
    for (VisibleEmission& seen : rows[row].emission) seen.light = layer_of[seen.light];
  });
  for (const EyeRecord& row : rows) batch.rays += row.rays;
  batch.emission = joined(
      2 * rows.size(), [&](std::size_t i) -> const auto& {
        return i < rows.size() ? rows[i].emission : rows[i - rows.size()].direct;
      });
  batch.hits = hits_of(rows);
  return batch;
}

}  // namespace photile::trace
