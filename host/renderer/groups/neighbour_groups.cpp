#include "photile/neighbour_groups.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/triangle_bvh.hpp"
#include "groups/group_lists.hpp"
#include "groups/proximity_test.hpp"
#include "photile/scene_builder.hpp"

namespace photile {
namespace {

using namespace groups;
using geometry::triangle_box;
using geometry::TriangleBvh;

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
        triangle_box(scene_, triangle), radius_, [&](std::size_t first, std::size_t last) {
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
