#include "view/frame.hpp"

#include <algorithm>
#include <utility>

#include "photile/light_layers.hpp"

namespace photile::view {
namespace {

/// Mean square over squared mean of a kernel's weights on its disc: by so much it raises the
/// variance of an estimate.
double spread_of(DensityKernel kernel) {
  switch (kernel) {
    case DensityKernel::constant:
      return 1;
    case DensityKernel::cone:
      return 3.0 / 2;
    case DensityKernel::epanechnikov:
      return 4.0 / 3;
  }
  return 1;
}

}  // namespace

EstimateNoise EstimateNoise::of(const Scene& scene, const RenderParameters& parameters) {
  const int fewest = parameters.least_neighbours > 0
                         ? std::min(parameters.least_neighbours, parameters.neighbours)
                         : parameters.neighbours;
  // The area is that to the k-th photon: the variance of its inverse is 1 / (k - 2).
  EstimateNoise noise{std::max(1, fewest - 2) / spread_of(parameters.kernel), {}};
  const LightGroups groups = light_groups_of(scene);
  noise.paths.resize(groups.groups.size());
  const auto paths =
      photons_per_light(scene, parameters.photons.emitted_photons, parameters.photons.quota);
  for (std::size_t light = 0; light < paths.size(); ++light) {
    noise.paths[groups.group_of[light]] += static_cast<double>(paths[light]);
  }
  return noise;
}

EstimateNoise EstimateNoise::pooled(const LightPooling& pooling) const {
  std::vector<double> sums(pooling.layers.size()), powers(pooling.layers.size());
  for (std::size_t light = 0; light < paths.size(); ++light) {
    sums[pooling.layer_of[light]] += paths[light];
    powers[pooling.layer_of[light]] += static_cast<double>(pooling.scale[light]);
  }
  for (std::size_t layer = 0; layer < sums.size(); ++layer) {
    sums[layer] = powers[layer] > 0 ? sums[layer] / powers[layer] : 0.0;
  }
  return {photons, std::move(sums)};
}

}  // namespace photile::view
