#include "trace/light_offset.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "geometry/box.hpp"
#include "scene/scene_queries.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {
namespace {

/// Offsets of rays by which lights are to lie off surface: beyond where rays from it start.
constexpr double offsets = 4;
/// Of an offset: lights nearer than this part lie in the surface, for coordinates are rounded
/// twice.
constexpr double rounding = 0.25;
/// A light that sends less of its flux to one side than this part shines to the other alone.
constexpr double both_sides = 1e-3;
/// Cosine to the vertical from which on a surface has a side below.
constexpr double level = 0.5;

/// Part of the flux that a light sends to the side of a normal.
double part_towards(const Scene& scene, const Light& light, const glm::dvec3& normal) {
  constexpr std::uint32_t directions = 4096;
  double towards = 0, all = 0;
  const Frame about{light.direction};
  // Narrow beams ask for directions that are evener in the angle than on the sphere.
  for (std::uint32_t i = 0; i < directions; ++i) {
    const double polar = glm::pi<double>() * (i + 0.5) / directions;
    const double turn = std::fmod(i * 0.6180339887498949, 1.0) * glm::two_pi<double>();
    const double sine = std::sin(polar);
    const glm::dvec3 direction(
        about.to_world(glm::vec3(sine * std::cos(turn), sine * std::sin(turn), std::cos(polar))));
    const double flux = sine * candela_per_lumen(scene, light, direction);
    all += flux;
    if (glm::dot(direction, normal) > 0) towards += flux;
  }
  return all > 0 ? towards / all : 0.5;
}

/// The normal of the side to which a light belongs that lies in a surface.
glm::dvec3 side_of_light(const Scene& scene, const Light& light, const geometry::Box& bounds,
                         const glm::dvec3& normal, double offset) {
  const double part = part_towards(scene, light, normal);
  if (part < both_sides) return -normal;
  if (part > 1 - both_sides) return normal;
  const glm::dvec3 position(light.position);
  const bool lies_lowest = position.y - offset <= static_cast<double>(bounds.lower.y);
  if (std::abs(normal.y) > level && !lies_lowest) return normal.y < 0 ? normal : -normal;
  const glm::dvec3 inwards = 0.5 * glm::dvec3(bounds.lower + bounds.upper) - position;
  return glm::dot(inwards, normal) > 0 ? normal : -normal;
}

/// Where the light is to lie off all surfaces in which it lies.
glm::vec3 position_off_surfaces(const Scene& scene, const Light& light,
                                const geometry::Box& bounds) {
  glm::dvec3 position(light.position);
  for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    const auto [a, b, c] = scene.corners(triangle);
    const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    const glm::vec3 size = glm::max(glm::abs(low), glm::abs(high));
    const double one = ray_offset_per_coordinate * static_cast<double>(largest(size));
    const double offset = offsets * one;
    if (glm::any(glm::lessThan(position, glm::dvec3(low) - offset)) ||
        glm::any(glm::greaterThan(position, glm::dvec3(high) + offset))) {
      continue;
    }
    const glm::dvec3 normal = face_normal(scene, oriented(triangle, 0));
    const double height = glm::dot(position - glm::dvec3(a), normal);
    if (std::abs(height) > rounding * one) continue;
    const TriangleHit nearest = nearest_on_triangle(scene, triangle, position);
    if (glm::distance(position_of(scene, nearest), position) >= 2 * offset) continue;
    const glm::dvec3 side = side_of_light(scene, light, bounds, normal, offset);
    position += (offset - glm::dot(side, normal) * height) * side;
  }
  return glm::vec3(position);
}

}  // namespace

void offset_lights(Scene& scene) {
  const geometry::Box bounds = scene::bounds_of(scene);
  tbb::parallel_for(std::size_t{0}, scene.lights.size(), [&](std::size_t i) {
    Light& light = scene.lights[i];
    if (light.has_position()) {
      light.position = position_off_surfaces(scene, light, bounds);
    }
  });
}

}  // namespace photile::trace
