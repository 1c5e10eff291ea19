#include <algorithm>

#include "photile/limits.hpp"
#include "tools/trade/trade.hpp"

namespace photile {
namespace {

/// `value` times the factors, within [least, most], each once, ascending.
template <class T>
std::vector<T> scaled(T value, std::initializer_list<double> factors, T least, T most) {
  std::vector<T> values;
  for (const double factor : factors) {
    const double product = std::clamp(static_cast<double>(value) * factor,
                                      static_cast<double>(least), static_cast<double>(most));
    values.push_back(static_cast<T>(product));
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace

TradeAxes TradeAxes::around(const RenderParameters& parameters) {
  TradeAxes axes;
  axes.photons = scaled<std::uint64_t>(parameters.photons.emitted_photons, {1. / 16, 0.25, 1, 4},
                                       limits::min_photons, limits::max_emitted_photons);
  axes.neighbours = scaled<int>(parameters.neighbours, {0.25, 1, 4, 16}, 1, limits::max_neighbours);
  axes.least_neighbours = scaled<int>(parameters.neighbours, {1.0}, 1, limits::max_neighbours);
  axes.radius_scales = {0.25, 0.5, 2};
  axes.angles = {30, 90};
  axes.photons_per_cell = scaled<float>(parameters.photons_per_cell, {0.25, 4}, 1e-3f, 1e6f);
  axes.samples =
      scaled<int>(parameters.film.samples_per_pixel, {0.25, 4}, 1, limits::max_samples_per_pixel);
  axes.areas = {AreaMode::disc};
  for (const DensityKernel kernel : all_density_kernels) {
    if (kernel != parameters.kernel) axes.kernels.push_back(kernel);
  }
  if (parameters.direct_rays == 0) axes.direct_rays = {1, 4};
  axes.node_rays = {16, 64, 256};
  axes.maps = {MapMode::naive, MapMode::triangle, MapMode::patch};
  for (const MapStructure structure : all_map_structures) {
    // Of the structures over all photons the classic one stands for all.
    const bool other_global = is_global(structure) && structure != MapStructure::kdtree_global;
    if (structure != MapStructure::brute_force && !other_global)
      axes.structures.push_back(structure);
  }
  return axes;
}

}  // namespace photile
