// Unwanted reflections: pixels that mirrors, glass and glossy surfaces make brighter than eyes
// like.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"

namespace photile::image {

/// The reflection of one light.
struct LightGlare {
  std::string light;
  double fraction = 0;  ///< of the pixels, in [0, 1], whose reflection of it is above the limit
  double peak = 0;      ///< brightest of its reflections: cd/m2 or W/(m2 sr)
};

struct Glare {
  double limit = 0;                ///< luminance, cd/m2 or W/(m2 sr)
  std::vector<LightGlare> lights;  ///< of each of the mix
  /// Per pixel: the light whose reflection is brightest of those above the limit, or -1.
  std::vector<int> marks;
};

/// What is reflected of each light above a limit.
///   picture       all that is seen, whose mean luminance is that of the surroundings
///   reflections   the part of it that SceneRenderer::render_reflections gives
///   limit         above 100: cd/m2 (or W/(m2 sr)); else times the mean luminance of the picture,
///                 as evalglare's -b (Wienold and Christoffersen, 2006)
/// Errors: UsageError where the pictures differ in size.
Glare find_glare(const LightLayers& picture, const LightLayers& reflections, const LightMix& mix,
                 double limit);

/// 8-bit sRGB that marks reflections of light number `light` of a mix: colours that people with
/// colour blindness tell apart (Okabe and Ito, 2008), again from the first after seven.
std::array<std::uint8_t, 3> mark_colour(int light);

/// Marks over a picture: `rgb`, 3 bytes a pixel of 8-bit sRGB, is dimmed where there is no mark.
void draw_marks(const std::vector<int>& marks, std::vector<std::uint8_t>& rgb);

/// A line for each light whose reflections are marked.
std::vector<std::string> glare_lines(const Glare& glare, PowerUnit unit);

}  // namespace photile::image
