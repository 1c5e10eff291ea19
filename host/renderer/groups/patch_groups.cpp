// Neighbour groups whose members are patches.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "geometry/box_tree.hpp"
#include "groups/neighbour_groups.hpp"
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

/// The normals of a patch's members: a direction, and the cosine of the largest angle that a normal
/// may make with it and agree with some member's.
struct NormalCone {
  glm::dvec3 axis{0.0};
  double least_cosine = 1;

  NormalCone() = default;
  /// `angle`: radians, largest between normals that agree.
  NormalCone(std::span<const glm::dvec3> normals, double angle) {
    constexpr double slack = 1e-2;  // radians; far above the rounding of either test
    for (const glm::dvec3& normal : normals) axis += normal;
    axis = glm::length(axis) > 0 ? glm::normalize(axis) : normals.front();
    double least = 1;
    for (const glm::dvec3& normal : normals) least = std::min(least, glm::dot(axis, normal));
    const double most = std::acos(std::clamp(least, -1.0, 1.0)) + angle + slack;
    least_cosine = most < glm::pi<double>() ? std::cos(most) : -2;
  }

  /// All sides on which a normal agrees with some member's, and perhaps more.
  std::uint32_t sides_within(const glm::dvec3& normal) const {
    const double cosine = glm::dot(axis, normal);
    return (cosine >= least_cosine ? equal_sides : 0) |
           (-cosine >= least_cosine ? opposite_sides : 0);
  }
};

/// The patches near a triangle that hold a triangle near it whose normal agrees.
class PatchSearch {
 public:
  PatchSearch(const Scene& scene, const Patches& patches,
              const NeighbourGroupParameters& parameters)
      : scene_(scene),
        patches_(patches),
        limit_(geometry::squared_reach(parameters.radius)),
        cos_angle_(std::cos(glm::radians(parameters.angle_degrees))),
        normals_(scene.triangle_count()),
        boxes_(scene.triangle_count()),
        trees_(patches.count()) {
    tbb::parallel_for(std::size_t{0}, boxes_.size(), [&](std::size_t i) {
      normals_[i] = face_normal(scene, patches.members[i]);
      boxes_[i] = triangle_box(scene, triangle_of(patches.members[i]));
    });
    patch_boxes_.resize(patches.count());
    cones_.resize(patches.count());
    const double angle = glm::radians(parameters.angle_degrees);
    tbb::parallel_for(std::size_t{0}, patches.count(), [&](std::size_t patch) {
      const std::span<const Box> boxes = members_of(boxes_, patch);
      for (const Box& box : boxes) patch_boxes_[patch].extend(box);
      if (boxes.size() >= fewest_for_tree) trees_[patch] = BoxTree(boxes);
      cones_[patch] = NormalCone(members_of(normals_, patch), angle);
    });
    patch_tree_ = BoxTree(patch_boxes_);
  }

  void append_neighbours(std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) const {
    const std::size_t first_of_list = neighbours.size();
    const glm::dvec3 normal = face_normal(scene_, oriented(triangle, 0));
    const Box box = triangle_box(scene_, triangle);
    const std::uint32_t own_map = patches_.map_of[oriented(triangle, 0)];
    patch_tree_.visit_within(box, limit_, [&](std::uint32_t patch) {
      if (!(squared_distance(patch_boxes_[patch], box) <= limit_)) return false;
      std::uint32_t sides = 0;
      if (patch == own_map / 2) sides = own_map % 2 == 0 ? equal_sides : opposite_sides;
      sides = sides_near(normal, box, patch, sides);
      if (sides != 0) neighbours.push_back(4 * patch + sides);
      return false;
    });
    std::sort(neighbours.begin() + static_cast<std::ptrdiff_t>(first_of_list), neighbours.end());
  }

 private:
  template <class Value>
  std::span<const Value> members_of(const std::vector<Value>& values, std::size_t patch) const {
    return std::span(values).subspan(patches_.first_of[patch], patches_.of(patch).size());
  }

  /// Which sides of the patch have a triangle near the box that agrees; `found` are known.
  std::uint32_t sides_near(const glm::dvec3& normal, const Box& box, std::uint32_t patch,
                           std::uint32_t found) const {
    const std::uint32_t requested = found | cones_[patch].sides_within(normal);
    if (found == requested) return found;
    const std::span<const Box> boxes = members_of(boxes_, patch);
    const std::span<const glm::dvec3> normals = members_of(normals_, patch);
    const auto visit = [&](std::uint32_t member) {
      if (squared_distance(boxes[member], box) <= limit_) {
        found |= agreeing_sides(normal, normals[member], cos_angle_);
      }
      return found == requested;
    };
    if (boxes.size() >= fewest_for_tree) {
      trees_[patch].visit_within(box, limit_, visit);
    } else {
      for (std::uint32_t member = 0; member < boxes.size() && !visit(member); ++member) {
      }
    }
    return found;
  }

  const Scene& scene_;
  const Patches& patches_;
  float limit_;
  double cos_angle_;
  std::vector<glm::dvec3> normals_;  ///< per member, of its side
  std::vector<Box> boxes_;           ///< per member
  std::vector<BoxTree> trees_;       ///< over the members of a patch; empty for few
  std::vector<Box> patch_boxes_;
  std::vector<NormalCone> cones_;
  BoxTree patch_tree_;
};

}  // namespace

NeighbourGroups find_patch_groups(const Scene& scene, Patches patches,
                                  const NeighbourGroupParameters& parameters, Progress& progress,
                                  std::span<const std::uint8_t> landed) {
  check(parameters);
  check_scene(scene);
  if (patches.empty()) return find_neighbour_groups(scene, parameters, progress, landed);
  NeighbourGroups result;
  {
    const PatchSearch search(scene, patches, parameters);
    result = collect_groups(
        scene.triangle_count(), parameters,
        [&](std::uint32_t triangle, std::vector<std::uint32_t>& neighbours) {
          search.append_neighbours(triangle, neighbours);
        },
        progress, landed);
  }
  result.patches = std::move(patches);
  return result;
}

namespace {

std::vector<std::uint8_t> where_landed(const Photons& photons) {
  std::vector<std::uint8_t> landed(photons.first_of.size() - 1);
  for (std::size_t s = 0; s < landed.size(); ++s) {
    const bool any = photons.of_all ? photons.of_all->landed[s] > 0
                                    : photons.first_of[s] < photons.first_of[s + 1];
    landed[s] = any ? 1 : 0;
  }
  return landed;
}

}  // namespace

NeighbourGroups find_map_groups(const Scene& scene, const Photons& photons, MapMode mode,
                                const NeighbourGroupParameters& parameters, Progress& progress,
                                MapUsers users) {
  if (mode == MapMode::naive) return naive_groups(scene);
  const std::vector<std::uint8_t> landed =
      users == MapUsers::these_photons ? where_landed(photons) : std::vector<std::uint8_t>{};
  Patches patches = find_patches(scene, parameters.radius, mode);
  return merge_patches(
      scene, find_patch_groups(scene, std::move(patches), parameters, progress, landed), photons);
}

}  // namespace photile
