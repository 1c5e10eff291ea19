// Cube maps by OpenGL's table of faces, flipped as EXT_lights_image_based asks: independent of how
// the importer looks them up.
#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>

#include "pictures/textures.hpp"

namespace photile::test {

/// OpenGL 4.6, table 8.19: the direction of a place of a face, s and t from 0 to 1, t from the
/// first row of texels on.
inline glm::dvec3 opengl_direction(std::size_t face, double s, double t) {
  const double sc = 2 * s - 1, tc = 2 * t - 1;
  const std::array<glm::dvec3, 6> directions{
      {{1, -tc, -sc}, {-1, -tc, sc}, {sc, 1, tc}, {sc, -1, -tc}, {sc, -tc, 1}, {-sc, -tc, -1}}};
  return glm::normalize(directions[face]);
}

/// Direction of the middle of a texel: "each saved image must be flipped about its vertical axis".
inline glm::dvec3 texel_direction(std::size_t face, int column, int row, int side) {
  return opengl_direction(face, 1 - (column + 0.5) / side, (row + 0.5) / side);
}

/// A cube whose texels hold `radiance` of their directions.
inline pictures::CubeMap cube_of(int side,
                                 const std::function<glm::vec3(const glm::dvec3&)>& radiance) {
  pictures::CubeMap cube;
  for (std::size_t face = 0; face < 6; ++face) {
    cube[face] = {side, side, {}};
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        cube[face].texels.push_back(radiance(texel_direction(face, column, row, side)));
      }
    }
  }
  return cube;
}

}  // namespace photile::test
