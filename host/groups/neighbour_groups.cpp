#include "photile/neighbour_groups.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "groups/proximity_test.hpp"
#include "groups/triangle_bvh.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

using groups::ProximityTest;
using groups::TriangleBound;
using groups::TriangleBvh;

constexpr std::size_t triangles_per_chunk = 256;

/// Rounding slack of the normal test, so that normals folded by exactly the angle agree although
/// their vertices were rounded to float.
constexpr double cosine_slack = 1e-6;

// A neighbour of a triangle is kept as 4 * its index + these bits until the groups of both sides
// are written: equal sides agree, opposite sides agree.
constexpr std::uint32_t equal_sides = 1, opposite_sides = 2;

std::uint32_t agreeing_sides(const glm::dvec3& a, const glm::dvec3& b, double cos_angle) {
  // In single precision, as kernels/kdtree/traverse.clh filters: facets of a cylinder may meet the
  // angle within rounding, and every structure must decide alike.
  const glm::vec3 u(a), v(b);
  const float cosine = (u.x * v.x + u.y * v.y) + u.z * v.z;
  const float least = static_cast<float>(cos_angle - cosine_slack);
  return (cosine >= least ? equal_sides : 0) | (-cosine >= least ? opposite_sides : 0);
}

/// Members that one neighbour adds to the group of either side.
std::uint32_t members_of(std::uint32_t neighbour) {
  return (neighbour & equal_sides ? 1 : 0) + (neighbour & opposite_sides ? 1 : 0);
}

/// Neighbours of the triangles of one chunk, one ascending list after the other.
struct Chunk {
  std::vector<std::uint32_t> neighbours;
  std::vector<std::uint32_t> list_sizes;  ///< per triangle: neighbours
  /// Per triangle: members of the group of either side. Both groups have one size: what agrees with
  /// a normal is the mirror image of what agrees with its opposite.
  std::vector<std::uint64_t> group_sizes;
};

class Search {
 public:
  Search(const Scene& scene, const NeighbourGroupParameters& parameters)
      : scene_(scene),
        radius_(parameters.radius),
        cos_angle_(std::cos(glm::radians(parameters.angle_degrees))),
        bvh_(scene),
        proximity_(scene, parameters.radius),
        bounds_(scene.triangle_count()) {
    tbb::parallel_for(std::size_t{0}, bounds_.size(),
                      [&](std::size_t i) { bounds_[i] = proximity_.bound(bvh_.order()[i]); });
  }

  /// Appends the neighbours of `triangle`, itself among them, ascending.
  void append_neighbours(std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) const {
    const std::size_t first_of_list = neighbours.size();
    const TriangleBound own = proximity_.bound(triangle);
    bvh_.for_each_leaf_within(
        groups::triangle_box(scene_, triangle), radius_, [&](std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            const TriangleBound& other = bounds_[i];
            std::uint32_t sides = agreeing_sides(own.normal, other.normal, cos_angle_);
            if (other.triangle == triangle) sides |= equal_sides;
            if (sides != 0 && proximity_.within(own, other)) {
              neighbours.push_back(4 * other.triangle + sides);
            }
          }
        });
    std::sort(neighbours.begin() + static_cast<std::ptrdiff_t>(first_of_list), neighbours.end());
  }

 private:
  const Scene& scene_;
  double radius_;
  double cos_angle_;
  TriangleBvh bvh_;
  ProximityTest proximity_;
  std::vector<TriangleBound> bounds_;  ///< in leaf order
};

void check(const NeighbourGroupParameters& parameters) {
  if (!(parameters.radius > 0) || !std::isfinite(parameters.radius)) {
    throw UsageError(fmt::format("radius: {} m is out of range; give a positive number of metres",
                                 parameters.radius));
  }
  if (!(parameters.angle_degrees >= 0 && parameters.angle_degrees <= 180)) {
    throw UsageError(fmt::format("group angle: {} degrees is out of range; give 0 to 180 degrees",
                                 parameters.angle_degrees));
  }
}

std::vector<Chunk> find_chunks(const Search& search, std::size_t triangle_count, double radius,
                               Progress& progress) {
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
      search.append_neighbours(static_cast<std::uint32_t>(triangle), neighbours);
      const std::uint64_t group_size = std::accumulate(
          neighbours.begin() + static_cast<std::ptrdiff_t>(before), neighbours.end(),
          std::uint64_t{0},
          [](std::uint64_t sum, std::uint32_t neighbour) { return sum + members_of(neighbour); });
      chunks[c].list_sizes.push_back(static_cast<std::uint32_t>(neighbours.size() - before));
      chunks[c].group_sizes.push_back(group_size);
      if ((total_members += 2 * group_size) > limits::max_group_members) {
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
  for (const std::uint32_t size : chunk.list_sizes) {
    for (std::uint32_t side = 0; side < 2; ++side) {
      for (std::uint32_t i = 0; i < size; ++i) {
        const std::uint32_t triangle = list[i] / 4;
        const bool agrees_with_0 = list[i] & (side == 0 ? equal_sides : opposite_sides);
        const bool agrees_with_1 = list[i] & (side == 0 ? opposite_sides : equal_sides);
        if (agrees_with_0) *members++ = sided(triangle, 0);
        if (agrees_with_1) *members++ = sided(triangle, 1);
      }
    }
    list += size;
  }
}

}  // namespace

bool normals_agree(const glm::dvec3& a, const glm::dvec3& b, double cos_angle) {
  return (agreeing_sides(a, b, cos_angle) & equal_sides) != 0;
}

NeighbourGroups find_neighbour_groups(const Scene& scene,
                                      const NeighbourGroupParameters& parameters,
                                      Progress& progress) {
  check(parameters);
  const std::size_t triangle_count = scene.triangle_count();
  progress.begin("find neighbour groups", triangle_count, "triangles");
  NeighbourGroups result;
  result.radius = parameters.radius;
  result.angle_degrees = parameters.angle_degrees;

  std::vector<Chunk> chunks =
      find_chunks(Search(scene, parameters), triangle_count, parameters.radius, progress);

  result.offsets.reserve(2 * triangle_count + 1);
  result.offsets.push_back(0);
  for (const Chunk& chunk : chunks) {
    for (const std::uint64_t size : chunk.group_sizes) {
      result.offsets.push_back(result.offsets.back() + size);
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

NeighbourGroups naive_groups(const Scene& scene) {
  NeighbourGroups result;
  const std::size_t count = 2 * scene.triangle_count();
  result.offsets.resize(count + 1);
  std::iota(result.offsets.begin(), result.offsets.end(), std::uint64_t{0});
  result.members.resize(count);
  std::iota(result.members.begin(), result.members.end(), std::uint32_t{0});
  // No radius is too large for maps that hold their own photons only.
  result.radius = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace photile
