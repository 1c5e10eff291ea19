// The sky in patches, Tregenza's 145 or Reinhart's finer ones, and as lights of a scene.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/scene.hpp"
#include "weather/perez_sky.hpp"

namespace photile::weather {

/// An even piece of the sky between two elevations and two azimuths.
struct SkyPatch {
  double azimuth_from = 0, azimuth_to = 0;  ///< radians clockwise from north
  double sine_from = 0, sine_to = 1;        ///< of the elevations
  double azimuth = 0, elevation = 0;        ///< of its middle, radians

  double solid_angle() const { return (azimuth_to - azimuth_from) * (sine_to - sine_from); }
};

/// Unit; east is +x, up +y, south +z.
glm::dvec3 direction_of(double azimuth, double elevation);

/// All patches of a sky, in the order of Radiance's gendaymtx without its ground: rows from the
/// horizon to the zenith, each clockwise from north, where the first patch has its middle.
/// Tregenza ("Subdivision of the sky hemisphere for luminance measurements", 1987) has rows of 30,
/// 30, 24, 24, 18, 12 and 6 patches and a cap; Reinhart (2001) parts each row and patch in two or
/// four.
///   count   145, 577 or 2305
std::vector<SkyPatch> sky_patches(int count);
inline constexpr int patch_counts[] = {145, 577, 2305};

/// Tells the patch that a direction points into.
class PatchFinder {
 public:
  ///   patches   as sky_patches makes them
  ///   north     radians clockwise from -z
  PatchFinder(const std::vector<SkyPatch>& patches, double north);

  /// Index of the patch of a unit direction, or below the horizon their number: the ground.
  std::uint32_t operator()(const glm::vec3& direction) const;
  std::size_t patches() const { return patches_; }

 private:
  struct Row {
    std::uint32_t first;
    float number, per_radian;  ///< patches in the row, and in a radian of it
  };
  std::vector<Row> rows_;
  std::size_t patches_;
  float rows_per_radian_, north_;
};

/// The patches that represent the sun: the four nearest to it, as in gendaymtx.
struct PatchShare {
  std::size_t patch;
  double share;  ///< of the sun's light; all sum to 1
};

/// Skies of any hours in patches.
class SkyInPatches {
 public:
  explicit SkyInPatches(const std::vector<SkyPatch>& patches);

  /// Luminance of each patch, cd/m2: that of the model in its middle, scaled together so that they
  /// give the diffuse illuminance. Without the sun itself.
  std::vector<float> luminances(const PerezSky& sky, const SunPosition& sun) const;

  std::vector<PatchShare> sun(const SunPosition& sun) const;

 private:
  std::vector<glm::vec3> middles_;  ///< unit
  std::vector<float> horizontal_;   ///< lux on the ground for each cd/m2
  std::vector<float> sines_;        ///< of the middles' elevations
};

/// "sky_0001" and so on; "ground" is what lies below the horizon.
std::string patch_name(std::size_t patch);

/// Adds a light and a layer for each patch, even and white, and one for the ground below the
/// horizon. Each has the power that it has at 1 cd/m2 (or W/(m2 sr)). Returns the number of the
/// first.
///   north   radians clockwise from -z
std::size_t add_sky_lights(const std::vector<SkyPatch>& patches, double north, Scene& scene);

/// Adds the light "ground" of even ground below the horizon, of this radiance in the scene's unit.
void add_ground_light(double radiance, Scene& scene);

/// Luminances of these lights, cd/m2, the ground last: those of a Perez sky, the sun in the four
/// patches nearest to it, and a ground of defaults::ground_reflectance that both light. The light
/// of another ground differs from it in power.
///   day   of the year, from 1
std::vector<double> sky_luminances(const std::vector<SkyPatch>& patches, const SunPosition& sun,
                                   const SkyIrradiance& irradiance, int day);

}  // namespace photile::weather
