#include "tools/validation/room.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "import/mesh_builder.hpp"

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

Room::Room(const std::string& name) { scene_.source = name; }

std::uint32_t Room::add_material(const Material& material) {
  scene_.materials.push_back(material);
  return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t Room::add_light(LightKind kind) {
  Light& light = scene_.lights.emplace_back();
  light.name = "lamp";
  light.kind = kind;
  light.power = 1;
  return static_cast<std::uint32_t>(scene_.lights.size() - 1);
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

Scene Room::build(double power) {
  scene_io::MeshBuilder mesh(scene_, {});
  for (const Triangle& triangle : triangles_) {
    const auto index = static_cast<std::uint32_t>(scene_.triangles.size());
    const std::array corners{scene_io::Corner{triangle.corners[0]},
                             scene_io::Corner{triangle.corners[1]},
                             scene_io::Corner{triangle.corners[2]}};
    if (!mesh.add(corners, triangle.material, triangle.light)) continue;
    if (triangle.light != none) scene_.lights[triangle.light].triangles.push_back(index);
  }
  mesh.finish();
  scene_.lights.at(0).power = power;
  return std::move(scene_);
}

}  // namespace photile::validation
