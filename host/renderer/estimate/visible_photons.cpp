#include "estimate/visible_photons.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "estimate/light_at_points.hpp"
#include "photile/defaults.hpp"
#include "photile/limits.hpp"
#include "trace/ray_query.hpp"

namespace photile::estimate {
VisiblePhotons::VisiblePhotons(const RayScene& rays, const Photons& photons)
    : rays_(rays),
      position_(photons.position),
      oriented_face_(photons.oriented_face),
      light_(photons.light) {
  flux_.reserve(photons.size());
  for (const glm::vec3& flux : photons.flux) {
    flux_.push_back(static_cast<float>(luminance(glm::dvec3(flux))));
  }
}

std::vector<std::uint32_t> VisiblePhotons::lit(const Estimates& estimates, std::size_t hits,
                                               std::size_t lights) {
  std::vector<std::uint32_t> lit;
  for (std::uint32_t hit = 0; hit < hits; ++hit) {
    bool any = false;
    for_each_estimate(estimates, hit, lights, [&](std::size_t, std::size_t i) {
      any = any || estimates.irradiance[i] != glm::vec3(0.0f);
    });
    if (any) lit.push_back(hit);
  }
  return lit;
}

void VisiblePhotons::leave_out_hidden(const PrimaryHits& hits,
                                      std::span<const std::uint32_t> chosen,
                                      const NeighbourLists& near, Estimates& estimates) const {
  const Scene& scene = rays_.scene();
  const std::size_t lights = rays_.needs().light_count;
  const auto k = static_cast<std::size_t>(near.k);
  tbb::parallel_for(std::size_t{0}, chosen.size(), [&](std::size_t row) {
    const trace::FlushDenormals flush_denormals;
    thread_local std::vector<double> all, seen;
    all.assign(lights, 0.0);
    seen.assign(lights, 0.0);
    const std::uint32_t hit = chosen[row];
    const float offset = defaults::photon_ray_offset * std::sqrt(near.squared_radius[row]);
    const trace::SurfaceLocation here =
        trace::location_on(scene, hits.oriented_face[hit], hits.position[hit]);
    for (const std::uint32_t photon : std::span(near.photons).subspan(row * k, k)) {
      if (photon == none) break;
      const std::size_t layer = light_.empty() ? 0 : light_[photon];
      all[layer] += flux_[photon];
      const trace::SurfaceLocation there =
          trace::location_on(scene, oriented_face_[photon], position_[photon]);
      // Nodes may lie on the foot of a wall: the line ends short of them.
      if (trace::see_each_other(rays_, there, here, {offset, defaults::visibility_left_out}))
        seen[layer] += flux_[photon];
    }
    for_each_estimate(estimates, hit, lights, [&](std::size_t layer, std::size_t i) {
      if (!(seen[layer] < all[layer])) return;
      const auto fraction = static_cast<float>(seen[layer] / all[layer]);
      estimates.irradiance[i] *= fraction;
      if (!estimates.radiance.empty()) estimates.radiance[i] *= fraction;
    });
  });
}

}  // namespace photile::estimate
