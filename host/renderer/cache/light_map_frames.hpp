// Pictures of the light on surfaces alone, quick enough to walk in: a ray and a lookup a pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cache/ambient_light.hpp"
#include "cache/light_maps.hpp"
#include "cache/shown_nodes.hpp"
#include "cache/tiles.hpp"
#include "photile/camera.hpp"
#include "photile/light_layers.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "trace/distant_light.hpp"

namespace photile::cache {

/// Draws frames from light maps. Rays through the same positions of each pixel; mirrors, glass and
/// cutouts are followed; a specular lobe is taken for matt reflection of the same strength, and
/// normal maps are left out.
class LightMapFrames {
 public:
  /// References are kept.
  LightMapFrames(const RayScene& rays, LightMaps& maps);

  /// From now on, frames forget the cells that were seen least recently where light maps take more
  /// than this many bytes: down to half of it, but none that the latest frame sees. What their
  /// source keeps is released first. 0 = no bound.
  void bound(std::uint64_t bytes) { bound_ = bytes; }

  /// Draws a picture of the film's size, linear RGB radiance, row 0 at the top. Pixels whose nodes
  /// are not valued show the next coarser level; those without any, what `coarser` has there; those
  /// without that, the light of nodes around. A chart changes from one to the other as a whole,
  /// when it first has all that is seen of it.
  ///   powers    per layer: power x tint
  ///   filling   of nodes which pixels lack: the coarsest, on charts that take most of the picture
  ///             first, then finer ones where light differs most; their pixels are drawn again
  ///   coarser   of the same scene, whose nodes are valued first; null = none
  /// Errors: those of LightMaps::fill.
  DrawnFrame draw(const Camera& camera, const Film& film, std::span<const glm::vec3> powers,
                  const FrameFilling& filling, std::span<glm::vec3> picture,
                  const Progress& progress, LightMapFrames* coarser = nullptr);

 private:
  /// The data of a triangle that a frame needs, close together.
  struct Surface {
    std::uint32_t chart[2];  ///< of its sides
    glm::vec3 reflects;      ///< radiance per irradiance, where it is plain
    enum Kind : std::uint32_t { plain, textured, light, followed } kind;
  };
  /// Where a cell is seen whose nodes are not valued: one sample in each packet of rays.
  struct MissingSample {
    MissingCell cell;
    bool empty;  ///< without a coarser level
    std::uint32_t chart, packet;
    /// Without a coarser level, how often it is seen; else as often times the difference of the
    /// coarser nodes around it. Once in order, that of its chart.
    double gain;
    glm::vec3 position;
    std::uint32_t oriented_face;
  };
  struct Missing {
    std::vector<MissingSample> samples;
    std::vector<MissingSample> coarser;   ///< of the coarser light maps, where no level is valued
    bool any = false;                     ///< of the block at hand: it is to be drawn again
    std::uint32_t packet = 0;             ///< the one at hand, of those that a thread traced
    std::uint64_t lacking = 0, read = 0;  ///< samples, of both light maps together
  };
  struct View;

  void begin_frame();
  void mix(std::span<const glm::vec3> powers, bool soft);
  void forget_unseen();
  Missing draw_blocks(const View& view, std::vector<std::size_t>& blocks,
                      const FrameFilling& filling) const;
  static void put_in_order(std::vector<MissingSample>& samples);
  bool show_complete(std::span<const MissingSample> missing);
  bool soften(std::span<const MissingSample> missing);
  void fill(std::span<const MissingSample> samples, double seconds, const FrameFilling& filling,
            const Progress& progress);
  void draw_block(const View& view, std::size_t block, Missing& missing) const;
  glm::vec3 seen(const View& view, std::uint32_t pixel, const glm::vec3& direction,
                 std::uint32_t triangle, std::uint32_t side, float u, float v, float distance,
                 Missing& missing) const;
  glm::vec3 irradiance(const View& view, std::uint32_t oriented_face, const glm::vec3& position,
                       Missing& missing) const;
  std::optional<glm::vec3> known_irradiance(std::uint32_t oriented_face, const glm::vec3& position,
                                            Missing& missing, std::vector<MissingSample>& samples,
                                            bool& lacks) const;
  double difference(const BilinearWeights& bilinear) const;
  glm::vec3 followed(const View& view, std::uint32_t pixel, const glm::vec3& direction,
                     Missing& missing) const;
  glm::vec3 background(const glm::vec3& direction) const;

  const RayScene& rays_;
  const Scene& scene_;
  LightMaps& maps_;
  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> layer_of_;  ///< per light
  std::vector<glm::vec3> emitted_;       ///< per light, at power 1
  trace::DistantLights distant_;
  ShownNodes nodes_;
  std::vector<MissingCell> lacking_;         ///< in the latest picture, of those that have a tile
  std::uint64_t bound_ = 0;                  ///< bytes of light maps; 0 = none
  std::uint32_t frame_ = 0;                  ///< of those that are bounded, from 1
  mutable std::vector<std::uint32_t> seen_;  ///< per node: the latest frame that shows its cell
  AmbientLight ambient_;                     ///< where no level is valued
  std::size_t ambient_nodes_ = 0;            ///< that it was gathered from
  std::vector<std::uint8_t> is_shown_;       ///< per chart: 1 = shown by its own nodes
  mutable std::vector<std::uint8_t>
      waits_;                  ///< per chart not shown yet: 1 = seen where it has nodes
  double seconds_per_sample_;  ///< of valuing, learned from what it took
};

}  // namespace photile::cache
