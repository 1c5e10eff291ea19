// The changes by options to the lights and materials of a scene while it is loaded.
#pragma once

#include <span>

#include "files/scene_files.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"

namespace photile::loading {

/// Sets Light::group of the lights that each grouping matches, one grouping after the other. Names
/// of lights must be final. Errors: UsageError when one matches no light (the message lists those
/// there are), or when a group bears the name of a light outside it.
void group_lights(Scene& scene, std::span<const LightGrouping> groupings);

/// Reads a photometric file that the user names. Errors: InputError for one that is missing or
/// malformed.
IntensityDistribution read_user_photometry(const std::filesystem::path& file,
                                           files::Warnings& warnings);

/// Gives lights photometric files: each becomes a point light with the file's flux, and keeps its
/// position, direction and colour. Names of lights must be final.
/// Errors: UsageError for a light that is not there, or neither point nor spot; InputError for a
/// file that is missing or malformed.
void apply_profiles(Scene& scene, std::span<const LightProfile> profiles,
                    files::Warnings& warnings);

/// Colours lights by temperature; their flux stays. Names of lights must be final.
/// Errors: UsageError for a light that is not there, or whose colours come from a picture.
void apply_temperatures(Scene& scene, std::span<const LightTemperature> temperatures);

/// Gives materials the reflectances that are asked for, in order. Errors: UsageError naming a
/// pattern that matches no material, or a material that cannot have that reflectance.
void apply_reflectances(Scene& scene, std::span<const MaterialShare> changes);

/// Makes glass of materials, see SceneLoadOptions::glasses. Errors: UsageError naming a pattern
/// that matches no material.
void apply_glasses(Scene& scene, std::span<const MaterialShare> glasses);

}  // namespace photile::loading
