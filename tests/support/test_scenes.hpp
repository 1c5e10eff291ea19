// Small scenes built in code, for tests that must not depend on scene files.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <tuple>

#include "photile/scene.hpp"

namespace photile::test {

inline Material diffuse(const glm::vec3& albedo) {
  Material material;
  material.diffuse = albedo;
  return material;
}

inline Material glossy(const glm::vec3& albedo, const glm::vec3& specular, float roughness) {
  Material material = diffuse(albedo);
  material.specular = specular;
  material.roughness = roughness;
  return material;
}

inline Material mirror(const glm::vec3& reflectance) {
  Material material;
  material.interaction = Interaction::mirror;
  material.specular = reflectance;
  return material;
}

inline Material glass(float index_of_refraction, bool thin = false) {
  Material material;
  material.interaction = Interaction::glass;
  material.index_of_refraction = index_of_refraction;
  material.thin = thin;
  return material;
}

/// Builds a Scene as the importer would: vertices welded, corners in canonical order. Triangles and
/// quads are given counter-clockwise as seen from their front.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::string name = "test scene") { scene_.source = std::move(name); }

  std::uint32_t add(const Material& material) {
    scene_.materials.push_back(material);
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
  }

  std::uint32_t add(const Light& light) {
    scene_.lights.push_back(light);
    return static_cast<std::uint32_t>(scene_.lights.size() - 1);
  }

  void triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, std::uint32_t material,
                std::uint32_t light = none) {
    const std::array<glm::vec3, 3> given{a, b, c};
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return tuple_of(given[i]) < tuple_of(given[j]); });
    const bool winding_kept = (order[1] - order[0] + 3) % 3 == 1;
    if (light != none)
      scene_.lights[light].triangles.push_back(static_cast<std::uint32_t>(scene_.triangles.size()));
    scene_.triangles.emplace_back(vertex(given[order[0]]), vertex(given[order[1]]),
                                  vertex(given[order[2]]));
    scene_.front_side.push_back(winding_kept ? 0 : 1);
    scene_.triangle_material.push_back(material);
    scene_.triangle_light.push_back(light);
  }

  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d,
            std::uint32_t material, std::uint32_t light = none) {
    triangle(a, b, c, material, light);
    triangle(a, c, d, material, light);
  }

  /// Parallelogram from `origin` along two edges, cut into cells x cells quads. Its front is on the
  /// side of u x v.
  void grid(const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v, int cells,
            std::uint32_t material, std::uint32_t light = none) {
    const auto at = [&](int i, int j) {
      const auto n = static_cast<float>(cells);
      return origin + (static_cast<float>(i) / n) * u + (static_cast<float>(j) / n) * v;
    };
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), material, light);
  }

  /// Axis-aligned box with cells x cells quads a face. Fronts look into the box if `inwards`.
  void box(const glm::vec3& low, const glm::vec3& high, std::uint32_t material, bool inwards,
           int cells = 1) {
    const glm::vec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 u(0.0f), v(0.0f), across(0.0f);
      u[(axis + 1) % 3] = size[(axis + 1) % 3];
      v[(axis + 2) % 3] = size[(axis + 2) % 3];
      across[axis] = size[axis];
      // u x v points along +axis: into the box on the low face.
      grid(low, inwards ? u : v, inwards ? v : u, cells, material);
      grid(low + across, inwards ? v : u, inwards ? u : v, cells, material);
    }
  }

  /// The scene so far.
  Scene build() const { return scene_; }

 private:
  using Position = std::tuple<float, float, float>;
  static Position tuple_of(const glm::vec3& p) { return {p.x, p.y, p.z}; }

  std::uint32_t vertex(const glm::vec3& p) {
    const auto [entry, inserted] =
        vertices_.emplace(tuple_of(p), static_cast<std::uint32_t>(scene_.vertices.size()));
    if (inserted) scene_.vertices.push_back(p);
    return entry->second;
  }

  Scene scene_;
  std::map<Position, std::uint32_t> vertices_;
};

inline Light area_light(const std::string& name, double power = 1.0, bool two_sided = false) {
  Light light;
  light.name = name;
  light.power = power;
  light.two_sided = two_sided;
  return light;
}

inline Light point_light(const std::string& name, const glm::vec3& position, double power = 1.0) {
  Light light;
  light.name = name;
  light.kind = LightKind::point;
  light.position = position;
  light.power = power;
  return light;
}

/// The inside of the cube [0, 1]^3, every wall of one material, a point light off its centre.
inline Scene closed_box(const Material& wall, int cells = 1) {
  SceneBuilder builder("closed box");
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(wall), true, cells);
  builder.add(point_light("lamp", {0.4f, 0.5f, 0.7f}));
  return builder.build();
}

/// A horizontal square plate of `side` metres around the origin in the plane z = 0, its front up.
inline Scene plate(const Material& material, float side, int cells = 1) {
  SceneBuilder builder("plate");
  const float h = 0.5f * side;
  builder.grid({-h, -h, 0.0f}, {side, 0.0f, 0.0f}, {0.0f, side, 0.0f}, cells,
               builder.add(material));
  return builder.build();
}

/// A closed room of 4 x 3 x 2.5 m (z is up) with coloured side walls, a ceiling lamp, a standing
/// lamp without size and two blocks. 12 cells^2 triangles in the walls.
inline Scene furnished_room(int cells = 1) {
  SceneBuilder builder("furnished room");
  const std::uint32_t white = builder.add(diffuse(glm::vec3(0.7f)));
  const std::uint32_t red = builder.add(diffuse({0.6f, 0.1f, 0.1f}));
  const std::uint32_t green = builder.add(diffuse({0.1f, 0.5f, 0.1f}));
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  const std::uint32_t ceiling = builder.add(area_light("ceiling", 2000.0));
  builder.add(point_light("standing lamp", {3.2f, 2.4f, 1.4f}, 400.0));

  const glm::vec3 x(4.0f, 0.0f, 0.0f), y(0.0f, 3.0f, 0.0f), z(0.0f, 0.0f, 2.5f), zero(0.0f);
  builder.grid(zero, x, y, cells, white);
  builder.grid(z, y, x, cells, white);
  builder.grid(zero, z, x, cells, white);
  builder.grid(y, x, z, cells, white);
  builder.grid(zero, y, z, cells, red);
  builder.grid(x, z, y, cells, green);
  builder.grid({1.5f, 1.2f, 2.45f}, {0.0f, 0.6f, 0.0f}, {1.0f, 0.0f, 0.0f}, 1, black, ceiling);
  builder.box({0.6f, 1.6f, 0.0f}, {1.4f, 2.4f, 1.2f}, white, false, std::max(1, cells / 3));
  builder.box({2.3f, 0.5f, 0.0f}, {3.1f, 1.3f, 0.6f}, white, false, std::max(1, cells / 3));
  return builder.build();
}

/// The same scene as another exporter might have wound it: the fronts of all triangles for which
/// `flip` holds are on the other side.
template <class Predicate>
Scene rewound(Scene scene, Predicate&& flip) {
  for (std::size_t t = 0; t < scene.triangle_count(); ++t)
    if (flip(t)) scene.front_side[t] ^= 1;
  return scene;
}

}  // namespace photile::test
