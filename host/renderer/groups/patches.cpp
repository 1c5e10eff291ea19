#include <glm/gtc/constants.hpp>

#include "groups/patch_splitter.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/scene_builder.hpp"

namespace photile {
namespace {

using groups::PatchPart;
using groups::TriangleFacts;

/// Normals that lean farther from the axis have no common side.
constexpr double least_common_cosine = 0.17;

/// Whether single maps would hold fewer photons: the area within the radius of each triangle (its
/// Minkowski sum with a disc) against that of the patch's rectangle.
bool single_maps_cost_less(const Scene& scene, const TriangleFacts& facts, const PatchPart& part,
                           double radius) {
  double singles = 0;
  for (const std::uint32_t t : part.triangles) {
    const auto corners = scene.corners(t);
    double perimeter = 0;
    for (int i = 0; i < 3; ++i) perimeter += glm::distance(corners[i], corners[(i + 1) % 3]);
    singles += facts.area[t] + perimeter * radius + glm::pi<double>() * radius * radius;
  }
  return singles < part.shape.grown_area(radius);
}

class Collector {
 public:
  Collector(const Scene& scene, const TriangleFacts& facts) : scene_(scene), facts_(facts) {
    patches_.map_of.resize(2 * scene.triangle_count());
    patches_.members.reserve(scene.triangle_count());
    patches_.first_of.push_back(0);
  }

  void add(std::span<const std::uint32_t> triangles, const groups::PatchShape& shape) {
    const auto patch = static_cast<std::uint32_t>(patches_.count());
    for (const std::uint32_t t : triangles) {
      const std::uint32_t member = sided(t, side_of_member(t, shape));
      patches_.members.push_back(member);
      patches_.map_of[member] = 2 * patch;
      patches_.map_of[member ^ 1u] = 2 * patch + 1;
    }
    patches_.first_of.push_back(static_cast<std::uint32_t>(patches_.members.size()));
  }

  Patches take() { return std::move(patches_); }

 private:
  /// Sides that face along the axis belong together; on small bodies, the sides that face outwards.
  std::uint32_t side_of_member(std::uint32_t triangle, const groups::PatchShape& shape) const {
    if (shape.least_cosine < least_common_cosine) return scene_.front_side[triangle];
    return glm::dot(glm::dvec3(facts_.normal[triangle]), shape.axis) < 0 ? 1 : 0;
  }

  const Scene& scene_;
  const TriangleFacts& facts_;
  Patches patches_;
};

}  // namespace

std::string_view name_of(MapMode mode) {
  switch (mode) {
    case MapMode::naive:
      return "naive";
    case MapMode::triangle:
      return "triangle";
    case MapMode::patch:
      return "patch";
    case MapMode::automatic:
      return "auto";
  }
  return "unknown";
}

Patches find_patches(const Scene& scene, double radius, MapMode mode) {
  if (mode == MapMode::naive || mode == MapMode::triangle) return {};
  check_scene(scene);
  groups::PatchSplitter splitter(scene, radius);
  const std::vector<PatchPart> parts = splitter.split();
  Collector collector(scene, splitter.facts());
  for (const PatchPart& part : parts) {
    if (mode == MapMode::automatic &&
        single_maps_cost_less(scene, splitter.facts(), part, radius)) {
      for (const std::uint32_t& t : part.triangles) collector.add({&t, 1}, part.shape);
    } else {
      collector.add(part.triangles, part.shape);
    }
  }
  return collector.take();
}

}  // namespace photile
