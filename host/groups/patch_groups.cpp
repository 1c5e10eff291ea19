// Neighbour groups whose members are patches.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "geometry/box_tree.hpp"
#include "geometry/triangle_bvh.hpp"
#include "groups/group_lists.hpp"
#include "groups/proximity_test.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"

namespace photile {
namespace {

using namespace groups;
using geometry::Box;
using geometry::BoxTree;
using geometry::triangle_box;

/// Patches of fewer triangles are searched one triangle after the other.
constexpr std::size_t fewest_for_tree = 8;

/// The normals of a patch's members: a direction, and the largest angle to it in radians.
struct NormalCone {
  glm::dvec3 axis{0.0};
  double half_angle = 0;

  explicit NormalCone(std::span<const TriangleBound> members) {
    for (const TriangleBound& member : members) axis += member.normal;
    axis = glm::length(axis) > 0 ? glm::normalize(axis) : members.front().normal;
    for (const TriangleBound& member : members) {
      half_angle = std::max(half_angle, angle_between(axis, member.normal));
    }
  }

  static double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
  }

  /// Sides on which a normal may agree with some member's, and all sides on which it does.
  std::uint32_t sides_within(const glm::dvec3& normal, double angle) const {
    constexpr double slack = 1e-2;  // radians; far above the rounding of either test
    const double between = angle_between(axis, normal), most = angle + half_angle + slack;
    return (between <= most ? equal_sides : 0) |
           (glm::pi<double>() - between <= most ? opposite_sides : 0);
  }
};

/// The patches near a triangle that hold a triangle of its group.
class PatchSearch {
 public:
  PatchSearch(const Scene& scene, const Patches& patches,
              const NeighbourGroupParameters& parameters)
      : scene_(scene),
        patches_(patches),
        // Room for the rounding of squared_distance(), a few parts in 10^7.
        limit_(static_cast<float>(parameters.radius * parameters.radius * (1 + 1e-5))),
        angle_(glm::radians(parameters.angle_degrees)),
        cos_angle_(std::cos(angle_)),
        proximity_(scene, parameters.radius),
        bounds_(scene.triangle_count()),
        boxes_(scene.triangle_count()),
        trees_(patches.count()) {
    tbb::parallel_for(std::size_t{0}, bounds_.size(), [&](std::size_t i) {
      const std::uint32_t triangle = triangle_of(patches.members[i]);
      bounds_[i] = proximity_.bound(triangle);
      if (side_of(patches.members[i]) == 1) bounds_[i].normal = -bounds_[i].normal;
      boxes_[i] = triangle_box(scene, triangle);
    });
    std::vector<Box> patch_boxes(patches.count());
    tbb::parallel_for(std::size_t{0}, patches.count(), [&](std::size_t patch) {
      const std::span<const Box> boxes = boxes_of(patch);
      for (const Box& box : boxes) patch_boxes[patch].extend(box);
      if (boxes.size() >= fewest_for_tree) trees_[patch] = BoxTree(boxes);
    });
    patch_tree_ = BoxTree(patch_boxes);
    patch_boxes_ = std::move(patch_boxes);
    cones_.reserve(patches.count());
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
      cones_.emplace_back(
          std::span(bounds_).subspan(patches.first_of[patch], patches.of(patch).size()));
    }
  }

  void append_neighbours(std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) const {
    const std::size_t first_of_list = neighbours.size();
    const TriangleBound own = proximity_.bound(triangle);
    const Box box = triangle_box(scene_, triangle);
    const std::uint32_t own_map = patches_.map_of[sided(triangle, 0)];
    patch_tree_.visit_within(box, limit_, [&](std::uint32_t patch) {
      if (!(squared_distance(patch_boxes_[patch], box) <= limit_)) return false;
      std::uint32_t sides = 0;
      if (patch == own_map / 2) sides = own_map % 2 == 0 ? equal_sides : opposite_sides;
      sides = sides_near(own, box, patch, sides);
      if (sides != 0) neighbours.push_back(4 * patch + sides);
      return false;
    });
    std::sort(neighbours.begin() + static_cast<std::ptrdiff_t>(first_of_list), neighbours.end());
  }

 private:
  std::span<const Box> boxes_of(std::size_t patch) const {
    return std::span(boxes_).subspan(patches_.first_of[patch], patches_.of(patch).size());
  }

  /// Which sides of the patch have a triangle within the radius that agrees; `found` are known.
  std::uint32_t sides_near(const TriangleBound& own, const Box& box, std::uint32_t patch,
                           std::uint32_t found) const {
    const std::uint32_t first = patches_.first_of[patch];
    const std::uint32_t wanted = found | cones_[patch].sides_within(own.normal, angle_);
    if (found == wanted) return found;
    const auto visit = [&](std::uint32_t member) {
      const TriangleBound& other = bounds_[first + member];
      const std::uint32_t sides = agreeing_sides(own.normal, other.normal, cos_angle_);
      if ((sides & ~found) != 0 && squared_distance(boxes_[first + member], box) <= limit_ &&
          proximity_.within(own, other)) {
        found |= sides;
      }
      return found == wanted;
    };
    const std::size_t count = patches_.of(patch).size();
    if (count >= fewest_for_tree) {
      trees_[patch].visit_within(box, limit_, visit);
    } else {
      for (std::uint32_t member = 0; member < count && !visit(member); ++member) {
      }
    }
    return found;
  }

  const Scene& scene_;
  const Patches& patches_;
  float limit_;
  double angle_;  ///< radians
  double cos_angle_;
  ProximityTest proximity_;
  std::vector<TriangleBound> bounds_;  ///< per member; normals of the member's side
  std::vector<Box> boxes_;             ///< per member
  std::vector<BoxTree> trees_;         ///< over the members of a patch; empty for few
  std::vector<Box> patch_boxes_;
  std::vector<NormalCone> cones_;
  BoxTree patch_tree_;
};

}  // namespace

NeighbourGroups find_patch_groups(const Scene& scene, Patches patches,
                                  const NeighbourGroupParameters& parameters, Progress& progress) {
  check(parameters);
  check_scene(scene);
  if (patches.empty()) return find_neighbour_groups(scene, parameters, progress);
  NeighbourGroups result;
  {
    const PatchSearch search(scene, patches, parameters);
    result = collect_groups(
        scene.triangle_count(), parameters,
        [&](std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) {
          search.append_neighbours(triangle, neighbours);
        },
        progress);
  }
  result.patches = std::move(patches);
  return result;
}

}  // namespace photile
