#include "loading/sky_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace photile::loading {
namespace {

using std::numbers::pi;
constexpr int rows = 512;  // a third of a degree each
constexpr int columns = 1024;
/// Of what does not depend on the azimuth: portals show some of them more than others.
constexpr int even_columns = 64;

/// Luminance of a clear sky over a factor that is the same everywhere: ISO 15469, type 12.
double clear_luminance(const glm::dvec3& direction, const glm::dvec3& to_sun) {
  constexpr double a = -1, b = -0.32, c = 10, d = -3, e = 0.45;
  const double cosine = std::clamp(glm::dot(direction, to_sun), -1.0, 1.0);
  const double from_sun = std::acos(cosine);
  const double gradation = 1 + a * std::exp(b / std::max(direction.y, 1e-9));
  const double indicatrix =
      1 + c * (std::exp(d * from_sun) - std::exp(d * pi / 2)) + e * cosine * cosine;
  return gradation * indicatrix;
}

/// Sine of the elevation of the upper border of a row.
double sine_above(int row) { return std::cos(pi * row / rows); }

}  // namespace

glm::dvec3 direction_to(const Sun& sun) {
  const double azimuth = sun.azimuth_degrees * pi / 180,
               elevation = sun.elevation_degrees * pi / 180;
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          -std::cos(elevation) * std::cos(azimuth)};
}

EnvironmentMap sky_map(SkyKind kind, double illuminance, const glm::dvec3& to_sun,
                       const weather::PerezSky* perez) {
  const bool by_azimuth = kind == SkyKind::clear || kind == SkyKind::perez;
  const int width = by_azimuth ? columns : even_columns;
  const EnvironmentMap places("sky", width, rows,
                              std::vector<glm::vec3>(static_cast<std::size_t>(width * rows)));
  std::vector<double> texels;
  double horizontal = 0;  // illuminance
  for (int row = 0; row < rows / 2; ++row) {
    const double above = sine_above(row), below = sine_above(row + 1);
    for (int column = 0; column < width; ++column) {
      double value = 1;
      // The mean over the row, exactly, so that the closed form of the illuminance holds.
      if (kind == SkyKind::overcast) value = 1 + above + below;
      if (kind == SkyKind::perez) {
        const glm::dvec3 direction = places.direction_at(column + 0.5, row, 0.5);
        value = double{perez->relative_luminance(static_cast<float>(direction.y),
                                                 static_cast<float>(glm::dot(direction, to_sun)))};
      }
      if (kind == SkyKind::clear)
        value = clear_luminance(places.direction_at(column + 0.5, row, 0.5), to_sun);
      texels.push_back(value);
      horizontal += value * pi / width * (above * above - below * below);
    }
  }
  if (!(horizontal > 0)) return sky_map(SkyKind::uniform, illuminance, to_sun);
  std::vector<glm::vec3> scaled(static_cast<std::size_t>(width * rows), glm::vec3(0.0f));
  for (std::size_t i = 0; i < texels.size(); ++i) {
    scaled[i] = glm::vec3(static_cast<float>(texels[i] * illuminance / horizontal));
  }
  return {"sky", width, rows, std::move(scaled)};
}

}  // namespace photile::loading
