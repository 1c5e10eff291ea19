// A room of 4 x 2.7 x 5 m (y is up) with a hole of 1.2 x 1 m in the wall at z = 0.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "test_scenes.hpp"

namespace photile::test {

struct RoomWithWindow {
  static constexpr float width = 4, height = 2.7f, depth = 5;
  static constexpr float left = 1.2f, right = 2.4f, sill = 0.9f, head = 1.9f;
  static constexpr double window_area = 1.2 * 1.0;

  /// Walls of one material, and a camera in the room.
  ///   two_windows   the wall at z = 5 m has the same hole
  static SceneBuilder builder(const Material& walls, bool two_windows = false) {
    SceneBuilder builder("room with a window");
    const std::uint32_t wall = builder.add(walls);
    const glm::vec3 x(width, 0, 0), y(0, height, 0), z(0, 0, depth), zero(0.0f);
    builder.grid(zero, z, x, 1, wall);  // floor
    builder.grid(y, x, z, 1, wall);     // ceiling
    builder.grid(zero, y, z, 1, wall);
    builder.grid(x, z, y, 1, wall);
    const auto wall_around_window = [&](float at) {
      const auto part = [&](float x0, float x1, float y0, float y1) {
        builder.quad({x0, y0, at}, {x1, y0, at}, {x1, y1, at}, {x0, y1, at}, wall);
      };
      part(0, left, 0, height);
      part(right, width, 0, height);
      part(left, right, 0, sill);
      part(left, right, head, height);
    };
    wall_around_window(0);
    if (two_windows) {
      wall_around_window(depth);
    } else {
      builder.grid(z, y, x, 1, wall);
    }
    builder.add(Camera::look_at({2.0, 1.5, 4.0}, {2.0, 1.2, 0.0}, {0.0, 1.0, 0.0}, 1.0));
    return builder;
  }

  /// The window, or its left part; light comes in along +z.
  static Portal window(float part = 1) {
    return {{left, sill, 0}, {part * (right - left), 0, 0}, {0, head - sill, 0}};
  }

  /// Whether a side of a triangle looks into the room.
  static bool inside(const Scene& scene, std::uint32_t oriented_face) {
    const glm::dvec3 middle(0.5 * width, 0.5 * height, 0.5 * depth);
    const glm::dvec3 corner(scene.corners(triangle_of(oriented_face))[0]);
    return glm::dot(face_normal(scene, oriented_face), middle - corner) > 0;
  }
};

/// Surroundings of one luminance.
inline EnvironmentMap even_surroundings(float luminance = 1) {
  return {"even", 64, 16, std::vector<glm::vec3>(64 * 16, glm::vec3(luminance))};
}

}  // namespace photile::test
