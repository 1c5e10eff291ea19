// Small scenes built in code, for tests that must not depend on scene files.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <set>
#include <string>

#include "photile/scene_builder.hpp"
#include "scene/coincident_faces.hpp"

namespace photile::test {

using photile::SceneBuilder;

inline Material diffuse(const glm::vec3& albedo) {
  Material material;
  material.diffuse = albedo;
  return material;
}

inline Material diffuse(float albedo) { return diffuse(glm::vec3(albedo)); }

inline Material glossy(const glm::vec3& albedo, const glm::vec3& specular, float roughness) {
  Material material = diffuse(albedo);
  material.specular = specular;
  material.roughness = roughness;
  return material;
}

inline Material glossy(float albedo, float specular, float roughness) {
  return glossy(glm::vec3(albedo), glm::vec3(specular), roughness);
}

inline Material mirror(const glm::vec3& reflectance) {
  Material material;
  material.interaction = Interaction::mirror;
  material.specular = reflectance;
  return material;
}

inline Material mirror(float reflectance) { return mirror(glm::vec3(reflectance)); }

inline Material glass(float index_of_refraction, bool thin = false) {
  Material material;
  material.interaction = Interaction::glass;
  material.index_of_refraction = index_of_refraction;
  material.thin = thin;
  return material;
}

inline Light area_light(const std::string& name, double power = 1.0, bool two_sided = false) {
  Light light;
  light.name = name;
  light.power = power;
  light.two_sided = two_sided;
  return light;
}

inline Light point_light(const std::string& name, const glm::vec3& position, double power = 1.0) {
  Light light;
  light.name = name;
  light.kind = LightKind::point;
  light.position = position;
  light.power = power;
  return light;
}

/// Angles of the cones are radians from the direction.
inline Light spot_light(const std::string& name, const glm::vec3& position,
                        const glm::vec3& direction, float inner, float outer) {
  Light light = point_light(name, position);
  light.kind = LightKind::spot;
  light.direction = direction;
  light.inner_cone_angle = inner;
  light.outer_cone_angle = outer;
  return light;
}

/// The inside of the cube [0, 1]^3, every wall of one material, a point light off its centre.
inline Scene closed_box(const Material& wall, int cells = 1) {
  SceneBuilder builder("closed box");
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(wall), true, cells);
  builder.add(point_light("lamp", {0.4f, 0.5f, 0.7f}));
  return builder.build();
}

inline glm::dvec3 front_normal(const Scene& scene, std::uint32_t triangle) {
  return face_normal(scene, oriented(triangle, scene.front_side[triangle]));
}

/// A horizontal square plate of `side` metres around the origin in the plane z = 0, its front up.
inline Scene plate(const Material& material, float side, int cells = 1) {
  SceneBuilder builder("plate");
  const float h = 0.5f * side;
  builder.grid({-h, -h, 0.0f}, {side, 0.0f, 0.0f}, {0.0f, side, 0.0f}, cells,
               builder.add(material));
  return builder.build();
}

/// Triangles of which a part lies in one place with another: which of them counts there depends on
/// their winding, and the others have no light.
inline std::set<std::uint32_t> triangles_in_one_place(const Scene& scene) {
  const scene::CoincidentFaces coincident(scene);
  std::set<std::uint32_t> triangles;
  for (std::uint32_t face = 0; face < 2 * scene.triangle_count(); ++face) {
    for (const std::uint32_t other : coincident.before(face)) {
      triangles.insert({triangle_of(face), triangle_of(other)});
    }
  }
  return triangles;
}

/// A closed room of 4 x 3 x 2.5 m (z is up) with coloured side walls, a ceiling lamp, a standing
/// lamp without size and two blocks. 12 cells^2 triangles in the walls.
inline Scene furnished_room(int cells = 1) {
  SceneBuilder builder("furnished room");
  const std::uint32_t white = builder.add(diffuse(0.7f));
  const std::uint32_t red = builder.add(diffuse({0.6f, 0.1f, 0.1f}));
  const std::uint32_t green = builder.add(diffuse({0.1f, 0.5f, 0.1f}));
  const std::uint32_t black = builder.add(diffuse(0.0f));
  const std::uint32_t ceiling = builder.add(area_light("ceiling", 2000.0));
  builder.add(point_light("standing lamp", {3.2f, 2.4f, 1.4f}, 400.0));

  const glm::vec3 x(4.0f, 0.0f, 0.0f), y(0.0f, 3.0f, 0.0f), z(0.0f, 0.0f, 2.5f), zero(0.0f);
  builder.grid(zero, x, y, cells, white);
  builder.grid(z, y, x, cells, white);
  builder.grid(zero, z, x, cells, white);
  builder.grid(y, x, z, cells, white);
  builder.grid(zero, y, z, cells, red);
  builder.grid(x, z, y, cells, green);
  builder.grid({1.5f, 1.2f, 2.45f}, {0.0f, 0.6f, 0.0f}, {1.0f, 0.0f, 0.0f}, 1, black, ceiling);
  builder.box({0.6f, 1.6f, 0.0f}, {1.4f, 2.4f, 1.2f}, white, false, std::max(1, cells / 3));
  builder.box({2.3f, 0.5f, 0.0f}, {3.1f, 1.3f, 0.6f}, white, false, std::max(1, cells / 3));
  return builder.build();
}

/// Copies of a scene's last lamp beside each other, 0.2 m times their number along x, until there
/// are `count` lights.
inline void add_lamps(Scene& scene, std::size_t count) {
  while (scene.lights.size() < count) {
    Light light = scene.lights.back();
    light.name = "lamp " + std::to_string(scene.lights.size());
    light.position.x = 0.2f * static_cast<float>(scene.lights.size());
    scene.lights.push_back(light);
  }
}

/// Surroundings as a picture: the only environment of a scene.
inline void add_environment(Scene& scene, const EnvironmentMap& map) {
  Light light;
  light.name = "environment";
  light.kind = LightKind::environment;
  light.environment = 0;
  const double radius = bounding_sphere(scene).radius;
  light.power = luminance(glm::dvec3(map.integral())) * glm::pi<double>() * radius * radius;
  scene.environments.push_back(map);
  scene.lights.push_back(light);
}

/// The scene as another exporter might have wound it: the fronts of all triangles for which `flip`
/// holds are on the other side.
template <class Predicate>
Scene rewound(Scene scene, Predicate&& flip) {
  for (std::size_t t = 0; t < scene.triangle_count(); ++t)
    if (flip(t)) scene.front_side[t] ^= 1;
  return scene;
}

}  // namespace photile::test
