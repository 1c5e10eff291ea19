#include "groups/neighbour_groups.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/value_range.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/triangle_distance.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"
#include "scene/scene_queries.hpp"

namespace photile::groups {
namespace {

using geometry::corners_of;
using geometry::TriangleCorners;

/// Centre of the smallest ball that holds the triangle. It lies in the triangle: the middle of the
/// longest edge of an obtuse one, the circumcentre of an acute one.
glm::dvec3 smallest_ball_centre(const TriangleCorners& corners) {
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &apex = corners[i], &p = corners[(i + 1) % 3], &q = corners[(i + 2) % 3];
    if (glm::dot(p - apex, q - apex) <= 0) return 0.5 * (p + q);
  }
  const glm::dvec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
  const glm::dvec3 normal = glm::cross(u, v);
  return corners[0] + glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) /
                          (2.0 * glm::dot(normal, normal));
}

bool share_a_vertex(const glm::uvec3& a, const glm::uvec3& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] == b.x || a[i] == b.y || a[i] == b.z) return true;
  }
  return false;
}

/// Lower bound of the distance: how far b begins behind the end of a along `direction`, metres.
double gap_along(const glm::dvec3& direction, const TriangleCorners& a, const TriangleCorners& b) {
  double end_of_a = glm::dot(direction, a[0]), start_of_b = glm::dot(direction, b[0]);
  for (int i = 1; i < 3; ++i) {
    end_of_a = std::max(end_of_a, glm::dot(direction, a[i]));
    start_of_b = std::min(start_of_b, glm::dot(direction, b[i]));
  }
  const double length = glm::length(direction);
  return length > 0 ? (start_of_b - end_of_a) / length : 0.0;
}

/// Upper bound of the squared distance: that of the nearest two corners.
double squared_corner_distance(const TriangleCorners& a, const TriangleCorners& b) {
  double squared = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& p : a) {
    for (const glm::dvec3& q : b) squared = std::min(squared, glm::dot(p - q, p - q));
  }
  return squared;
}

}  // namespace

ProximityTest::ProximityTest(const Scene& scene, double radius) : scene_(scene), radius_(radius) {
  // The rounding of distances in this scene is less: some hundred units of double precision.
  const double margin = 1e-12 * std::max(radius, double{scene::largest_coordinate(scene)});
  outer_ = radius + margin;
  squared_inner_ = radius > margin ? (radius - margin) * (radius - margin) : -1.0;
}

TriangleBound ProximityTest::bound(std::uint32_t triangle) const {
  const TriangleCorners corners = corners_of(scene_, triangle);
  TriangleBound bound{};
  bound.triangle = triangle;
  bound.normal = face_normal(scene_, oriented(triangle, 0));
  bound.centre = smallest_ball_centre(corners);
  for (const glm::dvec3& corner : corners) {
    bound.radius = std::max(bound.radius, glm::distance(bound.centre, corner));
  }
  return bound;
}

bool ProximityTest::within_by_corners(const TriangleBound& a, const TriangleBound& b) const {
  if (share_a_vertex(scene_.triangles[a.triangle], scene_.triangles[b.triangle])) return true;
  const TriangleCorners corners_a = corners_of(scene_, a.triangle);
  const TriangleCorners corners_b = corners_of(scene_, b.triangle);
  if (gap_along(b.centre - a.centre, corners_a, corners_b) > outer_) return false;
  if (squared_corner_distance(corners_a, corners_b) <= squared_inner_) return true;
  // The ball of the smaller triangle against the larger triangle itself: settles small triangles
  // beside a wall, whose own ball is as large as the room.
  const bool a_is_smaller = a.radius < b.radius;
  const TriangleBound& small = a_is_smaller ? a : b;
  const double squared =
      geometry::squared_point_triangle_distance(small.centre, a_is_smaller ? corners_b : corners_a);
  if (squared <= squared_inner_) return true;
  const double farthest = outer_ + small.radius;
  if (squared > farthest * farthest) return false;
  return triangle_triangle_distance(corners_a, corners_b) <= radius_;
}

}  // namespace photile::groups

namespace photile {

bool normals_agree(const glm::dvec3& a, const glm::dvec3& b, double cos_angle) {
  return (groups::agreeing_sides(a, b, cos_angle) & groups::equal_sides) != 0;
}

}  // namespace photile

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
  std::vector<std::uint64_t> group_sizes;  ///< per oriented face: members
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
      const auto requested = [&](std::size_t side) {
        return landed.empty() || landed[2 * triangle + side] != 0;
      };
      if (requested(0) || requested(1)) {
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
        chunks[c].group_sizes.push_back(requested(side) ? group_size : 0);
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
        if (agrees_with_0) *members++ = oriented(neighbour, 0);
        if (agrees_with_1) *members++ = oriented(neighbour, 1);
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

namespace photile {

namespace {

using namespace groups;
class Search {
 public:
  Search(const Scene& scene, const NeighbourGroupParameters& parameters)
      : limit_(geometry::squared_reach(parameters.radius)),
        cos_angle_(std::cos(glm::radians(parameters.angle_degrees))),
        boxes_(geometry::triangle_boxes(scene)),
        tree_(boxes_),
        proximity_(scene, parameters.radius),
        bounds_(scene.triangle_count()) {
    tbb::parallel_for(std::size_t{0}, bounds_.size(), [&](std::size_t t) {
      bounds_[t] = proximity_.bound(static_cast<std::uint32_t>(t));
    });
  }

  /// Appends the neighbours of `triangle`, itself among them, ascending.
  void append_neighbours(std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) const {
    const std::size_t first_of_list = neighbours.size();
    const TriangleBound& own = bounds_[triangle];
    tree_.visit_within(boxes_[triangle], limit_, [&](std::uint32_t t) {
      const TriangleBound& other = bounds_[t];
      std::uint32_t sides = agreeing_sides(own.normal, other.normal, cos_angle_);
      if (t == triangle) sides |= equal_sides;
      if (sides != 0 && proximity_.within(own, other)) neighbours.push_back(4 * t + sides);
      return false;
    });
    std::sort(neighbours.begin() + static_cast<std::ptrdiff_t>(first_of_list), neighbours.end());
  }

 private:
  float limit_;
  double cos_angle_;
  std::vector<geometry::Box> boxes_;  ///< per triangle
  geometry::BoxTree tree_;
  ProximityTest proximity_;
  std::vector<TriangleBound> bounds_;  ///< per triangle
};

}  // namespace

NeighbourGroups find_neighbour_groups(const Scene& scene,
                                      const NeighbourGroupParameters& parameters,
                                      Progress& progress, std::span<const std::uint8_t> landed) {
  check(parameters);
  check_scene(scene);
  const Search search(scene, parameters);
  return collect_groups(
      scene.triangle_count(), parameters,
      [&](std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) {
        search.append_neighbours(triangle, neighbours);
      },
      progress, landed);
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
