// Simple scenes, built in code.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "photile/scene.hpp"
#include "photile/sensors.hpp"

namespace photile::validation {

inline constexpr double pi = glm::pi<double>();

Material diffuse(float albedo);

/// A flat rectangle: corner, two sides at a right angle. Its front is on the side of u x v.
struct Rectangle {
  glm::dvec3 corner, u, v;

  glm::dvec3 normal() const { return glm::normalize(glm::cross(u, v)); }
  double area() const { return glm::length(glm::cross(u, v)); }
  glm::dvec3 at(double along_u, double along_v) const { return corner + along_u * u + along_v * v; }
  /// Its front becomes its back.
  Rectangle turned() const { return {corner, v, u}; }
};

/// The walls of the box from the origin to `size`, fronts inwards: -x, +x, -y, +y, floor, ceiling.
std::vector<Rectangle> box_walls(const glm::dvec3& size);

/// On the fronts of rectangles, the middles of squares of 1 / `per_metre` metres: their mean is
/// that over the area where sides are whole numbers of squares.
std::vector<Sensor> grid_of_sensors(const std::vector<Rectangle>& rectangles, double per_metre);

class Room {
 public:
  /// `name` stands for the scene's file in messages.
  explicit Room(const std::string& name);

  std::uint32_t add_material(const Material& material);
  /// The scene's light.
  std::uint32_t add_light(LightKind kind);
  Light& light(std::uint32_t index) { return lights_[index]; }

  void add(const Rectangle& rectangle, std::uint32_t material, std::uint32_t light = none);
  void add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                    std::uint32_t material, std::uint32_t light = none);
  /// A closed ball of flat facets between `rings` circles of latitude and twice as many meridians.
  /// Fronts outwards, or inwards.
  void add_ball(const glm::dvec3& centre, double radius, int rings, std::uint32_t material,
                bool inwards = false);

  /// The scene, its only light at `power` lumens. Call once.
  Scene build(double power) const;

 private:
  struct Triangle {
    std::array<glm::dvec3, 3> corners;
    std::uint32_t material, light;
  };
  std::string name_;
  std::vector<Material> materials_;
  std::vector<Light> lights_;
  std::vector<Triangle> triangles_;
};

}  // namespace photile::validation
