#include "scene/open_glass.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/radius_range.hpp"
#include "geometry/triangle_bvh.hpp"
#include "geometry/triangle_distance.hpp"

namespace photile::scene {

std::vector<std::uint32_t> open_edges_of_glass(const Scene& scene) {
  std::vector<std::uint32_t> glass;
  std::vector<geometry::Box> boxes;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const Material& material = scene.materials[scene.triangle_material[t]];
    if (material.interaction != Interaction::glass || material.thin) continue;
    glass.push_back(t);
    boxes.push_back(geometry::triangle_box(scene, t));
  }
  const geometry::BoxTree tree(boxes);
  const double size = scene_diagonal(scene);
  const auto corners_of = [&](std::uint32_t t) {
    const auto corners = scene.corners(t);
    return geometry::TriangleCorners{corners[0], corners[1], corners[2]};
  };
  std::vector<std::uint32_t> open(scene.materials.size(), 0);
  for (std::uint32_t i = 0; i < glass.size(); ++i) {
    const geometry::TriangleCorners corners = corners_of(glass[i]);
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3 middle = 0.5 * (corners[c] + corners[(c + 1) % 3]);
      const double tolerance = 2e-6 * (size + glm::length(middle)), limit = tolerance * tolerance;
      geometry::Box box;
      box.extend(glm::vec3(middle));
      bool touched = false;
      tree.visit_within(box, static_cast<float>(2 * limit), [&](std::uint32_t j) {
        return touched = i != j && geometry::squared_point_triangle_distance(
                                       middle, corners_of(glass[j])) <= limit;
      });
      if (!touched) ++open[scene.triangle_material[glass[i]]];
    }
  }
  return open;
}

}  // namespace photile::scene
