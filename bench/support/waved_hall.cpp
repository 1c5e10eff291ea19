#include <cmath>
#include <numbers>
#include <utility>

#include "photile/scene_builder.hpp"
#include "support/workload.hpp"

namespace photile::bench {
namespace {

/// A wall: origin, two edges, and a unit normal into the hall.
struct Wall {
  glm::dvec3 origin, u, v, inward;
  std::uint32_t cells_u, cells_v;
};

/// The waves vanish at the wall's edges, so that the hall is closed.
glm::vec3 point_of(const Wall& wall, std::uint32_t i, std::uint32_t j) {
  constexpr double height = 0.03;  // metres
  constexpr double waves = 4 * std::numbers::pi;
  const double s = static_cast<double>(i) / wall.cells_u;
  const double t = static_cast<double>(j) / wall.cells_v;
  const bool edge = i == 0 || j == 0 || i == wall.cells_u || j == wall.cells_v;
  const double wave = edge ? 0.0 : height * std::sin(waves * s) * std::sin(waves * t);
  return glm::vec3(wall.origin + s * wall.u + t * wall.v + wave * wall.inward);
}

void add_wall(SceneBuilder& builder, std::uint32_t material, const Wall& wall) {
  const bool front_in = glm::dot(glm::cross(wall.u, wall.v), wall.inward) > 0;
  for (std::uint32_t j = 0; j < wall.cells_v; ++j) {
    for (std::uint32_t i = 0; i < wall.cells_u; ++i) {
      const glm::vec3 a = point_of(wall, i, j), b = point_of(wall, i + 1, j);
      const glm::vec3 c = point_of(wall, i + 1, j + 1), d = point_of(wall, i, j + 1);
      builder.triangle(a, front_in ? b : c, front_in ? c : b, material);
      builder.triangle(a, front_in ? c : d, front_in ? d : c, material);
    }
  }
}

}  // namespace

Scene waved_hall(std::uint32_t cells) {
  constexpr double width = 4, height = 3;  // metres; y is up
  const glm::dvec3 x(width, 0, 0), y(0, height, 0), z(0, 0, width), zero(0);
  const std::uint32_t high = cells / 4 * 3;
  SceneBuilder builder("waved hall");
  const std::uint32_t white = builder.add(white_material());
  builder.add(lamp_at({2.0f, 2.0f, 2.0f}));
  add_wall(builder, white, {zero, x, z, {0, 1, 0}, cells, cells});
  add_wall(builder, white, {y, x, z, {0, -1, 0}, cells, cells});
  add_wall(builder, white, {zero, x, y, {0, 0, 1}, cells, high});
  add_wall(builder, white, {z, x, y, {0, 0, -1}, cells, high});
  add_wall(builder, white, {zero, z, y, {1, 0, 0}, cells, high});
  add_wall(builder, white, {x, z, y, {-1, 0, 0}, cells, high});
  builder.add(Camera::look_at({0.3, 2.4, 0.3}, {2.8, 1.0, 2.8}, {0, 1, 0}, glm::radians(70.0)));
  return std::move(builder).build();
}

}  // namespace photile::bench
