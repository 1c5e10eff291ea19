// Surroundings on the six faces of a cube.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "photile/environment_map.hpp"
#include "pictures/texture_decoder.hpp"

namespace photile::pictures {

/// Faces +x, -x, +y, -y, +z, -z, each as an observer in the middle sees it: with +y at the top; of
/// +y -z at the top, and of -y +z. All are square and of one size, of a texel at least.
using CubeMap = std::array<RadiancePicture, 6>;

/// Texel of a unit direction.
const glm::vec3& radiance_towards(const CubeMap& cube, const glm::dvec3& direction);

/// The cube, turned by `rotation`, as an equirectangular map of about the same resolution: each
/// texel is the mean over its solid angle, by 4 x 4 samples.
EnvironmentMap environment_of(const CubeMap& cube, const glm::dquat& rotation, std::string name);

}  // namespace photile::pictures
