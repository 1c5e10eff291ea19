#include <utility>

#include "photile/neighbour_groups.hpp"

namespace photile {
namespace {

std::vector<std::uint8_t> where_landed(const Photons& photons) {
  std::vector<std::uint8_t> landed(photons.first_of.size() - 1);
  for (std::size_t s = 0; s < landed.size(); ++s) {
    const bool any = photons.of_all ? photons.of_all->landed[s] > 0
                                    : photons.first_of[s] < photons.first_of[s + 1];
    landed[s] = any ? 1 : 0;
  }
  return landed;
}

}  // namespace

NeighbourGroups find_map_groups(const Scene& scene, const Photons& photons, MapMode mode,
                                const NeighbourGroupParameters& parameters, Progress& progress,
                                MapUsers users) {
  if (mode == MapMode::naive) return naive_groups(scene);
  const std::vector<std::uint8_t> landed =
      users == MapUsers::these_photons ? where_landed(photons) : std::vector<std::uint8_t>{};
  Patches patches = find_patches(scene, parameters.radius, mode);
  return merge_patches(
      scene, find_patch_groups(scene, std::move(patches), parameters, progress, landed), photons);
}

}  // namespace photile
