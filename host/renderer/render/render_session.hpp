// A scene whose photon maps are kept for many pictures.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "photile/renderer.hpp"
#include "render/frame_renderer.hpp"
#include "render/hit_source.hpp"
#include "render/photon_passes.hpp"
#include "render/quality.hpp"

namespace photile {

/// A scene prepared for rays, and what that took.
struct PreparedScene {
  explicit PreparedScene(const Scene& scene);

  Stopwatch stopwatch;  ///< before `rays`, whose construction it times
  RayScene rays;
  StageCost cost;
};

/// A scene, and pictures of any hits that lie close together, by photon maps.
class RenderSession {
 public:
  /// References are kept. Errors: those of RenderPlan; UsageError without a device.
  RenderSession(std::shared_ptr<const PreparedScene> scene, std::span<Device> devices,
                const RenderParameters& parameters, Progress& progress,
                HitsAsk hits = HitsAsk::pictures);

  /// Prepares all passes, kept for many pictures. `prepared`, `keep`, errors: see SceneRenderer.
  void keep_passes(TracedPhotons* prepared, const KeepPhotons& keep, Progress& progress);

  /// A picture. Where passes are not kept, each is made for it, and released before the next.
  RenderResult render(const HitSource& hits, const Film& film, Progress& progress,
                      const LayerMixdown* mixdown = nullptr);

  /// Adds parts to the work done so far (render/refinement.hpp); the first keeps the passes. Later
  /// parts are for light maps whose nodes gather: `parts` times the requested rays are added at the
  /// nodes that are read from now on, and photons are traced anew where `photons_of_parts` says so.
  /// Pictures are then those of `of_parts`, if as many were made on the way.
  void add_parts(int parts, Progress& progress);
  /// The requested film, with the samples of all parts.
  Film film() const { return with_work(plan_.used(), parts_).film; }

  bool reads_light_maps() const { return plan_.reads_light_maps(); }
  /// The light of the scene; where light maps are read there is one pass.
  PassLight& light() { return *passes_.front(); }
  /// Quick pictures, where light maps are read.
  FrameRenderer& frames() { return *frames_; }
  /// The contents of the light maps; none where they are not read, or not yet.
  std::optional<LightMapContents> light_map_contents() const;

 private:
  void set_frames();

  const std::shared_ptr<const PreparedScene> scene_;
  std::span<Device> devices_;
  const RenderPlan plan_;
  RenderCosts costs_;
  std::optional<PhotonPasses> photons_;
  std::vector<std::unique_ptr<PassLight>> passes_;  ///< that are kept
  int parts_ = 0;                                   ///< of the requested work, if added
  std::optional<FrameRenderer> frames_;
};

}  // namespace photile
