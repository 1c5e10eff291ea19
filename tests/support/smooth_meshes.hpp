// Round bodies of few regions, with the vertex normals of the round surface.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "photile/scene_builder.hpp"
#include "photile/sensors.hpp"

namespace photile::test {

struct SmoothMesh {
  std::vector<glm::vec3> vertices, normals;
  std::vector<glm::uvec3> triangles;

  void add_to(SceneBuilder& builder, std::uint32_t material, bool with_normals = true) const {
    MeshArrays arrays{.vertices = vertices, .triangles = triangles};
    if (with_normals) arrays.normals = normals;
    arrays.material = material;
    builder.add(arrays);
  }

  /// A point within a triangle, and the normal of the round surface as its corners say it.
  struct TestPoint {
    Sensor sensor;        ///< looks along the normal of the triangle
    glm::dvec3 smooth{};  ///< unit, interpolated
  };
  /// One on each triangle.
  ///   weights   of its corners
  std::vector<TestPoint> test_points(const std::array<double, 3>& weights = {0.55, 0.3,
                                                                             0.15}) const {
    std::vector<TestPoint> test_points;
    for (const glm::uvec3& triangle : triangles) {
      TestPoint test_point;
      test_point.sensor.position = glm::dvec3(0.0);
      for (int i = 0; i < 3; ++i) {
        test_point.sensor.position +=
            weights[static_cast<std::size_t>(i)] * glm::dvec3(vertices[triangle[i]]);
        test_point.smooth +=
            weights[static_cast<std::size_t>(i)] * glm::dvec3(normals[triangle[i]]);
      }
      const glm::dvec3 a(vertices[triangle.x]), b(vertices[triangle.y]), c(vertices[triangle.z]);
      test_point.sensor.normal = glm::normalize(glm::cross(b - a, c - a));
      test_point.smooth = glm::normalize(test_point.smooth);
      test_points.push_back(test_point);
    }
    return test_points;
  }
};

/// The surface that radius(height) sweeps about the z axis through the centre, from pole to pole.
///   point   of a turn and a row in [0, 1]: point and outward normal
template <class Point>
SmoothMesh swept(std::uint32_t segments, std::uint32_t rows, const Point& point) {
  SmoothMesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const auto [test_point, normal] =
          point(2 * std::numbers::pi * i / segments, double(j) / rows);
      mesh.vertices.emplace_back(test_point);
      mesh.normals.emplace_back(normal);
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t a = j * segments + i, b = j * segments + (i + 1) % segments;
      const std::uint32_t c = a + segments, d = b + segments;
      const auto apart = [&](std::uint32_t p, std::uint32_t q) {
        return glm::distance(mesh.vertices[p], mesh.vertices[q]) > 1e-5f;
      };
      if (apart(a, b)) mesh.triangles.push_back({a, b, d});
      if (apart(c, d)) mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

inline SmoothMesh smooth_sphere(const glm::dvec3& centre, double radius,
                                std::uint32_t segments = 24, std::uint32_t rings = 12) {
  return swept(segments, rings, [&](double turn, double row) {
    const double polar = std::numbers::pi * (row - 0.5);
    const glm::dvec3 normal(std::cos(polar) * std::cos(turn), std::cos(polar) * std::sin(turn),
                            std::sin(polar));
    return std::pair(centre + radius * normal, normal);
  });
}

/// Open at both ends, which stand at the heights 0 and `height` above the centre of its foot.
inline SmoothMesh smooth_cylinder(const glm::dvec3& foot, double radius, double height,
                                  std::uint32_t segments = 32) {
  return swept(segments, 1, [&](double turn, double row) {
    const glm::dvec3 normal(std::cos(turn), std::sin(turn), 0.0);
    return std::pair(foot + radius * normal + glm::dvec3(0, 0, row * height), normal);
  });
}

}  // namespace photile::test
