#include "support/subdivision.hpp"

#include <array>

#include "scene/mesh_builder.hpp"

namespace photile::bench {
namespace {

template <class T>
using AtCorners = std::array<T, 3>;

/// The three at the corners, then the one in the middle, wound as the whole.
template <class T>
std::array<AtCorners<T>, 4> quarters(const AtCorners<T>& whole) {
  const auto [a, b, c] = whole;
  const T ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
  return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}}};
}

/// Corners counter-clockwise seen from the front.
template <class T>
AtCorners<T> from_the_front(const AtCorners<T>& canonical, bool front_is_side_0) {
  const auto [a, b, c] = canonical;
  return front_is_side_0 ? AtCorners<T>{a, b, c} : AtCorners<T>{a, c, b};
}

}  // namespace

Scene subdivided(const Scene& scene) {
  Scene fine;
  fine.source = scene.source;
  fine.unit = scene.unit;
  fine.materials = scene.materials;
  fine.textures = scene.textures;
  fine.lights = scene.lights;
  fine.distributions = scene.distributions;
  fine.environments = scene.environments;
  fine.cameras = scene.cameras;
  for (Light& light : fine.lights) light.triangles.clear();
  scene::MeshBuilder mesh(
      fine, {.uv = !scene.corner_uv.empty(), .emission_uv = !scene.corner_emission_uv.empty()});
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    const auto pieces = [&](const auto& whole) {
      return quarters(from_the_front(whole, scene.front_side[t] == 0));
    };
    const auto positions = pieces(scene.corners(t));
    std::array<AtCorners<scene::Corner>, 4> corners;
    for (std::size_t piece = 0; piece < 4; ++piece) {
      for (std::size_t i = 0; i < 3; ++i) {
        scene::Corner& corner = corners[piece][i];
        corner.position = glm::dvec3(positions[piece][i]);
        if (!scene.corner_uv.empty()) corner.uv = pieces(scene.corner_uv[t])[piece][i];
        if (!scene.corner_emission_uv.empty()) {
          corner.emission_uv = pieces(scene.corner_emission_uv[t])[piece][i];
        }
      }
      const std::uint32_t light = scene.triangle_light[t];
      const auto added = static_cast<std::uint32_t>(fine.triangle_count());
      if (mesh.add(corners[piece], scene.triangle_material[t], light) && light != none) {
        fine.lights[light].triangles.push_back(added);
      }
    }
  }
  return fine;
}

}  // namespace photile::bench
