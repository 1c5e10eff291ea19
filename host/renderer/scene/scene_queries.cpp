// Queries of a scene that several folders use.
#include "scene/scene_queries.hpp"

#include <fmt/format.h>

#include "geometry/box_tree.hpp"
#include "geometry/radius_range.hpp"
#include "geometry/triangle_distance.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "photile/sensors.hpp"

namespace photile {

namespace {

/// Twice the area, along the normal of side 0.
glm::dvec3 doubled_area_vector(const Scene& scene, std::uint32_t triangle) {
  const std::array<glm::vec3, 3> p = scene.corners(triangle);
  return glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
}

}  // namespace

glm::dvec3 direction_in_scene(const Scene& scene, const glm::dvec3& world) {
  return scene.turn * world;
}

glm::dvec3 direction_in_world(const Scene& scene, const glm::dvec3& direction) {
  return glm::transpose(scene.turn) * direction;
}

glm::dvec3 position_in_scene(const Scene& scene, const glm::dvec3& world) {
  const glm::dvec3 position = direction_in_scene(scene, world) - scene.origin;
  if (scene::within_limit(position)) return position;
  throw InputError(
      fmt::format("({:g}, {:g}, {:g}) is not within {:g} m of the scene; give another point",
                  world.x, world.y, world.z, limits::max_coordinate));
}

glm::dvec3 position_in_world(const Scene& scene, const glm::dvec3& position) {
  return direction_in_world(scene, position + scene.origin);
}

Camera in_world(const Scene& scene, Camera camera) {
  camera.position = position_in_world(scene, camera.position);
  for (glm::dvec3* axis : {&camera.forward, &camera.up, &camera.right}) {
    *axis = direction_in_world(scene, *axis);
  }
  return camera;
}

Camera in_scene(const Scene& scene, Camera camera) {
  camera.position = position_in_scene(scene, camera.position);
  for (glm::dvec3* axis : {&camera.forward, &camera.up, &camera.right}) {
    *axis = direction_in_scene(scene, *axis);
  }
  return camera;
}

Sensor in_scene(const Scene& scene, Sensor sensor) {
  sensor.position = position_in_scene(scene, sensor.position);
  sensor.normal = direction_in_scene(scene, sensor.normal);
  sensor.facing = direction_in_scene(scene, sensor.facing);
  return sensor;
}

glm::dvec3 face_normal(const Scene& scene, std::uint32_t oriented_face) {
  const glm::dvec3 normal = glm::normalize(doubled_area_vector(scene, triangle_of(oriented_face)));
  return side_of(oriented_face) == 0 ? normal : -normal;
}

double triangle_area(const Scene& scene, std::uint32_t triangle) {
  return 0.5 * glm::length(doubled_area_vector(scene, triangle));
}

BoundingSphere bounding_sphere(const Scene& scene) {
  if (scene.vertices.empty()) return {};
  const geometry::Box box = scene::bounds_of(scene);
  const glm::dvec3 low(box.lower), high(box.upper);
  return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

}  // namespace photile

namespace photile::scene {

geometry::Box bounds_of(const Scene& scene) {
  geometry::Box box;
  for (const glm::vec3& vertex : scene.vertices) box.extend(vertex);
  return box;
}

float largest_coordinate(const Scene& scene) {
  float largest = 0;
  for (const glm::vec3& v : scene.vertices) {
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  return largest;
}

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
  std::vector<std::uint32_t> open(scene.materials.size(), 0);
  for (std::uint32_t i = 0; i < glass.size(); ++i) {
    const geometry::TriangleCorners corners = geometry::corners_of(scene, glass[i]);
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3 middle = 0.5 * (corners[c] + corners[(c + 1) % 3]);
      const double tolerance = 2e-6 * (size + glm::length(middle)), limit = tolerance * tolerance;
      geometry::Box box;
      box.extend(glm::vec3(middle));
      bool touched = false;
      tree.visit_within(box, static_cast<float>(2 * limit), [&](std::uint32_t j) {
        return touched = i != j && geometry::squared_point_triangle_distance(
                                       middle, geometry::corners_of(scene, glass[j])) <= limit;
      });
      if (!touched) ++open[scene.triangle_material[glass[i]]];
    }
  }
  return open;
}

}  // namespace photile::scene
