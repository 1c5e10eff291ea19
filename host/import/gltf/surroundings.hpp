// EXT_lights_image_based: surroundings that a glTF scene names.
#pragma once

#include "import/gltf/accessor.hpp"
#include "import/gltf/tiny_gltf.hpp"
#include "import/import_context.hpp"

namespace photile::scene_io {

/// Adds the environment light of the scene that is loaded, if it has one; triangles must be there.
/// The sharpest of its cube maps is what surrounds the scene: the others, and the coefficients of
/// irradiance, are the same light blurred for programs that do not trace it. Its values times
/// `intensity` are taken as cd/m2; PNGs with alpha are RGBD, linear value = sRGB-decoded RGB /
/// alpha. Surroundings that cannot be read are named in a warning. Errors: InputError where there
/// is no such light.
void add_gltf_surroundings(const tinygltf::Model& model, const AccessorReader& accessors,
                           ImportContext& context);

}  // namespace photile::scene_io
