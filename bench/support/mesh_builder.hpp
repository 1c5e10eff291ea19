// Meshes made in code.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "photile/scene.hpp"

namespace photile::bench {

/// Adds a triangle of three new vertices in canonical order (see Scene), material 0, no light.
/// Its front is where a, b, c run counter-clockwise.
void add_triangle(Scene& scene, const std::array<glm::vec3, 3>& corners);

/// A scene with one diffuse material and one point light of 1000 lm.
Scene empty_scene(const std::string& name, const glm::vec3& light_position);

}  // namespace photile::bench
