// Scenes in which one mesh lies in several places.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "photile/scene.hpp"
#include "test_scenes.hpp"

namespace photile::test {

/// A closed, dented ball of about 1 m across around the origin: 4 * rings * (rings - 1) triangles.
inline SharedMesh dented_ball(int rings) {
  SharedMesh mesh;
  const int sectors = 2 * rings;
  const auto number = [&](int ring, int sector) {
    if (ring == 0) return 0u;
    if (ring == rings) return 1u;
    return static_cast<std::uint32_t>(2 + (ring - 1) * sectors + sector % sectors);
  };
  mesh.vertices = {{0, 0, 0.5f}, {0, 0, -0.5f}};
  for (int ring = 1; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const double polar = glm::pi<double>() * ring / rings;
      const double azimuth = 2.0 * glm::pi<double>() * sector / sectors;
      const double radius = 0.5 - 0.1 * std::sin(3.0 * azimuth) * std::sin(2.0 * polar);
      mesh.vertices.emplace_back(radius * std::sin(polar) * std::cos(azimuth),
                                 radius * std::sin(polar) * std::sin(azimuth),
                                 radius * std::cos(polar));
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const glm::uvec4 q(number(ring, sector), number(ring + 1, sector),
                         number(ring + 1, sector + 1), number(ring, sector + 1));
      if (ring + 1 < rings) mesh.triangles.emplace_back(q.x, q.y, q.z);
      if (ring > 0) mesh.triangles.emplace_back(q.x, q.z, q.w);
    }
  }
  return mesh;
}

/// Adds the mesh to a scene in each place, as triangles of their own and as instances.
inline void add_instances(Scene& scene, const SharedMesh& mesh,
                          const std::vector<glm::mat4x3>& places, std::uint32_t material) {
  const auto index = static_cast<std::uint32_t>(scene.shared_meshes.size());
  scene.shared_meshes.push_back(mesh);
  for (const glm::mat4x3& place : places) {
    scene.instances.push_back({index, static_cast<std::uint32_t>(scene.triangle_count()), place});
    const auto first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    for (const glm::vec3& v : mesh.vertices) {
      scene.vertices.emplace_back(glm::dmat4x3(place) * glm::dvec4(glm::dvec3(v), 1.0));
    }
    const auto less = [&](std::uint32_t i, std::uint32_t j) {
      const glm::vec3 &a = scene.vertices[i], &b = scene.vertices[j];
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    const bool is_mirrored = glm::determinant(glm::mat3(place)) < 0;
    for (const glm::uvec3& triangle : mesh.triangles) {
      glm::uvec3 corners = first_vertex + triangle;
      std::uint8_t front_side = is_mirrored ? 1 : 0;
      for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)}) {
        if (less(corners[j], corners[i])) {
          std::swap(corners[i], corners[j]);
          front_side ^= 1;
        }
      }
      scene.triangles.push_back(corners);
      scene.front_side.push_back(front_side);
      scene.triangle_material.push_back(material);
      scene.triangle_light.push_back(none);
    }
  }
}

/// The scene without a word of what repeats.
inline Scene flattened(Scene scene) {
  scene.shared_meshes.clear();
  scene.instances.clear();
  return scene;
}

/// Turned, scaled unevenly and mirrored places in furnished_room.
inline std::vector<glm::mat4x3> places_in_room() {
  const auto place = [](const glm::vec3& at, float angle, const glm::vec3& scale) {
    const glm::mat4 turned =
        glm::rotate(glm::translate(glm::mat4(1.0f), at), angle, glm::vec3(0.6f, 0.0f, 0.8f));
    return glm::mat4x3(glm::scale(turned, scale));
  };
  return {place({0.6f, 0.6f, 1.0f}, 0.0f, glm::vec3(1.0f)),
          place({2.2f, 2.2f, 0.8f}, 1.0f, glm::vec3(0.5f, 0.9f, 0.7f)),
          place({3.3f, 0.9f, 1.3f}, 2.5f, glm::vec3(-0.6f, 0.6f, 0.6f)),
          place({1.8f, 0.8f, 1.7f}, -0.7f, glm::vec3(0.3f, -0.8f, -0.4f)),
          place({1.8f, 0.8f, 1.7f}, 0.7f, glm::vec3(-0.5f))};
}

/// furnished_room with a dented ball in five places, two of which intersect.
inline Scene room_of_balls(int rings = 12) {
  Scene scene = furnished_room(3);
  add_instances(scene, dented_ball(rings), places_in_room(), 0);
  return scene;
}

}  // namespace photile::test
