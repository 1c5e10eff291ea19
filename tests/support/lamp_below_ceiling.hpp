// A lamp without size below a white ceiling, above a black floor: what is reflected is reflected
// once, and quadrature over the directions of the lamp tells it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "test_scenes.hpp"
#include "trace/emission_sampling.hpp"

namespace photile::test {

constexpr double ceiling_albedo = 0.7;
constexpr float ceiling_height = 3, ceiling_half_side = 2;  // metres

inline SceneBuilder ceiling_and_floor() {
  SceneBuilder builder("ceiling");
  builder.grid({-ceiling_half_side, -ceiling_half_side, ceiling_height},
               {0, 2 * ceiling_half_side, 0}, {2 * ceiling_half_side, 0, 0}, 1,
               builder.add(diffuse(ceiling_albedo)));
  builder.grid({-ceiling_half_side, -ceiling_half_side, 0}, {2 * ceiling_half_side, 0, 0},
               {0, 2 * ceiling_half_side, 0}, 1, builder.add(diffuse(0.0f)));
  return builder;
}

/// Calls visit(point of the ceiling, lumens) for equal parts of the directions above a lamp, as far
/// as they meet the ceiling.
template <class Visit>
void for_each_lit(const Scene& scene, const Light& lamp, const Visit& visit) {
  constexpr int polar = 4000, turns = 200;
  const glm::dvec3 from(lamp.position);
  for (int i = 0; i < polar; ++i) {
    const double cosine = (i + 0.5) / polar, sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < turns; ++j) {
      const double turn = glm::two_pi<double>() * (j + 0.5) / turns;
      const glm::dvec3 direction(sine * std::cos(turn), sine * std::sin(turn), cosine);
      const glm::dvec3 lit = from + (double{ceiling_height} - from.z) / cosine * direction;
      if (std::max(std::abs(lit.x), std::abs(lit.y)) > double{ceiling_half_side}) continue;
      visit(lit, glm::two_pi<double>() / (polar * turns) *
                     trace::candela_per_lumen(scene, lamp, direction));
    }
  }
}

/// Lux, for a lumen of the lamp, at a point that faces up: directly and from the ceiling.
inline double lux_below_ceiling(const Scene& scene, const Light& lamp, const glm::dvec3& point) {
  const glm::dvec3 way = point - glm::dvec3(lamp.position);
  const double distance = glm::length(way);
  double sum =
      trace::candela_per_lumen(scene, lamp, way / distance) * -way.z / std::pow(distance, 3);
  for_each_lit(scene, lamp, [&](const glm::dvec3& lit, double lumens) {
    const glm::dvec3 down = lit - point;
    const double squared = glm::dot(down, down);
    sum += lumens * ceiling_albedo / glm::pi<double>() * down.z * down.z / (squared * squared);
  });
  return sum;
}

}  // namespace photile::test
