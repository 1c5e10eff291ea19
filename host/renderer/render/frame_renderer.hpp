// Pictures of the light on surfaces alone, quick enough to walk in: a ray and a query per sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cache/frame_view.hpp"
#include "cache/light_maps.hpp"
#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "trace/distant_light.hpp"

namespace photile {

/// Draws frames from light maps. Rays pass through the same positions in every pixel; mirrors,
/// glass and cutouts are followed; a specular lobe is replaced by matt reflection of the same
/// strength, and normal maps are left out.
class FrameRenderer {
 public:
  /// References are kept.
  FrameRenderer(const RayScene& rays, cache::LightMaps& maps);

  /// The light of its light maps.
  cache::FrameView& view() { return view_; }

  /// Draws a picture of the film's size, linear RGB radiance, row 0 at the top. Points for which
  /// light maps have no light show that of `coarser`; points without that, the light of the nodes
  /// around them.
  ///   powers    per layer: power x tint
  ///   filling   of nodes which pixels lack: the coarsest, on charts that take most of the picture
  ///             first, then finer ones where light differs most; their pixels are drawn again
  ///   coarser   of the same scene, whose nodes are filled first; null = none
  /// Errors: those of LightMaps::fill.
  DrawnFrame draw(const Camera& camera, const Film& film, std::span<const glm::vec3> powers,
                  const FrameFilling& filling, std::span<glm::vec3> picture,
                  const Progress& progress, cache::FrameView* coarser = nullptr);

  /// Takes the irradiance of a layer at power 1 at points, in their order.
  using TakeLight = std::function<void(std::size_t layer, std::span<const glm::vec3> irradiance)>;
  /// The light of each layer at points of opaque surfaces, one layer after the other, as pictures
  /// show it by now: that of these light maps, of `coarser`, or from around. Values no node. To be
  /// called where `draw` may be, or while it shows a picture (FrameFilling::show).
  ///   soft   as FrameFilling has it
  /// Returns 1 for points whose light is final, else 0.
  std::vector<std::uint8_t> light_at(const PrimaryHits& points, bool soft, const TakeLight& take,
                                     cache::FrameView* coarser = nullptr);

 private:
  class Picture;

  /// The data of a triangle that a frame needs, close together.
  struct Surface {
    glm::vec3 reflects;  ///< radiance per irradiance, where it is uniform
    enum Kind : std::uint32_t { plain, textured, light, followed } kind;
  };

  const RayScene& rays_;
  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> layer_of_;  ///< per light
  std::vector<glm::vec3> emitted_;       ///< per light, at power 1
  trace::DistantLights distant_;
  cache::FrameView view_;
};

}  // namespace photile
