#pragma once

#include <tiny_obj_loader.h>

#include "pictures/textures.hpp"
#include "reading/import_context.hpp"

namespace photile::obj {

/// Fills the context's scene from its OBJ file. Errors: InputError.
void import_obj(reading::ImportContext& context);

// MTL materials to photile's.

/// Appends one material and its emission to the context. OBJ emission is W/(m2 sr), from the front
/// side only.
///
/// | MTL                                            | becomes                                   |
/// |------------------------------------------------|-------------------------------------------|
/// | Pr or Pm above 0                               | metallic-roughness with base colour Kd    |
/// | illum 4, 6, 7, 9; or d < 1, Ni and no map_d    | glass of index Ni (1.5 without), tint Tf  |
/// | illum 3, 5 with Ns >= 1000, or black Kd and Ks | mirror with reflectance Ks                |
/// | illum 2, 3, 5 with Ks                          | Lambertian Kd plus a GGX lobe of F0 Ks    |
/// | anything else                                  | Lambertian Kd                             |
/// | map_d; or d < 1 without Ni                     | opacity: holes, by chance in between      |
/// | norm                                           | a normal map, -bm its scale               |
void add_mtl_material(const tinyobj::material_t& source, pictures::TextureStore& textures,
                      reading::ImportContext& context);

/// Appends a mid-grey material for a name that no library defines.
void add_missing_material(const std::string& name, reading::ImportContext& context);

}  // namespace photile::obj
