#include "render/first_picture.hpp"

#include <algorithm>

#include "photile/defaults.hpp"
#include "render/render_plan.hpp"

namespace photile {
namespace {

/// Metres; no coarsest nodes lie farther apart, so that there are none but those.
constexpr double no_detail = 1e30;

}  // namespace

RenderParameters first_picture_parameters(const RenderParameters& asked) {
  RenderParameters first = asked;
  first.photons.emitted_photons =
      std::min(asked.photons.emitted_photons, defaults::view_first_photons);
  first.passes = 1;
  first.radius = 0;
  first.least_neighbours = 0;
  first.light_maps = LightMapMode::on;
  if (nodes_gather(asked)) {
    first.neighbours = defaults::view_first_neighbours;
    first.light_map_spacing = defaults::view_first_spacing;
    first.light_map_detail = defaults::view_first_spacing / 4;
  } else {
    first.direct_rays = first.light_map_rays = 0;
    first.light_map_detail = no_detail;
  }
  if (asked.maps == MapMode::naive) first.maps = MapMode::automatic;
  return first;
}

}  // namespace photile
