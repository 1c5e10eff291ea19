#include "cache/irradiance_filter.hpp"

#include "cache/weighted_points.hpp"

namespace photile::cache {

GatheredIrradiance filter_irradiance(GatheredIrradiance irradiance, const PointLinks& links,
                                     std::span<const double> layer_powers,
                                     const IrradianceFilterParameters& parameters) {
  for (int round = 0; round < parameters.rounds; ++round) {
    irradiance =
        means_of(irradiance, links.first.size() - 1, layer_powers, [&](std::size_t i, auto& light) {
          light.add_own(irradiance, i);
          for (const std::uint32_t other : links.of(i)) {
            light.add_other(irradiance, other, parameters.tolerated);
          }
        });
  }
  return irradiance;
}

}  // namespace photile::cache
