#include "view/moving_sky.hpp"

#include <utility>

#include "photile/defaults.hpp"

namespace photile::view {

SkySituation take_moving_sky(SceneLoadOptions& options) {
  SkySituation& situation = options.situation;
  const bool placed = situation.site || !situation.weather.empty();
  const bool asked = options.sky ? options.sky->kind == SkyKind::patches : placed;
  if (!asked || options.sun || (situation.time && !placed)) return {};
  if (!placed) {  // nothing moves its patches: they are one line of the lights
    for (const char* const glob : {"sky_[0-9]*", "ground"}) {
      options.light_groups.insert(options.light_groups.begin(), {glob, "sky"});
    }
  }
  if (!options.sky) options.sky = Sky{SkyKind::patches, 0, 0, 0, defaults::view_sky_patches};
  SkySituation taken;
  taken.north_degrees = situation.north_degrees;  // the patches know it
  std::swap(taken, situation);
  return taken;
}

}  // namespace photile::view
