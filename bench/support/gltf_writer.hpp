// Writes generated meshes as files, to time how they are read.
#pragma once

#include <filesystem>

#include "photile/scene.hpp"

namespace photile::bench {

/// Writes the triangles, the first material (diffuse) and the first light (a point light) of a
/// scene as glTF 2.0; its buffer goes beside the file, with the ending .bin. Errors: OutputError.
void write_gltf(const Scene& scene, const std::filesystem::path& file);

}  // namespace photile::bench
