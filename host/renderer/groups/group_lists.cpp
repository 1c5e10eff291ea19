#include "groups/group_lists.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "common/value_range.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::groups {
namespace {

constexpr std::size_t triangles_per_chunk = 256;

/// Members that one neighbour adds to the group of either side.
std::uint32_t members_of(std::uint32_t neighbour) {
  return (neighbour & equal_sides ? 1 : 0) + (neighbour & opposite_sides ? 1 : 0);
}

/// Neighbours of the triangles of one chunk, one ascending list after the other.
struct Chunk {
  std::vector<std::uint32_t> neighbours;
  std::vector<std::uint32_t> list_sizes;   ///< per triangle: neighbours
  std::vector<std::uint64_t> group_sizes;  ///< per sided triangle: members
};

std::vector<Chunk> find_chunks(std::size_t triangle_count, double radius,
                               const AppendNeighbours& append_neighbours,
                               std::span<const std::uint8_t> landed, Progress& progress) {
  std::vector<Chunk> chunks((triangle_count + triangles_per_chunk - 1) / triangles_per_chunk);
  std::atomic<std::uint64_t> total_members{0};
  tbb::enumerable_thread_specific<std::vector<std::uint32_t>> scratch;
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    progress.throw_if_cancelled();
    const std::size_t first = c * triangles_per_chunk;
    const std::size_t last = std::min(first + triangles_per_chunk, triangle_count);
    std::vector<std::uint32_t>& neighbours = scratch.local();
    neighbours.clear();
    for (std::size_t triangle = first; triangle < last; ++triangle) {
      const std::size_t before = neighbours.size();
      std::uint64_t members = 0;
      const auto wanted = [&](std::size_t side) {
        return landed.empty() || landed[2 * triangle + side] != 0;
      };
      if (wanted(0) || wanted(1)) {
        append_neighbours(static_cast<std::uint32_t>(triangle), neighbours);
      }
      // Both groups have one size: what agrees with a normal is the mirror image of what agrees
      // with its opposite.
      const std::uint64_t group_size = std::accumulate(
          neighbours.begin() + static_cast<std::ptrdiff_t>(before), neighbours.end(),
          std::uint64_t{0},
          [](std::uint64_t sum, std::uint32_t neighbour) { return sum + members_of(neighbour); });
      chunks[c].list_sizes.push_back(static_cast<std::uint32_t>(neighbours.size() - before));
      for (const std::size_t side : {0u, 1u}) {
        chunks[c].group_sizes.push_back(wanted(side) ? group_size : 0);
        members += chunks[c].group_sizes.back();
      }
      if ((total_members += members) > limits::max_group_members) {
        throw UsageError(fmt::format(
            "radius: {} m puts more than {} members into the neighbour groups of {} triangles; "
            "give a smaller radius or group angle",
            radius, limits::max_group_members, triangle_count));
      }
    }
    chunks[c].neighbours.assign(neighbours.begin(), neighbours.end());
    progress.advance(last - first);
  });
  return chunks;
}

/// Writes the groups of both sides of a chunk's triangles from members[offset] on.
void write_groups(const Chunk& chunk, std::uint32_t* members) {
  const std::uint32_t* list = chunk.neighbours.data();
  for (std::size_t triangle = 0; triangle < chunk.list_sizes.size(); ++triangle) {
    const std::uint32_t size = chunk.list_sizes[triangle];
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (chunk.group_sizes[2 * triangle + side] == 0) continue;
      for (std::uint32_t i = 0; i < size; ++i) {
        const std::uint32_t neighbour = list[i] / 4;
        const bool agrees_with_0 = list[i] & (side == 0 ? equal_sides : opposite_sides);
        const bool agrees_with_1 = list[i] & (side == 0 ? opposite_sides : equal_sides);
        if (agrees_with_0) *members++ = sided(neighbour, 0);
        if (agrees_with_1) *members++ = sided(neighbour, 1);
      }
    }
    list += size;
  }
}

}  // namespace

void check(const NeighbourGroupParameters& parameters) {
  if (!(parameters.radius > 0 && parameters.radius <= limits::max_radius)) {
    throw UsageError(fmt::format(
        "radius: {} m is out of range; give a positive number of metres, at most {:.3g}",
        parameters.radius, limits::max_radius));
  }
  check_setting("angle_degrees", setting_value(parameters.angle_degrees));
}

NeighbourGroups collect_groups(std::size_t triangle_count,
                               const NeighbourGroupParameters& parameters,
                               const AppendNeighbours& append_neighbours, Progress& progress,
                               std::span<const std::uint8_t> landed) {
  progress.begin("find neighbour groups", triangle_count, "triangles");
  NeighbourGroups result;
  result.radius = parameters.radius;
  result.angle_degrees = parameters.angle_degrees;

  std::vector<Chunk> chunks =
      find_chunks(triangle_count, parameters.radius, append_neighbours, landed, progress);

  result.offsets.reserve(2 * triangle_count + 1);
  result.offsets.push_back(0);
  for (const Chunk& chunk : chunks) {
    for (const std::uint64_t size : chunk.group_sizes) {
      result.offsets.push_back(result.offsets.back() + size);
    }
  }
  result.members.resize(result.offsets.back());
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    const std::uint64_t first = result.offsets[2 * c * triangles_per_chunk];
    write_groups(chunks[c], result.members.data() + first);
    chunks[c] = {};
  });
  progress.end();
  return result;
}

}  // namespace photile::groups
