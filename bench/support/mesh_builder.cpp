#include "support/mesh_builder.hpp"

#include <algorithm>
#include <tuple>

namespace photile::bench {

void add_triangle(Scene& scene, const std::array<glm::vec3, 3>& corners) {
  const auto key = [&](int corner) {
    const glm::vec3& p = corners[static_cast<std::size_t>(corner)];
    return std::tuple(p.x, p.y, p.z);
  };
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  const std::uint32_t first = static_cast<std::uint32_t>(scene.vertices.size());
  for (const int corner : order)
    scene.vertices.push_back(corners[static_cast<std::size_t>(corner)]);
  scene.triangles.emplace_back(first, first + 1, first + 2);
  const bool winding_kept = (order[1] - order[0] + 3) % 3 == 1;
  scene.front_side.push_back(winding_kept ? 0 : 1);
  scene.triangle_material.push_back(0);
  scene.triangle_light.push_back(none);
}

Scene empty_scene(const std::string& name, const glm::vec3& light_position) {
  Scene scene;
  scene.source = name;
  Material material;
  material.name = "white";
  material.diffuse = glm::vec3(0.5f);
  scene.materials.push_back(material);
  Light light;
  light.name = "lamp";
  light.kind = LightKind::point;
  light.position = light_position;
  light.power = 1000;
  scene.lights.push_back(light);
  return scene;
}

}  // namespace photile::bench
