// What every scene that load_scene returns keeps, whatever its file held.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "photile/scene.hpp"

namespace photile::test {

/// Every index in range, every number finite, every area positive, every light fed.
inline void check_invariants(const Scene& scene) {
  const std::size_t count = scene.triangle_count();
  CHECK(count > 0);
  CHECK(scene.front_side.size() == count);
  CHECK(scene.triangle_material.size() == count);
  CHECK(scene.triangle_light.size() == count);
  CHECK((scene.corner_uv.empty() || scene.corner_uv.size() == count));
  CHECK((scene.corner_emission_uv.empty() || scene.corner_emission_uv.size() == count));
  CHECK((scene.corner_normal.empty() || scene.corner_normal.size() == count));
  CHECK((scene.corner_tangent.empty() || scene.corner_tangent.size() == count));
  std::uint64_t bad = 0;
  for (const glm::vec3& vertex : scene.vertices) {
    bad += !std::isfinite(vertex.x + vertex.y + vertex.z);
  }
  for (std::uint32_t t = 0; t < count; ++t) {
    const glm::uvec3 triangle = scene.triangles[t];
    for (int c = 0; c < 3; ++c) bad += triangle[c] >= scene.vertices.size();
    bad += !(triangle_area(scene, t) > 0.0);
    bad += scene.triangle_material[t] >= scene.materials.size();
    const std::uint32_t light = scene.triangle_light[t];
    bad += light != none && light >= scene.lights.size();
  }
  for (const Material& material : scene.materials) {
    for (const glm::vec3& part : {material.diffuse, material.specular}) {
      bad += !glm::all(glm::greaterThanEqual(part, glm::vec3(0.0f)));
      bad += !glm::all(glm::lessThanEqual(part, glm::vec3(1.0f)));
    }
    const std::uint32_t texture = material.diffuse_texture;
    bad += texture != none && texture >= scene.textures.size();
  }
  CHECK_FALSE(scene.lights.empty());
  for (const Light& light : scene.lights) bad += !(light.power > 0.0 && std::isfinite(light.power));
  CHECK(bad == 0);
  CHECK_FALSE(scene.cameras.empty());
}

}  // namespace photile::test
