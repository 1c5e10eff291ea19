// What pages load beside light maps: pictures and what is drawn over them.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "image/white.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "view/frame.hpp"
#include "view/photon_map.hpp"

namespace photile::serve {

// For `load` of page/live.js: the length of a JSON text, that text, which ends at an even place,
// and the bytes that it refers to.

/// Half floats: the radiance of each layer, times a power of two, rows from below.
std::string picture_bytes(const view::Frame& frame);

/// A byte a pixel, rows from below: 0, or 1 + the colour of the light whose reflection is above the
/// limit. The frame has its reflections.
///   limit   as image::find_glare takes it
std::string glare_bytes(const view::Frame& frame, const LightMix& mix, double limit);

/// Floats: the corners of the triangle that a ray meets, of its neighbour group and of the rest of
/// its patch, and the places of its photons and of those of the group. "" where it meets nothing.
std::string photon_bytes(const RayScene& rays, const view::InspectablePhotons& photons,
                         const glm::dvec3& eye, const glm::dvec3& direction);

/// A light of a mix as a page has set it.
struct ShownLight {
  double power = 0;
  glm::vec3 tint{1.0f};
};

/// The mix of a frame's layers, of which one may be that of a sky whose patches have the powers of
/// an hour.
///   mix      of the scene
///   lights   of the mix, in its order
LightMix mix_of_layers(const LightLayers& layers, const LightMix& mix,
                       std::span<const ShownLight> lights);

/// The white that `photile render` keeps with this picture.
image::White white_of_scene(const LightLayers& layers, const Scene& scene, double lumen_per_watt);

/// The file that `photile render` writes of this picture. Errors: OutputError.
std::string exr_of(const view::Frame& frame, const LightMix& mix, const image::White& white);

}  // namespace photile::serve
