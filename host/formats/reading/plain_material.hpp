// Materials of surfaces whose textures cannot be placed.
#pragma once

#include <cstdint>
#include <map>

#include "photile/scene.hpp"

namespace photile::reading {

/// Materials as surfaces without texture coordinates have them: mid grey in place of a base-colour
/// texture, as where its file is missing, the factors alone in place of all others, and no normal
/// map.
class PlainMaterials {
 public:
  explicit PlainMaterials(Scene& scene) : scene_(scene) {}

  /// The one that stands in for `material` of the scene; it is added when it is first asked for,
  /// and named after it.
  std::uint32_t of(std::uint32_t material);

 private:
  Scene& scene_;
  std::map<std::uint32_t, std::uint32_t> index_;
};

}  // namespace photile::reading
