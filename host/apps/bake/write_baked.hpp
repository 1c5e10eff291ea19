// A baked scene as files: glTF with a second set of texture coordinates, and a picture per light.
#pragma once

#include <filesystem>
#include <vector>

#include "bake/baked_light.hpp"
#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"

namespace photile::bake {

/// The files that are written for `file`: itself and an EXR for each layer; for a .gltf also its
/// .bin and a PNG for each texture of base colours, which a .glb holds.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file, const Scene& scene,
                                            const LightMix& mix);

/// Writes them. Each corner of a triangle is a separate vertex; the coordinates of light are
/// TEXCOORD_1. The picture of a layer is the irradiance of its lights at their powers and tints in
/// the mix, linear Rec.709, in the unit of the scene per square metre; the document names it in
/// extras.photile of the scene. Errors: OutputError.
void write_baked(const std::filesystem::path& file, const Scene& scene, const BakedLight& baked,
                 const LightMix& mix);

}  // namespace photile::bake
