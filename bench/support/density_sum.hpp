// The estimate from the neighbours that a rival found.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "support/host_search.hpp"

namespace photile::bench {

/// Sizes the answers. Old contents are kept where the size is right: the sums start from zero.
inline void resize(DensityAnswers& answers, std::size_t hits, std::size_t light_count) {
  answers.irradiance.resize(hits * light_count);
  answers.squared_radius.resize(hits);
}

/// Writes the answer of one hit: flux of the k - 1 nearest over the disc through the k-th; of all
/// over the disc of the radius, where fewer than k were found.
///   found      neighbours; photon(i) and squared_distance(i) give the i-th, in any order
///   farthest   index of the farthest of them
template <class Photon, class SquaredDistance>
void sum_density(const SearchInput& input, const SearchParameters& parameters, std::size_t hit,
                 std::size_t found, std::size_t farthest, Photon photon,
                 SquaredDistance squared_distance, DensityAnswers& answers) {
  const bool full = found == parameters.k;
  const float squared_radius =
      full ? squared_distance(farthest) : parameters.radius * parameters.radius;
  glm::vec3* irradiance = &answers.irradiance[hit * input.light_count];
  std::fill_n(irradiance, input.light_count, glm::vec3(0.0f));
  for (std::size_t i = 0; i < found; ++i) {
    if (full && i == farthest) continue;
    const std::uint32_t p = photon(i);
    const std::size_t light = input.photons.light.empty() ? 0 : input.photons.light[p];
    irradiance[light] += input.photons.flux[p];
  }
  const float per_area = 1.0f / (std::numbers::pi_v<float> * squared_radius);
  for (std::size_t light = 0; light < input.light_count; ++light) irradiance[light] *= per_area;
  answers.squared_radius[hit] = squared_radius;
}

}  // namespace photile::bench
