// A LightChange with its value parsed.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <variant>

#include "photile/layered_picture.hpp"

namespace photile::image {

/// POWER, POWERlm, POWERW
struct SetPower {
  double power;
  std::optional<PowerUnit> unit;  ///< the light's own where the value has no suffix
};

/// xFACTOR, and "off" as the factor 0
struct ScalePower {
  double factor;
};

/// #RRGGBB
struct SetColor {
  glm::dvec3 linear;  ///< Rec.709, not black
};

/// KELVINK
struct SetTemperature {
  double kelvin;
};

using Request = std::variant<SetPower, ScalePower, SetColor, SetTemperature>;

/// Errors: UsageError naming the light, the value and the forms there are.
Request understand(const LightChange& change);

/// Applies an understood change to its light. Errors: UsageError as `photile::apply`.
void apply(MixedLight& light, const Request& request, double lumen_per_watt);

/// Position of a light. Errors: UsageError listing the lights there are.
std::size_t index_of(const LightMix& mix, const std::string& name);

/// Positions of the light of this name or, where none is called so, of those whose names match the
/// glob. Errors: UsageError listing the lights there are.
std::vector<std::size_t> indices_of(const LightMix& mix, const std::string& glob);

}  // namespace photile::image
