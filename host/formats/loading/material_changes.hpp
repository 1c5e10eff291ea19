// What the user changes in the materials of a scene while it is loaded.
#pragma once

#include <span>

#include "files/warnings.hpp"
#include "photile/scene.hpp"

namespace photile::loading {

/// Gives materials the reflectances that are asked for, in order. Errors: UsageError naming a
/// pattern that matches no material, or a material that cannot have that reflectance.
void apply_reflectances(Scene& scene, std::span<const ReflectanceChange> changes);

}  // namespace photile::loading
