// Pictures that are kept from the walkthrough.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/white.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "view/frame.hpp"
#include "view/moods.hpp"
#include "view/point_worker.hpp"

namespace photile::view {

/// The first of STEM-0001EXTENSION, STEM-0002EXTENSION ... that is not there yet.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension);

/// Has `write` write a file of a free name. Returns a message: the name, or what failed.
std::string keep_as(const std::filesystem::path& folder, const std::string& stem,
                    const std::string& extension,
                    const std::function<void(const std::filesystem::path&)>& write);

/// The list of points as points-0001.pts and .csv. Returns a message.
std::string keep_points(const std::filesystem::path& folder,
                        const std::vector<ClickedPoint>& points, const LightBoard& lights,
                        double maintenance);

/// sRGB texels, row 0 at the top, to PNG. Errors: OutputError.
void write_screenshot(const std::filesystem::path& file, int width, int height,
                      std::span<const std::uint8_t> rgb);

/// The frame with its layers, its camera and its white, as `render` writes EXR. Errors:
/// OutputError.
void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix, const image::White& white);

/// A copy of the scene's file with its lamps in a mood. Returns a message: the name of the file and
/// what could not be written, or what failed.
std::string write_mood(const Scene& scene, const SceneLoadOptions& load, LightBoard board,
                       const Moods& moods, const std::string& mood);

}  // namespace photile::view
