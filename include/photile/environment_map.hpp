// Light from all around: a picture of the sky, or of any surroundings, infinitely far away.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace photile {

/// An equirectangular picture of radiance. Its rows run from the zenith (+y) to the nadir, its
/// columns along the horizon; the middle column lies towards -z, turned by `rotation` towards +x,
/// and azimuths grow to the right, as for an observer inside. Each texel is an even patch of sky,
/// so that integrals over it are exact.
class EnvironmentMap {
 public:
  /// `texels`: width x height, row 0 at the top, linear RGB, finite and not negative.
  /// `rotation`: degrees clockwise as seen from above. Errors: std::invalid_argument.
  EnvironmentMap(std::string name, int width, int height, std::vector<glm::vec3> texels,
                 double rotation = 0);

  /// Radiance that arrives from a unit direction, cd/m2 or W/(m2 sr).
  const glm::vec3& radiance(const glm::vec3& direction) const {
    return texels_[texel_towards(direction)];
  }

  /// Integral of the radiance over the sphere, lm/m2 or W/m2 per channel.
  const glm::dvec3& integral() const { return integral_; }

  /// Solid angle of each texel of a row, steradian.
  double solid_angle(int row) const;
  /// Index of the texel that a unit direction points to.
  std::size_t texel_towards(const glm::vec3& direction) const;
  /// Direction of a place of the picture; `column` in [0, width], and the share `v` in [0, 1] of
  /// the solid angle of its row that lies above.
  glm::dvec3 direction_at(double column, int row, double v) const;

  const std::string& name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }
  const glm::vec3& texel(int column, int row) const {
    return texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(column)];
  }

 private:
  std::string name_;
  int width_ = 0, height_ = 0;
  double rotation_ = 0;  ///< radians
  std::vector<glm::vec3> texels_;
  glm::dvec3 integral_{0.0};
};

}  // namespace photile
