#include <utility>

#include "photile/neighbour_groups.hpp"

namespace photile {

NeighbourGroups find_map_groups(const Scene& scene, const Photons& photons, MapMode mode,
                                const NeighbourGroupParameters& parameters, Progress& progress) {
  if (mode == MapMode::naive) return naive_groups(scene);
  Patches patches = find_patches(scene, parameters.radius, mode);
  return merge_patches(scene, find_patch_groups(scene, std::move(patches), parameters, progress),
                       photons);
}

}  // namespace photile
