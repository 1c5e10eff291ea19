// One set of photon maps for many pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "photile/light_maps.hpp"
#include "photile/light_pooling.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// What photon maps are built from: all that depends on random numbers or takes long on the host.
struct PreparedPhotons {
  Photons photons;
  NeighbourGroups groups;  ///< empty: found when maps are built
  double radius = 0;       ///< metres: of the maps; 0 where groups are not there
  /// Of them, those that came by mirrors and glass alone; where rays gather.
  std::optional<Photons> caustics = std::nullopt;
  /// What light maps of these photons held, if they are kept. Where its settings are those of the
  /// rendering, maps are built from the photons when an estimate is first needed.
  std::optional<LightMapContents> light_maps = std::nullopt;

  bool has_groups() const { return radius > 0; }
};
using KeepPhotons = std::function<void(const PreparedPhotons&)>;

/// How long a quick frame may value nodes that it lacks.
struct FrameFilling {
  /// So many seconds; infinite: until none is lacking. Implicit: a frame knows no other number.
  ///   ends   asked from time to time: true ends it at once; empty = never
  FrameFilling(double limit, std::function<bool()> ends = {})
      : seconds(limit), ended(std::move(ends)) {}

  double seconds;
  std::function<bool()> ended;

  /// What is left after so many seconds.
  double left(double spent) const { return ended && ended() ? 0 : seconds - spent; }
};

/// What a quick frame shows.
struct DrawnFrame {
  /// Cells of light maps that it shows coarser than they should be.
  std::size_t lacking = 0;
  std::size_t empty = 0;     ///< of them, those without any light: they are grey
  double lacking_share = 0;  ///< of the surface that is seen, in [0, 1]
  double fill_seconds = 0;   ///< that went into nodes which were lacking
};

/// The photon maps of a scene, kept on the devices while pictures are rendered from them.
class SceneRenderer {
 public:
  /// Traces the photons and builds the maps. The scene and the devices must outlive it.
  ///   prepared   in place of tracing, of the same scene and parameters; left empty. Null: none
  ///   keep       is called with what the maps are built from, before they are. Empty: nothing
  /// Of several photon passes pictures are the mean of all; `prepared` and `keep` are of the first.
  /// Errors: those of `render`, and of `keep`; UsageError where the photons do not fit in memory at
  /// once, or where rays gather and `prepared` has no caustics apart.
  SceneRenderer(const Scene& scene, std::span<Device> devices, const RenderParameters& parameters,
                PreparedPhotons* prepared = nullptr, const KeepPhotons& keep = {},
                Progress& progress = Progress::none());
  ~SceneRenderer();

  /// The picture that `render` gives with this film, bit for bit. Statistics contain the costs of
  /// the maps each time.
  ///   pooling   of its layers, before they take memory; null = each for itself
  RenderResult render(const Camera& camera, const Film& film, Progress& progress = Progress::none(),
                      const LightPooling* pooling = nullptr);

  /// Draws the light on surfaces alone, from light maps: quick enough to walk in, one ray a sample,
  /// glossy surfaces as if they were matt (host/renderer/cache/light_map_frames.hpp). For
  /// parameters that ask for light maps.
  ///   powers    per layer: power x tint
  ///   filling   of nodes which pixels lack: the nearest to the eye come first, other pixels show a
  ///             coarser level
  ///   picture   of the film's size, linear RGB radiance
  ///   coarser   of the same scene: shown where these light maps have no node yet, and filled
  ///             before them; null = none
  /// Once nothing is lacking, a frame does not depend on what was drawn before. Errors: those of
  /// `render`.
  DrawnFrame draw(const Camera& camera, const Film& film, std::span<const glm::vec3> powers,
                  const FrameFilling& filling, std::span<glm::vec3> picture,
                  Progress& progress = Progress::none(), SceneRenderer* coarser = nullptr);

  /// From now on light maps take about so many bytes: `draw` forgets what was seen least recently,
  /// but nothing of the latest picture. It comes back to the same bits when it is seen again.
  void bound_light_maps(std::uint64_t bytes);

  /// Whether `draw` has light maps to draw from.
  bool draws() const;

  /// What the light maps hold by now; none where they are not read, or cannot be kept.
  std::optional<LightMapContents> light_maps() const;

  /// The part of that picture which comes by a mirror, by glass that bends or reflects it, or by a
  /// glossy lobe.
  RenderResult render_reflections(const Camera& camera, const Film& film,
                                  Progress& progress = Progress::none(),
                                  const LightPooling* pooling = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile
