// Colours for values: the palettes of false-colour pictures.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace photile::report {

/// A run of colours from low to high, as OpenImageIO's `color_map` or Radiance's falsecolor has it.
class Palette {
 public:
  /// The names there are: "turbo" (tbo in Radiance), "viridis", "inferno", "magma", "plasma",
  /// "heat", "spectrum", and "blue-red", which is for differences: white lies in its middle; and
  /// Radiance's "def", "spec", "pm3d", "hot" and "eco".
  static const std::vector<std::string>& names();

  /// Errors: UsageError listing the names.
  explicit Palette(const std::string& name);

  /// 8-bit sRGB of a share in [0, 1]; beyond, that of the end. NaN is grey.
  std::array<std::uint8_t, 3> at(double share) const;
  /// The colour at a fraction as "#rrggbb".
  std::string hex(double share) const;

 private:
  std::vector<std::array<std::uint8_t, 3>> colours_;
};

/// Linear RGB in [0, 1] of a share in [0, 1] of a palette that is known by this name.
glm::dvec3 palette_colour(const std::string& name, double share);

}  // namespace photile::report
