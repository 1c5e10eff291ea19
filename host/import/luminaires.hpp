// Measured lamps that a user places: their luminous openings emit from their true area.
#pragma once

#include <filesystem>

#include "import/warnings.hpp"
#include "photile/scene.hpp"

namespace photile::scene_io {

/// Adds the lamps of a JSON file, an object or a list of them, to a scene with its triangles and
/// area lights: for each a flat opening that shines by the intensities of its photometric file.
/// Members: `file` (.ies or .ldt, beside the JSON file), `position` (metres in the scene file's
/// world, the middle of the array; "ceiling" = the middle of the ceiling of the first camera's
/// room), `aim` (down), `rotation` (degrees about the aim), `lumens` (those of the file), `count`
/// and `spacing` (along the lamp's x axis and across), `size` of the opening in metres (x, across; the file's),
/// `name`, which is that of the layer that all of an entry share. Lamps without a camera count on
/// default_camera. Errors: InputError naming the file, the entry and the member.
void add_luminaires(const std::filesystem::path& file, double lumen_per_watt, Scene& scene,
                    Warnings& warnings);

}  // namespace photile::scene_io
