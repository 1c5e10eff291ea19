// Scenes of bare triangles for the tests of neighbour groups.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <utility>

#include "photile/scene.hpp"

namespace photile::test {

using Corners = std::array<glm::dvec3, 3>;

/// Uniform doubles in [lower, upper), the same on every platform.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : generator_(seed) {}
  double operator()(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(generator_() >> 11) * 0x1p-53;
  }
  glm::dvec3 point(double lower, double upper) {
    const double x = (*this)(lower, upper), y = (*this)(lower, upper);
    return {x, y, (*this)(lower, upper)};
  }
  /// Uniform on the unit sphere (Archimedes).
  glm::dvec3 direction() {
    const double z = (*this)(-1, 1), angle = (*this)(0, 2 * M_PI), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }

 private:
  std::mt19937_64 generator_;
};

/// The scene with what groups do not look at, so that it is whole.
inline Scene whole(Scene scene) {
  scene.front_side.resize(scene.triangle_count(), 0);
  scene.triangle_material.resize(scene.triangle_count(), 0);
  scene.triangle_light.resize(scene.triangle_count(), none);
  scene.materials.resize(1);
  return scene;
}

inline void add_triangle(Scene& scene, const Corners& corners) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  for (const glm::dvec3& corner : corners) scene.vertices.emplace_back(corner);
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene = whole(std::move(scene));
}

/// `count` triangles of about `size` metres at random places in a cube of `extent` metres. Every
/// tenth is ten times as large.
inline Scene random_soup(std::uint64_t seed, int count, double extent, double size,
                         const glm::dvec3& offset = glm::dvec3(0)) {
  Uniform uniform(seed);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 centre = offset + uniform.point(0, extent);
    const double s = i % 10 == 0 ? 10 * size : size;
    const glm::dvec3 a = uniform.point(-s, s), b = uniform.point(-s, s), c = uniform.point(-s, s);
    add_triangle(scene, {centre + a, centre + b, centre + c});
  }
  return scene;
}

/// Height field of cells x cells quads over [0, extent]^2 with shared vertices.
template <class Height>
Scene height_field(int cells, double extent, Height&& height) {
  Scene scene;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = extent * i / cells, y = extent * j / cells;
      scene.vertices.emplace_back(x, y, height(x, y));
    }
  }
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t corner = j * row + i;
      scene.triangles.emplace_back(corner, corner + 1, corner + row);
      scene.triangles.emplace_back(corner + 1, corner + row + 1, corner + row);
    }
  }
  return whole(std::move(scene));
}

/// Unit sphere of latitude and longitude bands; shared vertices, needles at the poles.
inline Scene sphere(int bands) {
  Scene scene;
  const auto segments = static_cast<std::uint32_t>(2 * bands);
  for (int j = 0; j <= bands; ++j) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double theta = M_PI * j / bands, phi = 2 * M_PI * i / segments;
      scene.vertices.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                  std::cos(theta));
    }
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(bands); ++j) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t a = j * segments + i, b = j * segments + (i + 1) % segments;
      if (j > 0) scene.triangles.emplace_back(a, a + segments, b);
      if (j + 1 < static_cast<std::uint32_t>(bands)) {
        scene.triangles.emplace_back(b, a + segments, b + segments);
      }
    }
  }
  return whole(std::move(scene));
}

inline Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const auto corners = scene.corners(triangle);
  return {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
}

}  // namespace photile::test
