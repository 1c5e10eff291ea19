// The light of light maps in quick frames, which are drawn while nodes are still being filled.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cache/ambient_light.hpp"
#include "cache/light_maps.hpp"
#include "cache/node_mix.hpp"
#include "cache/tiles.hpp"
#include "photile/progress.hpp"
#include "photile/renderer.hpp"

namespace photile::cache {

/// The light of all lights together that a frame shows at points, and what it lacks there. A chart
/// is shown as a whole, when it first has all that is seen of it: light of two kinds on one surface
/// would show where they meet. Then points whose nodes have no light show the next coarser level.
/// Light is softened where nodes are lacking, so that this does not show:
///   - Nodes on the border of a larger cell show the mean which that cell has at their position,
///     whatever they hold: otherwise there would be a step along that border.
///   - A corner of a cell counts less where its surroundings are nearer than the next corner: it
///     may lie behind a door, and tells little about the surface in front of it. Where that is so
///     of all corners, light of the nodes around the cell counts.
///   - No corner of a cell is brighter than all others by more than a given factor: nodes beside
///     lights would show as bright squares.
class FrameView {
 public:
  /// References are kept.
  FrameView(const Scene& scene, LightMaps& maps);

  /// From now on, the cells seen least recently are discarded where light maps take more than this
  /// many bytes: down to half of that, but none that the latest frame sees. What their source keeps
  /// is released first. 0 = no bound.
  void bound(std::uint64_t bytes) { bound_ = bytes; }

  /// Before each frame: discards what exceeds the bound.
  void begin_frame();

  /// Before each picture of a frame: brings the light up to date. Work is shared by TBB.
  ///   powers   per layer: power x tint
  ///   soft     light is softened at all cells, whether they lack nodes or not
  void mix(std::span<const glm::vec3> powers, bool soft);

  /// Irradiance at a point of an opaque surface; none where its chart is not shown, or the point
  /// has no level. What it lacks is noted. Thread-safe.
  ///   packet     of rays that it belongs to: a number that no other of the picture has
  ///   lacks      is set where nodes of the point have no light
  ///   softened   is set where its light is softened because nodes beside it are not
  std::optional<glm::vec3> irradiance(std::uint32_t oriented_face, const glm::vec3& position,
                                      std::uint32_t packet, bool& lacks, bool& softened) const;
  /// The nodes whose light a point of an opaque surface shows, by what they count; false where its
  /// chart is not shown, or the point has no level. Thread-safe; the caller's thread must flush
  /// denormals (ray_query.hpp).
  ///   is_final   is set where better nodes can no longer come: then those that something hides
  ///   from
  ///              the point are left out
  bool find(std::uint32_t oriented_face, const glm::vec3& position, BilinearWeights& bilinear,
            bool& is_final) const;
  /// The light between these nodes.
  glm::vec3 between(const BilinearWeights& bilinear, std::uint32_t oriented_face,
                    const glm::vec3& position) const;
  /// The light of the nodes around, for points without nodes of their own.
  glm::vec3 ambient(std::uint32_t oriented_face, const glm::vec3& position) const;

  /// After a picture: sorts what it lacks, cells without any level first, then chart by chart,
  /// since a chart that is refined in part has steps between its cells: the chart that changes most
  /// of the picture comes first.
  void end_picture();
  /// Samples of cells that the latest picture shows coarser than they should be, and of them, those
  /// of cells without any level, of which there is one each.
  std::size_t lacking() const { return missing_.size(); }
  std::size_t empty() const;

  /// Shows the nodes of charts that were seen and have all nodes. Returns whether there were any.
  bool show_complete();
  /// Softens light around cells that lack their nodes from now on. Returns whether there were none
  /// in the picture before, or are none any more: then it is to be drawn again.
  bool soften();
  /// Fills nodes that the latest picture lacks, in order, as long as there is time, and at least
  /// for one sample: only the coarsest nodes where there are samples without any, else all finer
  /// ones. Errors: those of LightMaps::fill.
  void fill(double seconds, const FrameFilling& filling, const Progress& progress);

 private:
  class Softening;

  /// Weighs nodes by how much they count; what their sum lacks of 1, the light of the nodes around
  /// counts. Returns whether any is softened because a cell beside it lacks nodes.
  bool weigh(BilinearWeights& bilinear) const;

  /// A position at which a cell without filled nodes is seen: one sample in each packet of rays.
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
  /// Of a chart: one that waits was seen where it has nodes.
  enum State : std::uint8_t { hidden, waits, shown };

  const Scene& scene_;
  LightMaps& maps_;
  NodeMix mix_;
  // Per node, as NodeMix has them, but softened.
  std::vector<glm::vec4> light_, by_normal_;
  // Per node: how much it counts between others, and whether it is softened because a cell beside
  // it lacks nodes. Both are empty where nothing is softened.
  std::vector<float> weight_;
  std::vector<std::uint8_t> lacks_beside_;
  bool soft_ = false;                        ///< whether all cells are softened
  std::vector<MissingCell> softened_;        ///< cells that have a tile, but lacked nodes
  AmbientLight ambient_;                     ///< where no level is filled
  std::size_t ambient_nodes_ = 0;            ///< that it was gathered from
  mutable std::vector<std::uint8_t> state_;  ///< per chart
  mutable tbb::enumerable_thread_specific<std::vector<MissingSample>> found_;  ///< in a picture
  std::vector<MissingSample> missing_;       ///< in the latest picture, in order
  std::uint64_t bound_ = 0;                  ///< bytes of light maps; 0 = none
  std::uint32_t frame_ = 0;                  ///< of those that are bounded, from 1
  mutable std::vector<std::uint32_t> seen_;  ///< per node: the latest frame that shows its cell
  double seconds_per_sample_;                ///< of filling, learned from earlier times
};

}  // namespace photile::cache
