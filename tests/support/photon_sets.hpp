// Scenes and photons made by code, for tests of maps and estimates.
#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <vector>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::test {

/// A scene of one white diffuse material, with a number of lights that have no place in it.
inline Scene empty_scene(std::size_t light_count = 1) {
  Scene scene;
  Material white;
  white.name = "white";
  white.diffuse = glm::vec3(0.5f);
  scene.materials.push_back(white);
  for (std::size_t i = 0; i < light_count; ++i) {
    Light light;
    light.name = "light" + std::to_string(i);
    light.kind = LightKind::point;
    light.power = 1;
    scene.lights.push_back(light);
  }
  scene.cameras.emplace_back();
  return scene;
}

/// A triangle as it is given: corners in any order, vertices of its own, coincident with others or
/// without area, all of which SceneBuilder mends and stages have to bear.
inline void add_triangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), {a, b, c});
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.front_side.push_back(0);
  scene.triangle_material.push_back(0);
  scene.triangle_light.push_back(none);
}

/// The parallelogram corner + [0,1] u + [0,1] v in cells x cells squares of two triangles.
inline void add_plate(Scene& scene, glm::vec3 corner, glm::vec3 u, glm::vec3 v, int cells) {
  const auto at = [&](int i, int j) {
    return corner + u * (static_cast<float>(i) / static_cast<float>(cells)) +
           v * (static_cast<float>(j) / static_cast<float>(cells));
  };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      add_triangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

/// What add_plate takes.
struct Plate {
  glm::vec3 corner, u, v;
  int cells;
};
inline Scene scene_of_plates(const std::vector<Plate>& plates, std::size_t light_count = 1) {
  Scene scene = empty_scene(light_count);
  for (const Plate& plate : plates) add_plate(scene, plate.corner, plate.u, plate.v, plate.cells);
  return scene;
}

/// A torus of rings x segments quads around the z axis.
inline void add_torus(Scene& scene, float major, float minor, int rings, int segments) {
  const auto at = [&](int i, int j) {
    const float a = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
    const float b = glm::two_pi<float>() * static_cast<float>(j) / static_cast<float>(segments);
    const float r = major + minor * std::cos(b);
    return glm::vec3(r * std::cos(a), r * std::sin(a), minor * std::sin(b));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      add_triangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

/// A uniform point of a triangle.
inline glm::vec3 random_point(const Scene& scene, std::uint32_t triangle, std::mt19937_64& random) {
  std::uniform_real_distribution<float> uniform;
  const float s = std::sqrt(uniform(random));
  const float t = uniform(random);
  const auto [a, b, c] = scene.corners(triangle);
  return (1 - s) * a + s * (1 - t) * b + s * t * c;
}

/// Picks triangles in proportion to their areas.
inline std::discrete_distribution<std::uint32_t> by_area(const Scene& scene) {
  std::vector<double> areas;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t)
    areas.push_back(triangle_area(scene, t));
  return {areas.begin(), areas.end()};
}

inline void add_photon(Photons& photons, const Scene& scene, glm::vec3 position,
                       std::uint32_t oriented_face, std::mt19937_64& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  photons.position.push_back(position);
  photons.flux.emplace_back(uniform(random), uniform(random), uniform(random));
  photons.oriented_face.push_back(oriented_face);
  if (scene.lights.size() > 1) {
    photons.light.push_back(static_cast<std::uint16_t>(random() % scene.lights.size()));
  }
  if (needs_of(scene).glossy) {
    const glm::dvec3 normal = face_normal(scene, oriented_face);
    photons.incoming.emplace_back(glm::normalize(
        glm::vec3(normal) + 0.8f * glm::vec3(uniform(random), uniform(random), uniform(random))));
  }
}

/// Photons uniform over the scene's triangles, on either side alike, with random flux.
inline Photons uniform_photons(const Scene& scene, std::size_t count, std::uint64_t seed,
                               bool both_sides = true) {
  std::mt19937_64 random(seed);
  auto pick = by_area(scene);
  Photons photons;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t triangle = pick(random);
    const std::uint32_t side = both_sides ? static_cast<std::uint32_t>(random() & 1) : 0;
    add_photon(photons, scene, random_point(scene, triangle, random), oriented(triangle, side),
               random);
  }
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

/// A hit on surface that reflects half of the light.
inline void add_grey_hit(PrimaryHits& hits, const glm::vec3& position,
                         std::uint32_t oriented_face) {
  hits.position.push_back(position);
  hits.oriented_face.push_back(oriented_face);
  hits.diffuse_albedo.emplace_back(0.5f);
}

/// Hits uniform over the scene, grouped by oriented face as the estimator wants them.
inline PrimaryHits uniform_hits(const Scene& scene, std::size_t count, std::uint64_t seed,
                                bool both_sides = true) {
  const Photons points = uniform_photons(scene, count, seed, both_sides);
  PrimaryHits hits;
  hits.position = points.position;
  hits.oriented_face = points.oriented_face;
  hits.pixel.resize(count);
  hits.throughput.assign(count, glm::vec3(1.0f));
  hits.diffuse_albedo.assign(count, glm::vec3(0.5f));
  return hits;
}

}  // namespace photile::test
