// Pictures of the light on surfaces alone, quick enough to walk in: a ray and a lookup a pixel.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "light_maps/node_mix.hpp"
#include "photile/camera.hpp"
#include "photile/light_groups.hpp"
#include "photile/light_maps.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "trace/distant_light.hpp"

namespace photile {

/// Draws frames from light maps. One ray through the middle of each pixel; mirrors, glass and holes
/// are followed; a specular lobe is taken for matt reflection of the same strength, and normal maps
/// are left out.
class LightMapFrames {
 public:
  /// References are kept.
  LightMapFrames(const RayScene& rays, LightMaps& maps, NodeSource& source);

  /// Draws width x height pixels, linear RGB radiance, row 0 at the top. Pixels whose nodes are not
  /// valued show the next coarser level. Returns the number of places that lack some.
  ///   powers   per layer: power x tint
  ///   rounds   levels that are valued at once where they are missing; 0: none
  /// Errors: those of LightMaps::fill.
  std::size_t draw(const Camera& camera, int width, int height, std::span<const glm::vec3> powers,
                   int rounds, std::span<glm::vec3> picture, const Progress& progress);

 private:
  /// What a frame needs of a triangle, close together.
  struct Surface {
    std::uint32_t chart[2];  ///< of its sides
    glm::vec3 reflects;      ///< radiance per irradiance, where it is plain
    enum Kind : std::uint32_t { plain, textured, lamp, followed } kind;
  };
  struct Missing {
    std::vector<glm::vec3> position;
    std::vector<std::uint32_t> sided_triangle;
    bool any = false;  ///< of the block at hand
  };
  struct View;

  void draw_block(const View& view, std::size_t block, Missing& missing) const;
  glm::vec3 seen(const View& view, std::uint32_t pixel, const glm::vec3& direction,
                 std::uint32_t triangle, std::uint32_t side, float u, float v, float distance,
                 Missing& missing) const;
  glm::vec3 irradiance(std::uint32_t sided_triangle, const glm::vec3& position,
                       Missing& missing) const;
  glm::vec3 followed(const View& view, std::uint32_t pixel, const glm::vec3& direction,
                     Missing& missing) const;
  glm::vec3 background(const glm::vec3& direction) const;

  const RayScene& rays_;
  const Scene& scene_;
  LightMaps& maps_;
  NodeSource& source_;
  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> layer_of_;  ///< per light
  std::vector<glm::vec3> emitted_;       ///< per light, at power 1
  std::vector<trace::DistantLight> distant_;
  light_maps::NodeMix mixed_;
};

}  // namespace photile
