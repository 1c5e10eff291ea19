#include "validation/room.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "photile/scene_builder.hpp"

namespace photile::validation {

Material diffuse(float albedo) {
  Material material;
  material.diffuse = glm::vec3(albedo);
  return material;
}

std::vector<Rectangle> box_walls(const glm::dvec3& size) {
  const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), zero(0);
  return {{zero, y, z}, {x, z, y}, {zero, z, x}, {y, x, z}, {zero, x, y}, {z, y, x}};
}

std::vector<Sensor> grid_of_sensors(const std::vector<Rectangle>& rectangles, double per_metre) {
  std::vector<Sensor> sensors;
  for (const Rectangle& rectangle : rectangles) {
    const auto columns = static_cast<int>(std::lround(per_metre * glm::length(rectangle.u)));
    const auto rows = static_cast<int>(std::lround(per_metre * glm::length(rectangle.v)));
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        sensors.push_back(
            {rectangle.at((i + 0.5) / columns, (j + 0.5) / rows), rectangle.normal()});
      }
    }
  }
  return sensors;
}

Room::Room(const std::string& name) : name_(name) {}

std::uint32_t Room::add_material(const Material& material) {
  materials_.push_back(material);
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

std::uint32_t Room::add_light(LightKind kind) {
  Light& light = lights_.emplace_back();
  light.name = "lamp";
  light.kind = kind;
  light.power = 1;
  return static_cast<std::uint32_t>(lights_.size() - 1);
}

void Room::add(const Rectangle& rectangle, std::uint32_t material, std::uint32_t light) {
  const glm::dvec3 &a = rectangle.corner, b = a + rectangle.u, c = b + rectangle.v,
                   d = a + rectangle.v;
  add_triangle(a, b, c, material, light);
  add_triangle(a, c, d, material, light);
}

void Room::add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                        std::uint32_t material, std::uint32_t light) {
  triangles_.push_back({{a, b, c}, material, light});
}

void Room::add_ball(const glm::dvec3& centre, double radius, int rings, std::uint32_t material,
                    bool inwards) {
  const auto at = [&](int i, int j) {
    const double theta = glm::pi<double>() * i / rings;
    const double phi = glm::pi<double>() * (j % (2 * rings)) / rings;
    if (i == 0 || i == rings) return centre + glm::dvec3(0, 0, i == 0 ? radius : -radius);
    return centre + radius * glm::dvec3(std::sin(theta) * std::cos(phi),
                                        std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  const auto facet = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    inwards ? add_triangle(a, c, b, material) : add_triangle(a, b, c, material);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) facet(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) facet(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

Scene Room::build(double power) const {
  SceneBuilder builder(name_);
  for (const Material& material : materials_) builder.add(material);
  for (Light light : lights_) {
    light.power = power;
    builder.add(std::move(light));
  }
  for (const auto& [corners, material, light] : triangles_) {
    builder.triangle(glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2]), material,
                     light);
  }
  return std::move(builder).build();
}

}  // namespace photile::validation
