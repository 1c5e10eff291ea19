#include "pictures/cube_map.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace photile::pictures {
namespace {

constexpr int samples = 4;  ///< of a texel, each way

/// Where a face lies and which way up it is.
struct Face {
  glm::dvec3 forward, up;
};
constexpr std::array<Face, 6> faces{{{{1, 0, 0}, {0, 1, 0}},
                                     {{-1, 0, 0}, {0, 1, 0}},
                                     {{0, 1, 0}, {0, 0, -1}},
                                     {{0, -1, 0}, {0, 0, 1}},
                                     {{0, 0, 1}, {0, 1, 0}},
                                     {{0, 0, -1}, {0, 1, 0}}}};

std::size_t face_towards(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  if (size.x >= size.y && size.x >= size.z) return direction.x > 0 ? 0 : 1;
  if (size.y >= size.z) return direction.y > 0 ? 2 : 3;
  return direction.z > 0 ? 4 : 5;
}

}  // namespace

const glm::vec3& radiance_towards(const CubeMap& cube, const glm::dvec3& direction) {
  const std::size_t number = face_towards(direction);
  const Face& face = faces[number];
  const RadiancePicture& picture = cube[number];
  const glm::dvec3 on_face = direction / glm::dot(direction, face.forward);
  const double right = glm::dot(on_face, glm::cross(face.forward, face.up)),
               up = glm::dot(on_face, face.up);
  const auto texel = [&](double from_border) {
    return std::clamp(static_cast<int>(0.5 * from_border * picture.width), 0, picture.width - 1);
  };
  return picture
      .texels[static_cast<std::size_t>(texel(1 - up)) * static_cast<std::size_t>(picture.width) +
              static_cast<std::size_t>(texel(1 + right))];
}

EnvironmentMap environment_of(const CubeMap& cube, const glm::dquat& rotation, std::string name) {
  const int height = 2 * cube[0].width, width = 2 * height;
  std::vector<glm::vec3> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const EnvironmentMap places("", width, height, texels);
  const glm::dmat3 to_cube = glm::transpose(glm::mat3_cast(rotation));
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      glm::dvec3 sum(0.0);
      for (int i = 0; i < samples * samples; ++i) {
        const double u = (i % samples + 0.5) / samples, v = (i / samples + 0.5) / samples;
        sum +=
            glm::dvec3(radiance_towards(cube, to_cube * places.direction_at(column + u, row, v)));
      }
      texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(column)] = glm::vec3(sum / double{samples * samples});
    }
  });
  return {std::move(name), width, height, std::move(texels)};
}

}  // namespace photile::pictures
