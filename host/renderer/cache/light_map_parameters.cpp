// The light maps that photons of a density ask for.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "cache/light_maps.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::cache {
namespace {

/// Per oriented face: flux of its photons at the powers, luminance. Of those that this process
/// answers for, where there are several.
std::vector<double> flux_of_triangles(const Photons& photons, std::span<const double> powers) {
  std::vector<double> flux(std::max<std::size_t>(1, photons.first_of.size()) - 1, 0.0);
  tbb::parallel_for(std::size_t{0}, flux.size(), [&](std::size_t s) {
    if (photons.of_all && photons.of_all->own[s] == 0) return;
    for (std::size_t i = photons.first_of[s]; i < photons.first_of[s + 1]; ++i) {
      const std::size_t layer = photons.light.empty() ? 0 : photons.light[i];
      flux[s] += powers[layer] * luminance(glm::dvec3(photons.flux[i]));
    }
  });
  return flux;
}

/// Mean flux of a photon at the powers, luminance.
double mean_photon(const Photons& photons, std::span<const double> powers) {
  std::vector<double> flux = flux_of_triangles(photons, powers);
  if (photons.of_all) {
    // One process has a number for each, the others zeros: bits add up to those of the number.
    std::vector<std::uint64_t> bits;
    for (const double one : flux) bits.push_back(std::bit_cast<std::uint64_t>(one));
    photons.of_all->processes->sum(bits);
    for (std::size_t s = 0; s < flux.size(); ++s) flux[s] = std::bit_cast<double>(bits[s]);
  }
  const double sum = std::accumulate(flux.begin(), flux.end(), 0.0);
  return photons.total() == 0 ? 0 : sum / static_cast<double>(photons.total());
}

/// Metres: that of photons spread evenly over the triangles that have some; 0 without photons.
double mean_distance(const Scene& scene, const Photons& photons) {
  double area = 0;
  for (std::uint32_t face = 0; face + 1 < photons.first_of.size(); ++face) {
    const std::uint32_t landed = photons.of_all
                                     ? photons.of_all->landed[face]
                                     : photons.first_of[face + 1] - photons.first_of[face];
    if (landed > 0) area += triangle_area(scene, face / 2);
  }
  return photons.total() == 0 ? 0 : std::sqrt(area / static_cast<double>(photons.total()));
}

/// Metres: half the median distance from a photon to its nearest; 0 where most lie in the same
/// points.
double near_photons(const Photons& photons) {
  if (photons.total() < 2) return 0;
  try {
    return automatic_radius(photons, 1) / defaults::radius_over_median_kth_distance / 2;
  } catch (const UsageError&) {
    return 0;
  }
}

/// Metres, for estimates that reach so far. Photons know light no finer than they lie apart: most
/// may lie close together, up to a sixteenth of the mean, which is looked up where it counts.
double least_spacing(const Scene& scene, const Photons& photons, double reach) {
  const double distance = mean_distance(scene, photons);
  return reach > distance ? 0 : std::max(distance / 16, near_photons(photons));
}

}  // namespace

LightMapParameters light_map_parameters(const Scene& scene, const Photons& photons, int neighbours,
                                        double radius, double angle_degrees, double spacing,
                                        double detail, std::span<const double> powers) {
  // The radius is so many times the distance to the k-th photon of a typical estimate.
  const double reach = radius / defaults::radius_over_median_kth_distance;
  LightMapParameters parameters;
  const double steps = std::max(
      std::round(std::log2(reach / defaults::light_map_spacing)),
      std::ceil(std::log2(least_spacing(scene, photons, reach) / defaults::light_map_spacing)));
  parameters.spacing = spacing > 0 ? spacing : defaults::light_map_spacing * std::exp2(steps);
  if (detail > 0) {
    // One more where the division is a rounding above a power of two would halve the detail again.
    const double halvings = std::ceil(std::log2(parameters.spacing / detail) - 1e-9);
    parameters.levels =
        1 + static_cast<int>(std::clamp(halvings, 0.0, limits::max_light_map_levels - 1.0));
  }
  parameters.angle_degrees = angle_degrees;
  parameters.neighbours = neighbours;
  // Where k photons are just within the radius.
  parameters.sparse_irradiance =
      neighbours * mean_photon(photons, powers) / (glm::pi<double>() * radius * radius);
  parameters.powers.assign(powers.begin(), powers.end());
  return parameters;
}

}  // namespace photile::cache
