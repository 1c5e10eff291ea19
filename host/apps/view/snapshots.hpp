// Pictures that are kept from the walkthrough.
#pragma once

#include <filesystem>
#include <string>

#include "image/white.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "view/frame.hpp"
#include "view/moods.hpp"

namespace photile::view {

/// The frame with its layers, its camera and its white, as `render` writes EXR. Errors:
/// OutputError.
void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix, const image::White& white);

/// A copy of the scene's file with its lamps in a mood. Returns a message: the name of the file and
/// what could not be written, or what failed.
std::string write_mood(const Scene& scene, const SceneLoadOptions& load, LightBoard board,
                       const Moods& moods, const std::string& mood);

}  // namespace photile::view
