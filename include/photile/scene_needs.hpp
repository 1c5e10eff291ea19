// What a scene asks of every later stage, in one record.
#pragma once

#include <cstdint>

#include "photile/scene.hpp"

namespace photile {

/// Up to this many layers (see light_groups.hpp) each has a value at every hit and pixel. With
/// more, memory and time grow with the lights that reach a hit, not with all.
inline constexpr std::uint32_t max_dense_lights = 8;

/// What later stages must provide for; whatever is false costs nothing anywhere. From it follow the
/// records of photons and hits, the buffers of maps and estimates, the symbols that kernels are
/// compiled with, and what shadow rays look at (docs/kernels.md, "Records").
struct SceneNeeds {
  bool glossy = false;       ///< some opaque material has a specular lobe or a normal map
  bool normal_maps = false;  ///< some opaque material has a normal map
  /// Some opaque surface without a normal map has vertex normals that differ from its triangles'.
  bool smooth_shading = false;
  bool textures = false;        ///< some material has a texture
  bool specular_paths = false;  ///< some material is a mirror or glass
  bool see_through = false;  ///< some material is thin glass or has holes, which shadow rays pass
  std::uint32_t light_count = 0;  ///< layers: a group of lights counts as one

  /// Whether photons and estimates tell lights apart.
  bool several_lights() const { return light_count > 1; }
  /// Whether only the lights that reach a point are kept for it.
  bool many_lights() const { return light_count > max_dense_lights; }
};

/// Looks at every triangle: RayScene::needs() and MapStore::needs keep the answer. Materials that
/// no triangle has ask for nothing.
SceneNeeds needs_of(const Scene& scene);

}  // namespace photile
