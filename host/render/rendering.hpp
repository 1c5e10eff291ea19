// One rendering: photon passes, and pictures of what their maps hold.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "photile/surface_index.hpp"
#include "render/hit_source.hpp"
#include "render/map_estimators.hpp"
#include "render/pass_schedule.hpp"
#include "render/render_costs.hpp"

namespace photile {

/// What the photon passes of a rendering share.
class Rendering {
 public:
  /// References are kept. Errors: those of RayScene and automatic_passes.
  Rendering(const Scene& scene, std::span<Device> devices, const RenderParameters& parameters,
            Progress& progress);

  int passes() const { return passes_; }

  /// From now on.
  void report_to(Progress& progress) { progress_ = &progress; }

  /// Begins a picture.
  void start(const PrimaryHitParameters& film);

  /// Traces the photons of a pass and builds their maps. Those of the pass before are gone.
  ///   prepared   photons and groups in place of traced ones, or null; taken
  ///   keep       is given those of the first pass, or null
  void prepare(int pass, PreparedPhotons* prepared, const KeepPhotons* keep);

  /// Adds what is seen by the photons of the prepared pass.
  void add_pass(const HitSource& source);

  /// The picture since `start`.
  RenderResult finish();

 private:
  /// On each device.
  struct Maps {
    std::vector<PhotonMaps> photons;
    std::vector<PhotonMaps> caustics;  ///< for final gathering, where there are any
  };

  Maps trace_and_build(int pass, PreparedPhotons* prepared, const KeepPhotons* keep);
  PhotonTracerResult trace(int pass);
  std::vector<PhotonMaps> build(const Photons& photons, double radius);
  double radius_for(const Photons& photons) const;
  void count(const PhotonTracerResult& traced);
  void find_groups(const Photons& photons, PreparedPhotons* prepared);
  void find_surface(const Photons& photons);
  int rows_per_batch(const HitSource& source) const;
  void add_rows(const HitSource& source, int first, int last);
  Estimates estimate(const PrimaryHits& hits, int first_row, int last_row);
  double compile_seconds() const;

  const Stopwatch stopwatch_;  // before rays_, whose construction it times
  const Scene& scene_;
  std::span<Device> devices_;
  const RenderParameters parameters_;
  Progress* progress_;
  const RayScene rays_;
  int passes_ = 1;
  PrimaryHitParameters film_;
  LightLayers layers_;
  std::vector<std::uint64_t> paths_before_;  ///< per light
  PassEstimate first_;
  NeighbourGroups groups_;
  std::shared_ptr<const SurfaceIndex> surface_;  ///< where areas are clipped
  const std::vector<double> layer_powers_;
  std::optional<MapEstimators> photons_, caustics_;  ///< of the pass
  int pass_ = 0;
  std::vector<double> shares_;
  RenderCosts costs_;
};

}  // namespace photile
