// The sky of another hour for a picture whose sky is patches.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/light_options.hpp"
#include "weather/sky_patches.hpp"

namespace photile::loading {

/// The patches that lights of a mix are; none where they are no whole sky.
std::vector<weather::SkyPatch> patches_of(const LightMix& mix);

/// The name of a light of sky_luminances: a patch, or the ground.
std::string sky_light_name(std::size_t light, std::size_t patches);

/// Changes that give each patch of a picture the luminance of the situation's Perez sky, and the
/// four patches nearest to the sun its light. The sky is that of the weather file's hour unless one
/// is given, and a clear one where neither is; the patches know where north is.
/// Errors: UsageError where the picture has no patches (the remedy says how to render some), or
/// where the place, the time or the sky is missing; those of read_weather.
std::vector<LightChange> sky_changes(const LightMix& mix, const SkySituation& situation,
                                     const std::optional<Sky>& sky);

}  // namespace photile::loading
