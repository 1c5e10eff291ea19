#include "daylight/sky_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace photile::daylight {
namespace {

using std::numbers::pi;

}  // namespace

glm::dvec3 direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          -std::cos(elevation) * std::cos(azimuth)};
}

std::vector<SkyPatch> sky_patches(int count) {
  constexpr std::array<int, 7> in_row{30, 30, 24, 24, 18, 12, 6};
  const int parts = count <= 145 ? 1 : count <= 577 ? 2 : 4;
  const double height = pi / 2 / (7 * parts + 0.5);
  std::vector<SkyPatch> patches;
  for (int row = 0; row < 7 * parts; ++row) {
    const int number = in_row[static_cast<std::size_t>(row / parts)] * parts;
    const double width = 2 * pi / number;
    for (int i = 0; i < number; ++i) {
      patches.push_back({(i - 0.5) * width, (i + 0.5) * width, std::sin(height * row),
                         std::sin(height * (row + 1)), i * width, height * (row + 0.5)});
    }
  }
  patches.push_back({0, 2 * pi, std::sin(height * 7 * parts), 1, 0, pi / 2});
  return patches;
}

std::vector<double> patch_luminances(const std::vector<SkyPatch>& patches, const PerezSky& sky,
                                     const SunPosition& sun) {
  const glm::dvec3 to_sun = direction_of(sun.azimuth, pi / 2 - zenith_of_sun(sun.elevation));
  std::vector<double> luminances;
  double horizontal = 0;
  for (const SkyPatch& patch : patches) {
    const double cosine = glm::dot(to_sun, direction_of(patch.azimuth, patch.elevation));
    luminances.push_back(
        sky.relative_luminance(patch.elevation, std::acos(std::clamp(cosine, -1.0, 1.0))));
    horizontal += luminances.back() * std::sin(patch.elevation) * patch.solid_angle();
  }
  if (!(horizontal > 0)) {  // the model is dark everywhere
    std::fill(luminances.begin(), luminances.end(), 1.0);
    horizontal = pi;
  }
  for (double& luminance : luminances) luminance *= sky.diffuse_illuminance() / horizontal;
  return luminances;
}

std::vector<PatchShare> sun_patches(const std::vector<SkyPatch>& patches, const SunPosition& sun) {
  constexpr std::size_t nearest = 4;
  const glm::dvec3 to_sun = direction_of(sun.azimuth, sun.elevation);
  std::vector<PatchShare> shares;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const double cosine = glm::dot(to_sun, direction_of(patches[i].azimuth, patches[i].elevation));
    shares.push_back({i, 1 / (1.002 - cosine)});
  }
  std::partial_sort(shares.begin(), shares.begin() + nearest, shares.end(),
                    [](const PatchShare& a, const PatchShare& b) { return a.share > b.share; });
  shares.resize(nearest);
  double sum = 0;
  for (const PatchShare& share : shares) sum += share.share;
  for (PatchShare& share : shares) share.share /= sum;
  return shares;
}

}  // namespace photile::daylight
