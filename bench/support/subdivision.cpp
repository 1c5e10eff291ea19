#include "support/subdivision.hpp"

#include <algorithm>
#include <array>

#include "support/mesh_builder.hpp"

namespace photile::bench {
namespace {

template <class T>
using Corners = std::array<T, 3>;

/// The three at the corners, then the one in the middle, wound as the whole.
template <class T>
std::array<Corners<T>, 4> quarters(const Corners<T>& whole) {
  const auto [a, b, c] = whole;
  const T ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
  return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}}};
}

/// Corners counter-clockwise seen from the front.
template <class T>
Corners<T> from_the_front(const Corners<T>& canonical, bool front_is_side_0) {
  const auto [a, b, c] = canonical;
  return front_is_side_0 ? Corners<T>{a, b, c} : Corners<T>{a, c, b};
}

/// The order in which `stored` holds the corners of `given`.
Corners<glm::vec2> in_order_of(const Corners<glm::vec3>& stored, const Corners<glm::vec3>& given,
                               const Corners<glm::vec2>& uv) {
  Corners<glm::vec2> ordered{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto place = std::find(given.begin(), given.end(), stored[i]) - given.begin();
    ordered[i] = uv[static_cast<std::size_t>(place)];
  }
  return ordered;
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
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    const bool front_is_side_0 = scene.front_side[t] == 0;
    const auto pieces = quarters(from_the_front(scene.corners(t), front_is_side_0));
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
      const auto added = static_cast<std::uint32_t>(fine.triangle_count());
      add_triangle(fine, pieces[piece]);
      fine.triangle_material.back() = scene.triangle_material[t];
      fine.triangle_light.back() = scene.triangle_light[t];
      if (scene.triangle_light[t] != none) {
        fine.lights[scene.triangle_light[t]].triangles.push_back(added);
      }
      const auto add_uv = [&](const auto& whole, auto& cut) {
        if (whole.empty()) return;
        const auto uv = quarters(from_the_front(whole[t], front_is_side_0));
        cut.push_back(in_order_of(fine.corners(added), pieces[piece], uv[piece]));
      };
      add_uv(scene.corner_uv, fine.corner_uv);
      add_uv(scene.corner_emission_uv, fine.corner_emission_uv);
    }
  }
  return fine;
}

}  // namespace photile::bench
