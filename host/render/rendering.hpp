// One rendering: photon passes, and pictures of what their maps hold.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gather/gathered_nodes.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "photile/shard.hpp"
#include "photile/surface_index.hpp"
#include "render/hit_source.hpp"
#include "render/kernel_preparation.hpp"
#include "render/light_map_estimates.hpp"
#include "render/light_map_frames.hpp"
#include "render/map_estimators.hpp"
#include "render/map_owners.hpp"
#include "render/render_costs.hpp"
#include "render/render_plan.hpp"

namespace photile {

/// A scene prepared for rays, and what that took.
struct PreparedScene {
  explicit PreparedScene(const Scene& scene);

  Stopwatch stopwatch;  ///< before `rays`, whose construction it times
  RayScene rays;
  StageCost cost;
};

/// What the photon passes of a rendering share.
class Rendering {
 public:
  /// References are kept. Errors: those of RenderPlan; UsageError without a device.
  Rendering(const PreparedScene& scene, std::span<Device> devices,
            const RenderParameters& parameters, Progress& progress);

  const RenderPlan& plan() const { return plan_; }

  /// From now on.
  void report_to(Progress& progress) { progress_ = &progress; }

  /// Maps are made of what is looked at alone where that saves some: for one picture, whose
  /// light is not gathered from all around. To be called before `prepare`.
  void expect_one_picture() { one_picture_ = true; }

  /// Begins a picture of so many passes; 0: of all there will be.
  ///   pooling   as SceneRenderer::render has it; kept as a reference
  void start(const Film& film, int passes = 0, const LightPooling* pooling = nullptr);

  /// Traces the photons of a pass and builds their maps. Those of the pass before are gone.
  ///   prepared   photons and groups in place of traced ones, or null; taken
  ///   keep       is given those of the first pass, or null
  void prepare(int pass, PreparedPhotons* prepared, const KeepPhotons* keep);

  /// Prepares a pass after the first, which `first` has prepared and keeps; any thread may.
  void follow(const Rendering& first, int pass);

  /// From now on nodes of light maps hold the mean of the prepared passes and this next one.
  /// `further` follows this rendering, and is kept as a reference.
  void add(Rendering& further);

  /// The prepared one and those added.
  int passes_kept() const { return 1 + static_cast<int>(further_.size()); }

  /// Adds what is seen by the photons of the prepared pass, or of the one added after so many.
  void add_pass(const HitSource& source, std::size_t after = 0);

  /// Of the prepared pass, and those added; the plan reads light maps.
  LightMapEstimates& light_maps();

  /// Quick pictures from these light maps; the plan reads light maps.
  LightMapFrames& frames();

  /// What these light maps hold; none before they are read, or of several passes.
  std::optional<LightMapContents> light_map_contents() const;

  /// Lets go of the maps, once all that was wanted is in the picture.
  void release();

  /// The picture since `start`.
  RenderResult finish();

 private:
  /// On each device.
  struct Maps {
    std::vector<PhotonMaps> photons;
    std::vector<PhotonMaps> caustics;  ///< for rays that gather, where there are any
    std::shared_ptr<const SeenPhotons> seen_caustics;
  };

  /// Whose photons are at hand.
  Rendering& at_hand() { return at_hand_ == 0 ? *this : *further_[at_hand_ - 1]; }
  /// What values nodes by the prepared pass.
  GatheringPass gathering();

  /// Whether light maps that are kept with the photons are those of this rendering.
  bool reads_light_maps_of(const PreparedPhotons& prepared);
  /// Takes them in; maps of the photons are built when an estimate is first needed.
  void wait_with(PreparedPhotons& prepared, const KeepPhotons* keep);
  /// Chooses nodes for the photons of a pass.
  void choose_light_maps(int pass, const Photons& photons);
  MapEstimators::Parts parts_of(std::vector<PhotonMaps> maps,
                                std::shared_ptr<const SeenPhotons> seen = nullptr) const;
  /// Where several processes share the rendering: brings photons to the owners of their maps.
  void move_to_owners(PhotonTracerResult& traced);
  /// Rows of the film that this process makes.
  Shard own_rows() const;
  /// What was sent to the owners of maps so far.
  OwnerEstimates::Moved moved() const;
  /// Photons of a pass, with all that is found before there are maps.
  PhotonTracerResult trace(int pass, PreparedPhotons* prepared, const KeepPhotons* keep);
  Maps trace_and_build(int pass, PreparedPhotons* prepared, const KeepPhotons* keep);
  std::vector<PhotonMaps> build(Photons photons, const PhotonMapParameters& parameters);
  /// Whether maps are made as they are looked at.
  bool makes_maps_in_sight() const;
  /// Of the photons in `seen_`, which are given up where the whole picture was looked at, and
  /// traced anew should more be looked at after all.
  MapEstimators::Parts build_some(std::span<const std::uint8_t> wanted);
  /// Makes those that the hits of rows look at, unless they are there; `batch` has the first.
  void make_maps(const HitSource& source, const PrimaryHitBatch& batch, int rows);
  void note_maps(const PhotonMapStatistics& built);
  void count(const PhotonTracerResult& traced);
  void find_groups(const Photons& photons, PreparedPhotons* prepared);
  void find_surface(const Photons& photons);
  int rows_per_batch(const HitSource& source) const;
  PrimaryHitBatch trace_rows(const HitSource& source, int first, int last);
  void add_rows(const HitSource& source, PrimaryHitBatch batch, int first, int last);
  Estimates estimate(const PrimaryHits& hits);
  bool reads_light_maps(const HitSource& source) const {
    return plan_.reads_light_maps() && (source.dense() || plan_.asks_for_light_maps());
  }
  Estimates read_light_maps(const PrimaryHits& hits, std::span<const std::uint8_t> by_photons);
  void drop_maps();
  double compile_seconds() const;

  const RayScene& rays_;
  const Scene& scene_;
  std::span<Device> devices_;
  Progress* progress_;
  const RenderPlan plan_;
  std::optional<KernelPreparation> kernels_;  ///< begun where photons are needed
  PrimaryHitParameters film_;
  /// Of the picture; null = none. Few rows at a time: estimates take more than their pools.
  const LightPooling* pooling_ = nullptr;
  LightLayers layers_;
  LightLayers runs_;  ///< where errors are asked for: of each run of a pixel's samples
  std::vector<std::uint64_t> paths_before_;  ///< per light
  double radius_ = 0;                        ///< of the first pass, metres
  NeighbourGroups groups_;
  std::shared_ptr<const MapOwners> owners_;  ///< where several processes share the rendering
  bool one_picture_ = false;
  bool seen_whole_ = false;
  Photons seen_;                   ///< where maps are made as they are looked at
  PreparedPhotons waiting_;        ///< with light maps of their own: what has no maps yet
  std::optional<Maps> late_maps_;  ///< of what was waiting
  std::shared_ptr<const SurfaceIndex> surface_;  ///< where areas are clipped
  const std::vector<double> layer_powers_;
  std::optional<MapEstimators> photons_, caustics_;  ///< of the pass
  LightMapParameters light_map_parameters_, end_parameters_;
  std::optional<IrradianceGather> node_gather_;  ///< of the pass, where nodes gather
  std::optional<GatheredNodes> gathered_nodes_;
  std::optional<LightMapEstimates> light_maps_;  ///< of the pass, made when they are first read
  std::optional<LightMapFrames> frames_;         ///< of these light maps
  int pass_ = 0;
  std::vector<Rendering*> further_;  ///< passes that are kept beside the prepared one
  std::size_t at_hand_ = 0;          ///< 0: the prepared pass; else one of those
  std::vector<double> shares_;
  RenderCosts costs_;
};

}  // namespace photile
